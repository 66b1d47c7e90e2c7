// SPDX-License-Identifier: Apache-2.0
#include "grass/blades_glb.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <map>
#include <sstream>
#include <string_view>

#include <fmt/format.h>
#include <tiny_gltf.h>

#include "base/error.h"
#include "grass/set_files.h"

namespace sward::grass {
namespace {

using base::ExitCode;
using shared::BladeRecord;

constexpr std::size_t kMaxBlades = 1 << 24;
constexpr std::size_t kMaxJsonBytes = 4 << 20;
constexpr int kMaxJsonDepth = 32;

/// One vertex attribute: name, components, and where its numbers stand in a record (nullptr:
/// computed).
struct Attribute {
    const char* name;
    int components;
    void (*read)(const BladeRecord&, float*);
    void (*write)(BladeRecord&, const float*);
};

float tip_height(const BladeRecord& b) {
    return b.v2.y;
}

// The full width is exactly twice the half width in binary, so that the round trip is exact.
const std::array<Attribute, 12> kAttributes = {{
    {"POSITION", 3,
     [](const BladeRecord& b, float* f) { f[0] = b.root.x, f[1] = 0, f[2] = b.root.y; },
     [](BladeRecord& b, const float* f) { b.root.x = f[0], b.root.y = f[2]; }},
    {"_DROOP", 1, [](const BladeRecord& b, float* f) { *f = b.shape.z; },
     [](BladeRecord& b, const float* f) { b.shape.z = *f; }},
    {"_FACING", 1, [](const BladeRecord& b, float* f) { *f = b.shape.x; },
     [](BladeRecord& b, const float* f) { b.shape.x = *f; }},
    {"_HEIGHT", 1, [](const BladeRecord& b, float* f) { *f = tip_height(b); },
     [](BladeRecord&, const float*) {}},
    {"_LENGTH", 1, [](const BladeRecord& b, float* f) { *f = b.shape.y; },
     [](BladeRecord& b, const float* f) { b.shape.y = *f; }},
    {"_RANK", 1, [](const BladeRecord& b, float* f) { *f = b.root.z; },
     [](BladeRecord& b, const float* f) { b.root.z = *f; }},
    {"_SEED", 1, [](const BladeRecord& b, float* f) { *f = b.root.w; },
     [](BladeRecord& b, const float* f) { b.root.w = *f; }},
    {"_SPECIES", 1, [](const BladeRecord& b, float* f) { *f = b.shape.w; },
     [](BladeRecord& b, const float* f) { b.shape.w = *f; }},
    {"_STIFFNESS", 1, [](const BladeRecord& b, float* f) { *f = b.v2.w; },
     [](BladeRecord& b, const float* f) { b.v2.w = *f; }},
    {"_V1", 3, [](const BladeRecord& b, float* f) { f[0] = b.v1.x, f[1] = b.v1.y, f[2] = b.v1.z; },
     [](BladeRecord& b, const float* f) { b.v1.x = f[0], b.v1.y = f[1], b.v1.z = f[2]; }},
    {"_V2", 3, [](const BladeRecord& b, float* f) { f[0] = b.v2.x, f[1] = b.v2.y, f[2] = b.v2.z; },
     [](BladeRecord& b, const float* f) { b.v2.x = f[0], b.v2.y = f[1], b.v2.z = f[2]; }},
    {"_WIDTH", 1, [](const BladeRecord& b, float* f) { *f = b.v1.w * 2; },
     [](BladeRecord& b, const float* f) { b.v1.w = *f / 2; }},
}};

/// Components of an attribute that go into one accessor.
struct Part {
    int first = 0, count = 0;
};

int add_accessor(tinygltf::Model& model, const Attribute& attribute, Part part,
                 std::span<const BladeRecord> blades) {
    const auto components = static_cast<std::size_t>(part.count);
    std::vector<unsigned char>& data = model.buffers[0].data;
    tinygltf::BufferView view;
    view.buffer = 0;
    view.byteOffset = data.size();
    view.byteLength = blades.size() * components * sizeof(float);
    view.target = TINYGLTF_TARGET_ARRAY_BUFFER;
    tinygltf::Accessor accessor;
    accessor.bufferView = static_cast<int>(model.bufferViews.size());
    accessor.componentType = TINYGLTF_COMPONENT_TYPE_FLOAT;
    accessor.type = part.count == 3 ? TINYGLTF_TYPE_VEC3 : TINYGLTF_TYPE_SCALAR;
    accessor.count = blades.size();
    accessor.minValues.assign(components, 1e30);
    accessor.maxValues.assign(components, -1e30);
    data.resize(data.size() + view.byteLength);
    unsigned char* out = data.data() + view.byteOffset;
    for (const BladeRecord& blade : blades) {
        float f[3] = {};
        attribute.read(blade, f);
        const float* values = f + part.first;
        for (std::size_t c = 0; c < components; ++c) {
            accessor.minValues[c] = std::min(accessor.minValues[c], static_cast<double>(values[c]));
            accessor.maxValues[c] = std::max(accessor.maxValues[c], static_cast<double>(values[c]));
        }
        std::memcpy(out, values, components * sizeof(float));
        out += components * sizeof(float);
    }
    model.bufferViews.push_back(view);
    model.accessors.push_back(accessor);
    return static_cast<int>(model.accessors.size()) - 1;
}

/// "_V1" -> "_V1_X" and so on.
std::string component_name(const Attribute& attribute, int component) {
    return fmt::format("{}_{}", attribute.name, "XYZ"[component]);
}

bool is_split(const Attribute& attribute) {
    return attribute.components > 1 && attribute.name[0] == '_';
}

void add_attribute(tinygltf::Model& model, tinygltf::Primitive& points, const Attribute& attribute,
                   std::span<const BladeRecord> blades) {
    if (!is_split(attribute)) {
        points.attributes[attribute.name] =
            add_accessor(model, attribute, {0, attribute.components}, blades);
        return;
    }
    for (int c = 0; c < attribute.components; ++c)
        points.attributes[component_name(attribute, c)] =
            add_accessor(model, attribute, {c, 1}, blades);
}

/// Depth and length of the JSON chunk, before a recursive parser sees it.
void scan_json(std::span<const std::byte> bytes, const std::filesystem::path& name) {
    const auto refuse = [&](ExitCode code, std::string_view what, const std::string& found,
                            const std::string& expected) {
        throw base::input_error(code, name, 0, what, found, expected);
    };
    std::uint32_t head[5] = {};
    if (bytes.size() < sizeof head)
        refuse(ExitCode::kBadInput, "file", fmt::format("{} bytes", bytes.size()),
               "binary glTF 2.0");
    std::memcpy(head, bytes.data(), sizeof head);
    constexpr std::uint32_t kMagic = 0x46546C67, kJson = 0x4E4F534A;
    if (head[0] != kMagic || head[1] != 2 || head[2] != bytes.size() || head[4] != kJson ||
        head[3] > bytes.size() - sizeof head)
        refuse(ExitCode::kBadInput, "header", "another format or length", "binary glTF 2.0");
    if (head[3] > kMaxJsonBytes)
        refuse(ExitCode::kOverLimit, "JSON", fmt::format("{} bytes", head[3]),
               fmt::format("at most {}", kMaxJsonBytes));
    int depth = 0;
    for (const std::byte b : bytes.subspan(sizeof head, head[3])) {
        const char c = static_cast<char>(b);
        depth += c == '{' || c == '['   ? 1
                 : c == '}' || c == ']' ? -1
                                        : 0; // brackets in strings only make it stricter
        if (depth > kMaxJsonDepth)
            refuse(ExitCode::kBadInput, "JSON", "deeper nesting",
                   fmt::format("at most {} levels", kMaxJsonDepth));
    }
}

tinygltf::TinyGLTF loader_without_files() {
    // Memory only: whatever the JSON names outside itself does not exist.
    tinygltf::TinyGLTF loader;
    tinygltf::FsCallbacks none{};
    none.FileExists = [](const std::string&, void*) { return false; };
    none.ExpandFilePath = [](const std::string& path, void*) { return path; };
    none.ReadWholeFile = [](std::vector<unsigned char>*, std::string* error, const std::string&,
                            void*) {
        *error = "external files are not read";
        return false;
    };
    none.WriteWholeFile = [](std::string*, const std::string&, const std::vector<unsigned char>&,
                             void*) { return false; };
    loader.SetFsCallbacks(none);
    return loader;
}

/// Reads the attributes of one variant's points.
class VariantReader {
public:
    VariantReader(const tinygltf::Model& model, const std::filesystem::path& name)
        : model_(model), name_(name) {}

    std::vector<BladeRecord> read(const tinygltf::Mesh& mesh) const {
        if (mesh.primitives.size() != 1 || mesh.primitives[0].mode != TINYGLTF_MODE_POINTS)
            refuse("mesh", "something else", "one primitive of points");
        const auto& attributes = mesh.primitives[0].attributes;
        std::vector<BladeRecord> blades;
        for (const Attribute& attribute : kAttributes) {
            const std::vector<float> values = numbers(attributes, attribute);
            const auto components = static_cast<std::size_t>(attribute.components);
            const std::size_t count = values.size() / components;
            if (blades.empty())
                blades.assign(count, BladeRecord{shared::vec4(0), shared::vec4(0), shared::vec4(0),
                                                 shared::vec4(0)});
            if (blades.size() != count)
                refuse(attribute.name, fmt::format("{} values", count),
                       std::to_string(blades.size()));
            if (!std::ranges::all_of(values, [](float v) { return std::isfinite(v); }))
                refuse(attribute.name, "NaN or infinity", "finite numbers");
            for (std::size_t i = 0; i < count; ++i)
                attribute.write(blades[i], &values[i * components]);
        }
        return blades;
    }

    [[noreturn]] void refuse(std::string_view what, const std::string& found,
                             const std::string& expected) const {
        throw base::input_error(ExitCode::kBadInput, name_, 0, what, found, expected);
    }

private:
    using Names = std::map<std::string, int>; ///< an attribute's accessor

    /// All values of an attribute, one after the other; of a vector in three attributes or, as sets
    /// were written once, in one.
    std::vector<float> numbers(const Names& names, const Attribute& attribute) const {
        const bool split = is_split(attribute) && !names.contains(attribute.name);
        const int parts = split ? attribute.components : 1, each = split ? 1 : attribute.components;
        std::vector<float> values;
        for (int part = 0; part < parts; ++part) {
            const std::string name = split ? component_name(attribute, part) : attribute.name;
            const auto found = names.find(name);
            if (found == names.end())
                refuse("attribute", "none", name);
            const auto [data, count] = floats(found->second, name, each);
            if (part > 0 && values.size() != count * static_cast<std::size_t>(parts))
                refuse(name, fmt::format("{} values", count),
                       fmt::format("{}", values.size() / static_cast<std::size_t>(parts)));
            values.resize(count * static_cast<std::size_t>(attribute.components));
            if (!split)
                std::memcpy(values.data(), data, values.size() * sizeof(float));
            for (std::size_t i = 0; split && i < count; ++i)
                std::memcpy(
                    &values[i * static_cast<std::size_t>(parts) + static_cast<std::size_t>(part)],
                    data + i * sizeof(float), sizeof(float));
        }
        return values;
    }

    /// Start and count of a tightly packed float accessor, bounds checked.
    std::pair<const unsigned char*, std::size_t> floats(int index, const std::string& name,
                                                        int components) const {
        const auto inside = [](int i, std::size_t size) {
            return i >= 0 && static_cast<std::size_t>(i) < size;
        };
        if (!inside(index, model_.accessors.size()))
            refuse(name, "an accessor that is not there", "one that is");
        const tinygltf::Accessor& accessor = model_.accessors[static_cast<std::size_t>(index)];
        const int type = components == 3 ? TINYGLTF_TYPE_VEC3 : TINYGLTF_TYPE_SCALAR;
        if (accessor.componentType != TINYGLTF_COMPONENT_TYPE_FLOAT || accessor.type != type ||
            accessor.sparse.isSparse)
            refuse(name, "another type", "plain floats");
        if (!inside(accessor.bufferView, model_.bufferViews.size()))
            refuse(name, "a buffer view that is not there", "one that is");
        const tinygltf::BufferView& view =
            model_.bufferViews[static_cast<std::size_t>(accessor.bufferView)];
        const std::size_t bytes =
            accessor.count * static_cast<std::size_t>(components) * sizeof(float);
        if (accessor.count == 0 || accessor.count > kMaxBlades || accessor.byteOffset != 0 ||
            bytes > view.byteLength ||
            (view.byteStride != 0 &&
             view.byteStride != static_cast<std::size_t>(components) * sizeof(float)))
            refuse(name, fmt::format("{} values", accessor.count),
                   "a packed accessor inside its view");
        if (!inside(view.buffer, model_.buffers.size()))
            refuse(name, "a buffer that is not there", "one that is");
        const std::vector<unsigned char>& data =
            model_.buffers[static_cast<std::size_t>(view.buffer)].data;
        if (view.byteOffset > data.size() || view.byteLength > data.size() - view.byteOffset)
            refuse(name, "an end beyond the buffer", "an end inside");
        return {data.data() + view.byteOffset, accessor.count};
    }

    const tinygltf::Model& model_;
    const std::filesystem::path& name_;
};

void check_blades(std::span<const BladeRecord> blades, float side_m, const VariantReader& reader) {
    constexpr float kFar = 100; // metres: no blade is this long
    for (const BladeRecord& b : blades) {
        if (!(b.root.x >= 0 && b.root.x < side_m && b.root.y >= 0 && b.root.y < side_m))
            reader.refuse("POSITION", fmt::format("{}, {}", b.root.x, b.root.y),
                          fmt::format("a root inside [0, {})", side_m));
        if (!(b.root.z > 0 && b.root.z < 1 && b.root.w > 0 && b.root.w < 1))
            reader.refuse("_RANK, _SEED", fmt::format("{}, {}", b.root.z, b.root.w),
                          "inside (0, 1)");
        for (const shared::vec4& v : {b.v1, b.v2})
            if (std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z), std::abs(v.w)}) > kFar)
                reader.refuse("_V1, _V2", "a blade of more than 100 m", "metres");
        if (!(b.shape.y > 0 && b.v1.w >= 0))
            reader.refuse("_LENGTH, _WIDTH", fmt::format("{}, {}", b.shape.y, b.v1.w * 2),
                          "positive");
    }
}

} // namespace

std::vector<std::byte> encode_blades(std::span<const BladeRecord> blades,
                                     std::span<const std::uint32_t> variant_begin, float side_m) {
    tinygltf::Model model;
    model.asset.version = "2.0";
    model.asset.generator = "Sward texgen";
    model.buffers.emplace_back();
    model.scenes.emplace_back();
    model.scenes[0].name = "grass set";
    model.defaultScene = 0;
    for (std::size_t v = 0; v + 1 < variant_begin.size(); ++v) {
        const auto part = blades.subspan(variant_begin[v], variant_begin[v + 1] - variant_begin[v]);
        tinygltf::Primitive points;
        points.mode = TINYGLTF_MODE_POINTS;
        for (const Attribute& attribute : kAttributes)
            add_attribute(model, points, attribute, part);
        tinygltf::Mesh mesh;
        mesh.name = fmt::format("variant {}", v);
        mesh.primitives.push_back(points);
        tinygltf::Node node;
        node.name = mesh.name;
        node.mesh = static_cast<int>(model.meshes.size());
        if (v > 0)
            node.translation = {static_cast<double>(v) * side_m, 0, 0};
        model.meshes.push_back(mesh);
        model.scenes[0].nodes.push_back(static_cast<int>(model.nodes.size()));
        model.nodes.push_back(node);
    }
    std::ostringstream stream;
    tinygltf::TinyGLTF writer;
    if (!writer.WriteGltfSceneToStream(&model, stream, false, true))
        throw base::Error(ExitCode::kFailure, "blades.glb: tinygltf could not write it");
    const std::string text = std::move(stream).str();
    const auto* raw = reinterpret_cast<const std::byte*>(text.data());
    return {raw, raw + text.size()};
}

BladeList decode_blades(std::span<const std::byte> bytes, const std::filesystem::path& name,
                        float side_m) {
    scan_json(bytes, name);
    tinygltf::Model model;
    std::string error, warning;
    tinygltf::TinyGLTF loader = loader_without_files();
    bool loaded = false;
    try {
        loaded = loader.LoadBinaryFromMemory(&model, &error, &warning,
                                             reinterpret_cast<const unsigned char*>(bytes.data()),
                                             static_cast<unsigned int>(bytes.size()));
    } catch (const std::exception& problem) { // its JSON library throws
        error = problem.what();
    }
    const VariantReader reader(model, name);
    if (!loaded)
        reader.refuse("glTF", base::printable(error), "blades as texgen writes them");
    if (!model.extensionsRequired.empty())
        reader.refuse("extensionsRequired", base::printable(model.extensionsRequired[0]), "none");
    if (model.meshes.empty() || model.meshes.size() > kMaxVariants)
        reader.refuse("meshes", std::to_string(model.meshes.size()),
                      fmt::format("1 to {}", kMaxVariants));
    BladeList list;
    list.variant_begin.push_back(0);
    for (const tinygltf::Mesh& mesh : model.meshes) {
        const std::vector<BladeRecord> part = reader.read(mesh);
        check_blades(part, side_m, reader);
        list.blades.insert(list.blades.end(), part.begin(), part.end());
        list.variant_begin.push_back(static_cast<std::uint32_t>(list.blades.size()));
        if (list.blades.size() > kMaxBlades)
            throw base::input_error(ExitCode::kOverLimit, name, 0, "blades",
                                    std::to_string(list.blades.size()),
                                    fmt::format("at most {}", kMaxBlades));
    }
    return list;
}

} // namespace sward::grass
