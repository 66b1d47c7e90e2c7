// SPDX-License-Identifier: Apache-2.0
#include "shells/surface_canopy.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <span>
#include <tuple>

#include <epoxy/gl.h>

#include "shared/surface_chart.h"

namespace sward::shells {

namespace {

constexpr int kEvenings = 8; // passes, each over the facets around a vertex
constexpr float kOwnSide =
    0.1f; // cosine: a vertex's normal that is farther off its triangle's is not of this side of it

glm::vec3 face_of(const scene::Mesh& mesh, const std::array<std::uint32_t, 3>& corners) {
    const glm::vec3 a = mesh.positions[corners[0]];
    const glm::vec3 n = glm::cross(mesh.positions[corners[1]] - a, mesh.positions[corners[2]] - a);
    const float size = glm::length(n);
    return size > 0 ? n / size : glm::vec3(0);
}

/// Area times shape operator of a triangle on which the normal is linear: the symmetric map that
/// takes the edges nearest to the normals' differences.
glm::mat3 shape_of(const std::array<glm::vec3, 3>& places, const std::array<glm::vec3, 3>& normals,
                   glm::vec3 face) {
    const glm::vec3 x = glm::normalize(places[1] - places[0]), y = glm::cross(face, x);
    const auto flat = [&](glm::vec3 v) { return glm::vec2(glm::dot(v, x), glm::dot(v, y)); };
    const glm::mat2 edges(flat(places[1] - places[0]), flat(places[2] - places[0]));
    const glm::mat2 turns(flat(normals[1] - normals[0]), flat(normals[2] - normals[0]));
    const glm::mat2 shape = turns * glm::inverse(edges);
    const float both = 0.5f * (shape[0][1] + shape[1][0]);
    const glm::mat3 sum = shape[0][0] * glm::outerProduct(x, x) +
                          shape[1][1] * glm::outerProduct(y, y) +
                          both * (glm::outerProduct(x, y) + glm::outerProduct(y, x));
    return sum * (0.5f * std::abs(glm::determinant(edges)));
}

/// A covered triangle: its corners' normals are on its own side.
struct Face {
    std::array<std::uint32_t, 3> corners;
    std::array<glm::vec3, 3> places, normals;
    glm::vec3 normal;
};

std::vector<Face> covered_faces(const scene::Mesh& mesh, double slope_deg) {
    const double least_up = slope_deg >= 180 ? -2 : std::cos(slope_deg * std::numbers::pi / 180);
    std::vector<Face> faces;
    for (const auto& corners : mesh.triangles) {
        Face face{corners, {}, {}, face_of(mesh, corners)};
        if (face.normal == glm::vec3(0) || face.normal.y < least_up) {
            continue;
        }
        for (std::size_t k = 0; k < 3; ++k) {
            const glm::vec3 own = mesh.normals[corners[k]];
            face.places[k] = mesh.positions[corners[k]];
            face.normals[k] = glm::dot(own, face.normal) > kOwnSide ? own : face.normal;
        }
        faces.push_back(face);
    }
    return faces;
}

/// Normals that lie on a lattice bend by steps, from facet to facet, which a lifted surface would
/// show as folds.
void even_out(std::vector<glm::mat3>& shapes, const std::vector<Face>& faces) {
    std::vector<glm::mat3> sums(shapes.size());
    std::vector<float> counts(shapes.size());
    for (int pass = 0; pass < kEvenings; ++pass) {
        std::fill(sums.begin(), sums.end(), glm::mat3(0));
        std::fill(counts.begin(), counts.end(), 0.0f);
        for (const Face& face : faces) {
            const glm::mat3 mean =
                (shapes[face.corners[0]] + shapes[face.corners[1]] + shapes[face.corners[2]]) /
                3.0f;
            for (const std::uint32_t corner : face.corners) {
                sums[corner] += mean;
                ++counts[corner];
            }
        }
        for (std::size_t i = 0; i < shapes.size(); ++i) {
            shapes[i] = counts[i] > 0 ? sums[i] / counts[i] : shapes[i];
        }
    }
}

/// Mean shape operator at each vertex of the mesh.
std::vector<glm::mat3> shapes_of(const scene::Mesh& mesh, const std::vector<Face>& faces) {
    std::vector<glm::mat3> sums(mesh.positions.size(), glm::mat3(0));
    std::vector<float> areas(mesh.positions.size(), 0);
    for (const Face& face : faces) {
        const glm::mat3 shape = shape_of(face.places, face.normals, face.normal);
        const float area = 0.5f * glm::length(glm::cross(face.places[1] - face.places[0],
                                                         face.places[2] - face.places[0]));
        const bool finite = std::isfinite(shape[0][0] + shape[1][1] + shape[2][2] + shape[0][1] +
                                          shape[0][2] + shape[1][2]);
        for (const std::uint32_t corner : face.corners) {
            sums[corner] += finite ? shape : glm::mat3(0);
            areas[corner] += finite ? area : 0;
        }
    }
    for (std::size_t i = 0; i < sums.size(); ++i) {
        sums[i] /= std::max(areas[i], 1e-20f);
    }
    even_out(sums, faces);
    return sums;
}

/// One end of an edge as its neighbours know it: by place and normal, whatever the vertex's number.
using End = std::array<float, 6>;
End end_of(const Face& face, std::size_t k) {
    const glm::vec3 p = face.places[k], n = glm::round(face.normals[k] * 1024.0f);
    return {p.x + 0.0f, p.y + 0.0f, p.z + 0.0f, n.x + 0.0f, n.y + 0.0f, n.z + 0.0f}; // -0 is 0
}

struct Edge {
    End from, to; ///< as its triangle runs along it
    std::size_t face, k;
};

/// Edges that no covered triangle runs along the other way.
std::vector<Edge> open_edges(const std::vector<Face>& faces) {
    std::vector<Edge> edges, open;
    for (std::size_t f = 0; f < faces.size(); ++f) {
        for (std::size_t k = 0; k < 3; ++k) {
            edges.push_back({end_of(faces[f], k), end_of(faces[f], (k + 1) % 3), f, k});
        }
    }
    const auto less = [](const Edge& a, const Edge& b) {
        return std::tie(a.from, a.to) < std::tie(b.from, b.to);
    };
    std::sort(edges.begin(), edges.end(), less);
    for (const Edge& edge : edges) {
        if (!std::binary_search(edges.begin(), edges.end(), Edge{edge.to, edge.from, 0, 0}, less)) {
            open.push_back(edge);
        }
    }
    std::sort(open.begin(), open.end(), [](const Edge& a, const Edge& b) {
        return std::tie(a.face, a.k) < std::tie(b.face, b.k);
    });
    return open;
}

} // namespace

std::vector<CanopyVertex> canopy_over(const scene::Mesh& mesh, double slope_deg) {
    const std::vector<Face> faces = covered_faces(mesh, slope_deg);
    const std::vector<glm::mat3> shapes = shapes_of(mesh, faces);
    std::vector<CanopyVertex> out;
    const auto add = [&](const Face& face, std::size_t k, float lift) {
        const glm::mat3& s = shapes[face.corners[k]];
        out.push_back({face.places[k],
                       face.normals[k],
                       {s[0][0], s[1][1], s[2][2]},
                       {s[1][2], s[0][2], s[0][1]},
                       {static_cast<float>(shared::chart_of(face.normal)), lift}});
    };
    for (const Face& face : faces) {
        for (std::size_t k = 0; k < 3; ++k) {
            add(face, k, 2);
        }
    }
    for (const Edge& edge :
         open_edges(faces)) { // outside in front: the grass is left of an edge, seen from above
        const Face& face = faces[edge.face];
        const std::size_t a = edge.k, b = (edge.k + 1) % 3;
        add(face, a, 0);
        add(face, b, 0);
        add(face, b, 1);
        add(face, a, 0);
        add(face, b, 1);
        add(face, a, 1);
    }
    return out;
}

SurfaceCanopy::SurfaceCanopy(const scene::Mesh& mesh, double slope_deg) {
    static_assert(sizeof(CanopyVertex) == 56);
    const std::vector<CanopyVertex> vertices = canopy_over(mesh, slope_deg);
    count_ = static_cast<int>(vertices.size());
    vertices_ = gl::Buffer::of(std::span<const CanopyVertex>(vertices));
    glCreateVertexArrays(1, &vertex_array_);
    glVertexArrayVertexBuffer(vertex_array_, 0, vertices_.id(), 0, sizeof(CanopyVertex));
    constexpr std::array<std::size_t, 5> kOffsets = {
        offsetof(CanopyVertex, position), offsetof(CanopyVertex, normal),
        offsetof(CanopyVertex, curve_squares), offsetof(CanopyVertex, curve_products),
        offsetof(CanopyVertex, chart_lift)};
    for (GLuint attribute = 0; attribute < kOffsets.size(); ++attribute) {
        glEnableVertexArrayAttrib(vertex_array_, attribute);
        glVertexArrayAttribFormat(vertex_array_, attribute, attribute == 4 ? 2 : 3, GL_FLOAT,
                                  GL_FALSE, static_cast<GLuint>(kOffsets[attribute]));
        glVertexArrayAttribBinding(vertex_array_, attribute, 0);
    }
}

SurfaceCanopy::~SurfaceCanopy() {
    glDeleteVertexArrays(1, &vertex_array_);
}

void SurfaceCanopy::draw() const {
    glBindVertexArray(vertex_array_);
    glDrawArrays(GL_TRIANGLES, 0, count_);
}

} // namespace sward::shells
