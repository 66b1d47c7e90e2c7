// SPDX-License-Identifier: Apache-2.0
// Meshes from glTF: what is read, and what hostile files end in.
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <functional>
#include <limits>

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include "assets/assets.h"
#include "base/error.h"

namespace sward::assets {
namespace {

namespace fs = std::filesystem;
using base::ExitCode;

std::string raw(const std::vector<float>& values) {
    return {reinterpret_cast<const char*>(values.data()), values.size() * sizeof(float)};
}

/// A glTF of one triangle in buffer "mesh.bin", each part of it replaceable.
struct Parts {
    std::string buffers = R"([{"byteLength":42,"uri":"mesh.bin"}])";
    std::string views =
        R"([{"buffer":0,"byteLength":36},{"buffer":0,"byteOffset":36,"byteLength":6}])";
    std::string accessors = R"([{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3"},
                               {"bufferView":1,"componentType":5123,"count":3,"type":"SCALAR"}])";
    std::string meshes = R"([{"primitives":[{"attributes":{"POSITION":0},"indices":1}]}])";
    std::string nodes = R"([{"mesh":0}])";
    std::string scenes = R"([{"nodes":[0]}])";
    std::string more;
    [[nodiscard]] std::string text() const {
        return R"({"asset":{"version":"2.0"},"buffers":)" + buffers + R"(,"bufferViews":)" + views +
               R"(,"accessors":)" + accessors + R"(,"meshes":)" + meshes + R"(,"nodes":)" + nodes +
               R"(,"scenes":)" + scenes + more + "}";
    }
};

class MeshFile : public testing::Test {
protected:
    void SetUp() override {
        std::string name = (fs::temp_directory_path() / "sward_mesh_XXXXXX").string();
        dir_ = ::mkdtemp(name.data());
        put("mesh.bin", raw({0, 0, 0, 4, 0, 0, 0, 0, -2}) + std::string("\0\0\1\0\2\0", 6));
    }
    void TearDown() override { fs::remove_all(dir_); }
    void put(const std::string& name, const std::string& bytes) const {
        std::ofstream(dir_ / name, std::ios::binary) << bytes;
    }
    [[nodiscard]] scene::Mesh load(const Parts& parts) const {
        put("m.gltf", parts.text());
        return load_mesh(dir_ / "m.gltf");
    }
    /// The message behind the directory.
    std::string error(const std::string& name, ExitCode code = ExitCode::kBadInput) const {
        try {
            (void)load_mesh(dir_ / name);
        } catch (const base::Error& error) {
            EXPECT_EQ(error.code(), code) << error.what();
            const std::string text = error.what();
            return text.starts_with(dir_.string()) ? text.substr(dir_.string().size() + 1) : text;
        }
        return "no error";
    }
    std::string error(const Parts& parts, ExitCode code = ExitCode::kBadInput) const {
        put("m.gltf", parts.text());
        return error("m.gltf", code);
    }
    static std::string glb(std::string json, std::string binary) {
        json.resize((json.size() + 3) / 4 * 4, ' ');
        binary.resize((binary.size() + 3) / 4 * 4, '\0');
        const auto word = [](std::size_t n) {
            const auto value = static_cast<std::uint32_t>(n);
            return std::string(reinterpret_cast<const char*>(&value), 4);
        };
        return "glTF" + word(2) + word(28 + json.size() + binary.size()) + word(json.size()) +
               "JSON" + json + word(binary.size()) + std::string("BIN\0", 4) + binary;
    }
    fs::path dir_;
};

TEST_F(MeshFile, ReadsATriangle) {
    const scene::Mesh mesh = load({});
    ASSERT_EQ(mesh.triangles.size(), 1u);
    EXPECT_EQ(mesh.positions, (std::vector<glm::vec3>{{0, 0, 0}, {4, 0, 0}, {0, 0, -2}}));
    EXPECT_EQ(mesh.triangles[0], (std::array<std::uint32_t, 3>{0, 1, 2}));
    EXPECT_EQ(mesh.normals[2], glm::vec3(0, 1, 0)) << "from the triangle";
    EXPECT_TRUE(mesh.uvs.empty());
}

TEST_F(MeshFile, ReadsBinaryDataUrisAndNamesWithSpaces) {
    Parts parts;
    parts.buffers = R"([{"byteLength":42}])";
    std::ifstream in(dir_ / "mesh.bin", std::ios::binary);
    const std::string binary((std::istreambuf_iterator<char>(in)), {});
    put("m.glb", glb(parts.text(), binary));
    EXPECT_EQ(load_mesh(dir_ / "m.glb").triangles.size(), 1u);
    fs::create_directory(dir_ / "sub");
    put("sub/a b.bin", binary);
    parts.buffers = R"([{"byteLength":42,"uri":"sub/a%20b.bin"}])";
    EXPECT_EQ(load(parts).triangles.size(), 1u);
    parts.buffers = R"([{"byteLength":36,"uri":"data:application/octet-stream;base64,)"
                    R"(AAAAAAAAAAAAAAAAAACAQAAAAAAAAAAAAAAAAAAAAAAAAADA"}])";
    parts.views = R"([{"buffer":0,"byteLength":36}])";
    parts.accessors = R"([{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3"}])";
    parts.meshes = R"([{"primitives":[{"attributes":{"POSITION":0}}]}])";
    EXPECT_EQ(load(parts).positions[1], glm::vec3(4, 0, 0));
}

TEST_F(MeshFile, TransformsNestAndMirrorsKeepTheirOutside) {
    Parts parts;
    // Turned by 90 degrees about y (x to -z), then moved and scaled by the parent.
    parts.nodes = R"([{"children":[1],"translation":[10,0,0],"scale":[2,2,2]},
                     {"mesh":0,"rotation":[0,0.70710678,0,0.70710678]},{"mesh":0,"scale":[-1,1,1]}])";
    parts.scenes = R"([{"nodes":[0,2]}])";
    const scene::Mesh mesh = load(parts);
    ASSERT_EQ(mesh.triangles.size(), 2u);
    EXPECT_NEAR(glm::distance(mesh.positions[1], glm::vec3(10, 0, -8)), 0, 1e-5);
    for (std::size_t t = 0; t < 2; ++t) {
        const auto& c = mesh.triangles[t];
        EXPECT_GT(glm::cross(mesh.positions[c[1]] - mesh.positions[c[0]],
                             mesh.positions[c[2]] - mesh.positions[c[0]])
                      .y,
                  0)
            << t;
        EXPECT_NEAR(mesh.normals[c[0]].y, 1, 1e-6);
    }
}

TEST_F(MeshFile, StripsAndFansAreTriangles) {
    put("mesh.bin", raw({0, 0, 0, 1, 0, 0, 0, 0, -1, 1, 0, -1}));
    Parts parts;
    parts.buffers = R"([{"byteLength":48,"uri":"mesh.bin"}])";
    parts.views = R"([{"buffer":0,"byteLength":48}])";
    parts.accessors = R"([{"bufferView":0,"componentType":5126,"count":4,"type":"VEC3"}])";
    parts.meshes = R"([{"primitives":[{"attributes":{"POSITION":0},"mode":5}]}])";
    const scene::Mesh strip = load(parts);
    ASSERT_EQ(strip.triangles.size(), 2u);
    for (const glm::vec3& normal : strip.normals)
        EXPECT_NEAR(normal.y, 1, 1e-6);
    parts.meshes = R"([{"primitives":[{"attributes":{"POSITION":0},"mode":6}]}])";
    EXPECT_EQ(load(parts).triangles[1], (std::array<std::uint32_t, 3>{0, 2, 3}));
    parts.meshes = R"([{"primitives":[{"attributes":{"POSITION":0},"mode":1}]}])";
    EXPECT_NE(error(parts).find("no triangle with an area"), std::string::npos) << "lines";
}

TEST_F(MeshFile, FilesThatAreNoneAreRefused) {
    EXPECT_NE(error("missing.glb", ExitCode::kIo).find("missing.glb"), std::string::npos);
    put("empty.glb", "");
    EXPECT_EQ(error("empty.glb"), "empty.glb: file: found no JSON, expected glTF 2.0");
    put("text.gltf", "hello");
    EXPECT_EQ(error("text.gltf"), "text.gltf: file: found no JSON object, expected glTF 2.0");
    fs::create_directory(dir_ / "folder.glb");
    (void)error("folder.glb", ExitCode::kIo);
    ASSERT_EQ(::mkfifo((dir_ / "pipe.glb").c_str(), 0600), 0);
    (void)error("pipe.glb", ExitCode::kIo);
}

TEST_F(MeshFile, TruncatedAndFlippedFilesNeverCrash) {
    Parts parts;
    parts.buffers = R"([{"byteLength":42}])";
    std::ifstream in(dir_ / "mesh.bin", std::ios::binary);
    const std::string whole =
        glb(parts.text(), std::string((std::istreambuf_iterator<char>(in)), {}));
    for (std::size_t size = 0; size < whole.size(); size += 7) {
        put("cut.glb", whole.substr(0, size));
        EXPECT_NE(error("cut.glb"), "no error") << size;
    }
    int refused = 0;
    for (std::size_t at = 0; at < whole.size(); ++at) {
        std::string flipped = whole;
        flipped[at] = static_cast<char>(flipped[at] ^ 0x15);
        put("flip.glb", flipped);
        try {
            const scene::Mesh mesh = load_mesh(dir_ / "flip.glb");
            for (const auto& corners : mesh.triangles)
                for (const auto corner : corners)
                    ASSERT_LT(corner, mesh.positions.size());
        } catch (const base::Error& error) {
            EXPECT_LE(static_cast<int>(error.code()), 5);
            ++refused;
        }
    }
    EXPECT_GT(refused, 100);
}

TEST_F(MeshFile, DeepJsonIsCountedBeforeItIsParsed) {
    put("deep.gltf", std::string(30000, '[') + std::string(30000, ']'));
    EXPECT_EQ(error("deep.gltf", ExitCode::kOverLimit),
              "deep.gltf: JSON: found deeper nesting, expected at most 64 levels");
    std::string object;
    for (int i = 0; i < 30000; ++i)
        object += "{\"a\":";
    put("deep.gltf", object);
    (void)error("deep.gltf", ExitCode::kOverLimit);
}

TEST_F(MeshFile, IndicesAndRangesStayInside) {
    put("mesh.bin", raw({0, 0, 0, 4, 0, 0, 0, 0, -2}) + std::string("\0\0\1\0\3\0", 6));
    EXPECT_EQ(error(Parts{}), "m.gltf: indices: found 3, expected less than the 3 vertices");
    Parts parts;
    parts.accessors = R"([{"bufferView":0,"componentType":5126,"count":4294967295,"type":"VEC3"},
                         {"bufferView":1,"componentType":5123,"count":3,"type":"SCALAR"}])";
    EXPECT_NE(error(parts).find("end beyond their buffer"), std::string::npos);
    parts = {};
    parts.views = R"([{"buffer":0,"byteLength":4000},{"buffer":0,"byteOffset":36,"byteLength":6}])";
    EXPECT_NE(error(parts).find("end beyond their buffer"), std::string::npos);
    parts = {};
    parts.views = R"([{"buffer":7,"byteLength":36},{"buffer":0,"byteOffset":36,"byteLength":6}])";
    EXPECT_NE(error(parts), "no error");
    parts = {};
    parts.meshes = R"([{"primitives":[{"attributes":{"POSITION":9},"indices":1}]}])";
    EXPECT_NE(error(parts), "no error");
    parts = {};
    parts.nodes = R"([{"mesh":5}])";
    EXPECT_EQ(error(parts), "m.gltf: mesh: found 5, expected one of 1");
    parts = {};
    parts.scenes = R"([{"nodes":[3]}])";
    EXPECT_EQ(error(parts), "m.gltf: node: found 3, expected one of 1");
}

TEST_F(MeshFile, NumbersAreFiniteAndTrianglesHaveAreas) {
    const float nan = std::numeric_limits<float>::quiet_NaN(),
                inf = std::numeric_limits<float>::infinity();
    for (const float bad : {nan, inf, -inf, 1e30f}) {
        put("mesh.bin", raw({0, 0, 0, 4, bad, 0, 0, 0, -2}) + std::string("\0\0\1\0\2\0", 6));
        EXPECT_NE(error(Parts{}).find("POSITION"), std::string::npos) << bad;
    }
    put("mesh.bin", raw({0, 0, 0, 1, 0, 0, 2, 0, 0}) + std::string("\0\0\1\0\2\0", 6));
    EXPECT_EQ(error(Parts{}), "m.gltf: mesh: found no triangle with an area, expected at least "
                              "one, in a node of the scene");
    Parts parts;
    parts.nodes = R"([{"mesh":0,"rotation":[0,0,0,0]}])";
    EXPECT_NE(error(parts).find("rotation of node 0 by nothing"), std::string::npos);
    parts.nodes = R"([{"mesh":0,"scale":[1e400,1,1]}])";
    EXPECT_NE(error(parts), "no error");
}

TEST_F(MeshFile, UrisStayInTheDirectory) {
    put("outside.bin", "x");
    fs::create_directory(dir_ / "in");
    fs::create_symlink(dir_ / "mesh.bin", dir_ / "in" / "link.bin");
    fs::create_directory_symlink(dir_, dir_ / "in" / "up");
    for (const char* const uri :
         {"../mesh.bin", "sub/../../mesh.bin", "%2e%2e/mesh.bin", "..%2fmesh.bin", "/etc/passwd",
          "file:///etc/passwd", "http://example.com/a.bin", "link.bin", "up/mesh.bin", "a%zz.bin",
          "..\\\\mesh.bin", ""}) {
        Parts parts;
        parts.buffers = std::string(R"([{"byteLength":42,"uri":")") + uri + R"("}])";
        put("in/m.gltf", parts.text());
        EXPECT_NE(error("in/m.gltf").find("buffer's URI"), std::string::npos) << uri;
    }
    Parts parts;
    parts.buffers = R"([{"byteLength":42,"uri":"gone.bin"}])";
    EXPECT_NE(error(parts, ExitCode::kIo).find("gone.bin"), std::string::npos);
}

TEST_F(MeshFile, NodesAreATree) {
    Parts parts;
    parts.nodes = R"([{"children":[1]},{"children":[0],"mesh":0}])";
    EXPECT_EQ(error(parts),
              "m.gltf: node: found 0 a second time, expected a tree: one parent each, no loop");
    parts.nodes = R"([{"children":[1,1]},{"mesh":0}])";
    EXPECT_NE(error(parts).find("a second time"), std::string::npos);
    // A chain as long as nesting could be: no recursion.
    parts.nodes = "[";
    for (int i = 0; i < 50000; ++i)
        parts.nodes += "{\"children\":[" + std::to_string(i + 1) + "]},";
    parts.nodes += R"({"mesh":0}])";
    EXPECT_EQ(load(parts).triangles.size(), 1u);
}

TEST_F(MeshFile, ExtensionsThatAreRequiredAreRefusedByName) {
    Parts parts;
    parts.more =
        R"(,"extensionsUsed":["KHR_draco_mesh_compression"],"extensionsRequired":["KHR_draco_mesh_compression"])";
    EXPECT_NE(error(parts).find("extensionsRequired: found [\"KHR_draco_mesh_compression\"]"),
              std::string::npos);
    parts.more = R"(,"extensionsUsed":["KHR_materials_unlit"])";
    EXPECT_EQ(load(parts).triangles.size(), 1u);
}

TEST_F(MeshFile, PicturesAreNotOpened) {
    Parts parts;
    parts.more = R"(,"images":[{"uri":"../../secret.png"},{"uri":"data:image/png;base64,AAAA"}])";
    EXPECT_EQ(load(parts).triangles.size(), 1u);
}

} // namespace
} // namespace sward::assets
