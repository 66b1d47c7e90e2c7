// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <cstring>
#include <optional>

#include <fmt/format.h>

#include "assets/assets.h"
#include "assets/gltf_file.h"
#include "base/error.h"

namespace sward::assets {
namespace {

using base::ExitCode;

constexpr std::size_t kMostTriangles = 10'000'000;
constexpr std::size_t kMostVertices = 3 * kMostTriangles;
constexpr std::size_t kMostNodes = 1'000'000;

bool inside(int index, std::size_t size) {
    return index >= 0 && static_cast<std::size_t>(index) < size;
}

/// Elements of an accessor, every one of them within its buffer.
struct Elements {
    const unsigned char* data = nullptr;
    std::size_t count = 0, stride = 0;
    int component = 0; ///< TINYGLTF_COMPONENT_TYPE_*

    template<class T> [[nodiscard]] T at(std::size_t i) const {
        T value;
        std::memcpy(&value, data + i * stride, sizeof value);
        return value;
    }
};

class MeshReader {
public:
    MeshReader(const std::filesystem::path& path, const tinygltf::Model& model)
        : path_(path), model_(model) {}

    scene::Mesh read() {
        if (model_.nodes.size() > kMostNodes)
            over_limit("nodes", model_.nodes.size(), kMostNodes);
        walk(roots());
        if (mesh_.triangles.empty())
            refuse("mesh", "no triangle with an area", "at least one, in a node of the scene");
        if (!all_have_uvs_)
            mesh_.uvs.clear();
        finish_normals();
        return std::move(mesh_);
    }

private:
    [[noreturn]] void refuse(std::string_view what, const std::string& found,
                             const std::string& expected) const {
        throw base::input_error(ExitCode::kBadInput, path_, 0, what, found, expected);
    }
    [[noreturn]] void over_limit(std::string_view what, std::size_t found,
                                 std::size_t limit) const {
        throw base::input_error(ExitCode::kOverLimit, path_, 0, what, std::to_string(found),
                                fmt::format("at most {}", limit));
    }

    /// Nodes of the default scene; of a file without scenes, those that are nobody's child.
    std::vector<int> roots() const {
        if (!model_.scenes.empty()) {
            const int at = std::max(model_.defaultScene, 0);
            if (!inside(at, model_.scenes.size()))
                refuse("scene", std::to_string(at), "one that is there");
            return model_.scenes[static_cast<std::size_t>(at)].nodes;
        }
        std::vector<bool> child(model_.nodes.size(), false);
        for (const tinygltf::Node& node : model_.nodes)
            for (const int i : node.children)
                if (inside(i, child.size()))
                    child[static_cast<std::size_t>(i)] = true;
        std::vector<int> roots;
        for (std::size_t i = 0; i < child.size(); ++i)
            if (!child[i])
                roots.push_back(static_cast<int>(i));
        return roots;
    }

    /// Down the tree without recursion. A node that is reached twice is in a loop or has two
    /// parents: no tree.
    void walk(const std::vector<int>& roots) {
        std::vector<std::pair<int, glm::dmat4>> todo;
        for (auto root = roots.rbegin(); root != roots.rend(); ++root)
            todo.emplace_back(*root, glm::dmat4(1));
        std::vector<bool> seen(model_.nodes.size(), false);
        while (!todo.empty()) {
            const auto [index, parent] = todo.back();
            todo.pop_back();
            if (!inside(index, model_.nodes.size()))
                refuse("node", std::to_string(index),
                       fmt::format("one of {}", model_.nodes.size()));
            const auto at = static_cast<std::size_t>(index);
            if (seen[at])
                refuse("node", fmt::format("{} a second time", index),
                       "a tree: one parent each, no loop");
            seen[at] = true;
            const tinygltf::Node& node = model_.nodes[at];
            const glm::dmat4 transform = parent * transform_of(node, index);
            if (node.mesh != -1)
                add_mesh(node.mesh, transform);
            for (auto child = node.children.rbegin(); child != node.children.rend(); ++child)
                todo.emplace_back(*child, transform);
        }
    }

    glm::dmat4 transform_of(const tinygltf::Node& node, int index) const {
        const auto checked = [&](const std::vector<double>& given, std::size_t size) {
            const bool fine =
                given.empty() || (given.size() == size && std::ranges::all_of(given, [](double v) {
                                      return std::isfinite(v) && std::abs(v) < 1e12;
                                  }));
            if (!fine)
                refuse("node", fmt::format("transform of node {}", index),
                       "finite numbers, as many as glTF says");
            return !given.empty();
        };
        glm::dmat4 m(1);
        if (checked(node.matrix, 16)) {
            for (std::size_t i = 0; i < 16; ++i)
                m[static_cast<int>(i / 4)][static_cast<int>(i % 4)] = node.matrix[i];
            return m;
        }
        if (checked(node.rotation, 4)) {
            glm::dvec4 q(node.rotation[0], node.rotation[1], node.rotation[2], node.rotation[3]);
            const double size = glm::length(q);
            if (!(size > 1e-6))
                refuse("node", fmt::format("rotation of node {} by nothing", index),
                       "a unit quaternion");
            q /= size;
            m[0] = {1 - 2 * (q.y * q.y + q.z * q.z), 2 * (q.x * q.y + q.z * q.w),
                    2 * (q.x * q.z - q.y * q.w), 0};
            m[1] = {2 * (q.x * q.y - q.z * q.w), 1 - 2 * (q.x * q.x + q.z * q.z),
                    2 * (q.y * q.z + q.x * q.w), 0};
            m[2] = {2 * (q.x * q.z + q.y * q.w), 2 * (q.y * q.z - q.x * q.w),
                    1 - 2 * (q.x * q.x + q.y * q.y), 0};
        }
        if (checked(node.scale, 3))
            for (int i = 0; i < 3; ++i)
                m[i] *= node.scale[static_cast<std::size_t>(i)];
        if (checked(node.translation, 3))
            m[3] = {node.translation[0], node.translation[1], node.translation[2], 1};
        return m;
    }

    void add_mesh(int index, const glm::dmat4& transform) {
        if (!inside(index, model_.meshes.size()))
            refuse("mesh", std::to_string(index), fmt::format("one of {}", model_.meshes.size()));
        for (const tinygltf::Primitive& primitive :
             model_.meshes[static_cast<std::size_t>(index)].primitives)
            if (primitive.mode == -1 || (primitive.mode >= TINYGLTF_MODE_TRIANGLES &&
                                         primitive.mode <= TINYGLTF_MODE_TRIANGLE_FAN))
                add_primitive(primitive, transform); // points and lines have no surface
    }

    void add_primitive(const tinygltf::Primitive& primitive, const glm::dmat4& transform) {
        const auto first = static_cast<std::uint32_t>(mesh_.positions.size());
        const auto positions = attribute(primitive, "POSITION", TINYGLTF_TYPE_VEC3);
        if (!positions)
            refuse("POSITION", "nothing", "an attribute of floats, three each");
        if (positions->count > kMostVertices - mesh_.positions.size())
            over_limit("vertices", mesh_.positions.size() + positions->count, kMostVertices);
        for (std::size_t i = 0; i < positions->count; ++i) {
            const glm::vec3 at(transform *
                               glm::dvec4(finite<glm::vec3>(*positions, i, "POSITION"), 1));
            if (!(std::max({std::abs(at.x), std::abs(at.y), std::abs(at.z)}) <=
                  scene::kMostCoordinate_m))
                refuse("POSITION", fmt::format("{}, {}, {}", at.x, at.y, at.z),
                       fmt::format("at most {} m from the origin", scene::kMostCoordinate_m));
            mesh_.positions.push_back(at);
        }
        add_normals(primitive, transform, positions->count);
        add_uvs(primitive, positions->count);
        add_triangles(primitive, first, positions->count,
                      glm::determinant(glm::dmat3(transform)) < 0);
    }

    void add_normals(const tinygltf::Primitive& primitive, const glm::dmat4& transform,
                     std::size_t count) {
        const auto normals = attribute(primitive, "NORMAL", TINYGLTF_TYPE_VEC3);
        if (normals && normals->count != count)
            refuse("NORMAL", fmt::format("{} values", normals->count), std::to_string(count));
        const glm::dmat3 linear(transform);
        // The cofactor matrix: it turns normals right even where the transform flattens or mirrors.
        const glm::dmat3 turn(glm::cross(linear[1], linear[2]), glm::cross(linear[2], linear[0]),
                              glm::cross(linear[0], linear[1]));
        const double sign = glm::determinant(linear) < 0 ? -1 : 1;
        for (std::size_t i = 0; i < count; ++i) {
            const glm::dvec3 normal =
                normals ? turn * glm::dvec3(finite<glm::vec3>(*normals, i, "NORMAL")) * sign
                        : glm::dvec3(0);
            const double size = glm::length(normal);
            mesh_.normals.emplace_back(size > 0 && std::isfinite(size) ? glm::vec3(normal / size)
                                                                       : glm::vec3(0));
        }
    }

    void add_uvs(const tinygltf::Primitive& primitive, std::size_t count) {
        const auto uvs = attribute(primitive, "TEXCOORD_0", TINYGLTF_TYPE_VEC2);
        all_have_uvs_ = all_have_uvs_ && uvs.has_value();
        if (uvs && uvs->count != count)
            refuse("TEXCOORD_0", fmt::format("{} values", uvs->count), std::to_string(count));
        for (std::size_t i = 0; i < count; ++i)
            mesh_.uvs.push_back(uvs ? finite<glm::vec2>(*uvs, i, "TEXCOORD_0") : glm::vec2(0));
    }

    template<class V> V finite(const Elements& elements, std::size_t i, const char* what) const {
        const V value = elements.at<V>(i);
        for (int c = 0; c < V::length(); ++c)
            if (!std::isfinite(value[c]))
                refuse(what, fmt::format("{} in element {}", value[c], i), "finite numbers");
        return value;
    }

    void add_triangles(const tinygltf::Primitive& primitive, std::uint32_t first,
                       std::size_t vertices, bool mirrored) {
        std::optional<Elements> indices;
        if (primitive.indices != -1)
            indices = elements_of(primitive.indices, "indices", TINYGLTF_TYPE_SCALAR);
        const std::size_t count = indices ? indices->count : vertices;
        const bool list = primitive.mode == -1 || primitive.mode == TINYGLTF_MODE_TRIANGLES;
        const std::size_t triangles = list ? count / 3 : count < 3 ? 0 : count - 2;
        if (triangles > kMostTriangles - mesh_.triangles.size())
            over_limit("triangles", mesh_.triangles.size() + triangles, kMostTriangles);
        const auto vertex = [&](std::size_t i) {
            const std::size_t index = indices ? index_at(*indices, i) : i;
            if (index >= vertices)
                refuse("indices", std::to_string(index),
                       fmt::format("less than the {} vertices", vertices));
            return first + static_cast<std::uint32_t>(index);
        };
        for (std::size_t t = 0; t < triangles; ++t) {
            std::array<std::uint32_t, 3> corners{};
            if (list)
                corners = {vertex(3 * t), vertex(3 * t + 1), vertex(3 * t + 2)};
            else if (primitive.mode == TINYGLTF_MODE_TRIANGLE_FAN)
                corners = {vertex(0), vertex(t + 1), vertex(t + 2)};
            else // every second one of a strip runs the other way
                corners = {vertex(t), vertex(t + 1 + t % 2), vertex(t + 2 - t % 2)};
            if (mirrored)
                std::swap(corners[1], corners[2]);
            if (area_vector(corners) != glm::dvec3(0))
                mesh_.triangles.push_back(corners);
        }
    }

    [[nodiscard]] glm::dvec3 area_vector(const std::array<std::uint32_t, 3>& corners) const {
        const glm::dvec3 a(mesh_.positions[corners[0]]), b(mesh_.positions[corners[1]]),
            c(mesh_.positions[corners[2]]);
        return glm::cross(b - a, c - a);
    }

    std::size_t index_at(const Elements& indices, std::size_t i) const {
        switch (indices.component) {
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
            return indices.at<std::uint8_t>(i);
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
            return indices.at<std::uint16_t>(i);
        default:
            return indices.at<std::uint32_t>(i);
        }
    }

    /// Floats of an attribute; nothing where the primitive has none, or (texture coordinates) none
    /// as floats.
    std::optional<Elements> attribute(const tinygltf::Primitive& primitive, const char* name,
                                      int type) const {
        const auto found = primitive.attributes.find(name);
        if (found == primitive.attributes.end())
            return std::nullopt;
        const Elements elements = elements_of(found->second, name, type);
        if (elements.component == TINYGLTF_COMPONENT_TYPE_FLOAT)
            return elements;
        if (type == TINYGLTF_TYPE_VEC2)
            return std::nullopt;
        refuse(name, fmt::format("component type {}", elements.component), "floats");
    }

    Elements elements_of(int index, std::string_view what, int type) const {
        if (!inside(index, model_.accessors.size()))
            refuse(what, fmt::format("accessor {}", index),
                   fmt::format("one of {}", model_.accessors.size()));
        const tinygltf::Accessor& accessor = model_.accessors[static_cast<std::size_t>(index)];
        const int component_bytes =
            tinygltf::GetComponentSizeInBytes(static_cast<std::uint32_t>(accessor.componentType));
        const bool index_type = accessor.componentType == TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE ||
                                accessor.componentType == TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT ||
                                accessor.componentType == TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT;
        if (accessor.type != type || component_bytes < 1 ||
            (type == TINYGLTF_TYPE_SCALAR && !index_type))
            refuse(what, fmt::format("accessor {} of another type", index), "what glTF says of it");
        if (accessor.sparse.isSparse || !inside(accessor.bufferView, model_.bufferViews.size()))
            refuse(what, fmt::format("accessor {} that is sparse or has no buffer view", index),
                   "plain data");
        const tinygltf::BufferView& view =
            model_.bufferViews[static_cast<std::size_t>(accessor.bufferView)];
        if (!inside(view.buffer, model_.buffers.size()))
            refuse(what, fmt::format("buffer {}", view.buffer),
                   fmt::format("one of {}", model_.buffers.size()));
        const auto& data = model_.buffers[static_cast<std::size_t>(view.buffer)].data;
        const auto bytes = static_cast<std::size_t>(component_bytes) *
                           static_cast<std::size_t>(
                               tinygltf::GetNumComponentsInType(static_cast<std::uint32_t>(type)));
        const std::size_t stride = view.byteStride == 0 ? bytes : view.byteStride;
        // Counts may be 2^32 and offsets anything: no sum of them before each is known to be small.
        const bool fits = view.byteOffset <= data.size() &&
                          view.byteLength <= data.size() - view.byteOffset &&
                          accessor.byteOffset <= view.byteLength && stride >= bytes &&
                          stride <= 4096 && accessor.count <= data.size() &&
                          (accessor.count == 0 || (accessor.count - 1) * stride + bytes <=
                                                      view.byteLength - accessor.byteOffset);
        if (!fits)
            refuse(what, fmt::format("{} values that end beyond their buffer", accessor.count),
                   "an end inside");
        return {data.data() + view.byteOffset + accessor.byteOffset, accessor.count, stride,
                accessor.componentType};
    }

    /// Normals that the file left out: the mean of the triangles about a vertex, by area.
    void finish_normals() {
        std::vector<glm::dvec3> sums(mesh_.positions.size(), glm::dvec3(0));
        for (const auto& corners : mesh_.triangles)
            for (const std::uint32_t corner : corners)
                sums[corner] += area_vector(corners);
        for (std::size_t i = 0; i < sums.size(); ++i) {
            if (mesh_.normals[i] != glm::vec3(0))
                continue;
            const double size = glm::length(sums[i]);
            mesh_.normals[i] = size > 0 ? glm::vec3(sums[i] / size) : glm::vec3(0, 1, 0);
        }
    }

    const std::filesystem::path& path_;
    const tinygltf::Model& model_;
    scene::Mesh mesh_;
    bool all_have_uvs_ = true;
};

} // namespace

scene::Mesh load_mesh(const std::filesystem::path& path) {
    const tinygltf::Model model = read_gltf(path);
    return MeshReader(path, model).read();
}

} // namespace sward::assets
