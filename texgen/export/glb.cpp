// SPDX-License-Identifier: Apache-2.0
#include "texgen/export/glb.h"

#include <algorithm>
#include <bit>
#include <cstring>

#include <fmt/format.h>

#include "base/error.h"

namespace sward::texgen {
namespace {

static_assert(std::endian::native == std::endian::little, "glTF is little-endian; so are we");
constexpr int kFloat = 5126, kUnsignedShort = 5123, kUnsignedInt = 5125;
constexpr int kVertices = 34962, kIndices = 34963; // GL's ARRAY_BUFFER, ELEMENT_ARRAY_BUFFER
constexpr std::uint64_t kMostBytes = std::uint64_t{1}
                                     << 30; // the format allows 4 GiB, many readers less

void append(std::vector<std::byte>& out, const void* data, std::size_t bytes) {
    const auto* first = static_cast<const std::byte*>(data);
    out.insert(out.end(), first, first + bytes);
}

void append_chunk(std::vector<std::byte>& out, const char* kind, std::span<const std::byte> data,
                  std::byte fill) {
    const std::size_t padded = (data.size() + 3) / 4 * 4;
    const auto size = static_cast<std::uint32_t>(padded);
    append(out, &size, 4);
    append(out, kind, 4);
    append(out, data.data(), data.size());
    out.insert(out.end(), padded - data.size(), fill);
}

} // namespace

GlbWriter::GlbWriter() {
    root["asset"] = {{"version", "2.0"}, {"generator", "Sward texgen"}};
    for (const char* list : {"bufferViews", "accessors"})
        root[list] = nlohmann::ordered_json::array();
}

int GlbWriter::add(const void* data, std::size_t bytes, std::size_t count, Kind kind) {
    root["bufferViews"].push_back({{"buffer", 0},
                                   {"byteOffset", buffer_.size()},
                                   {"byteLength", bytes},
                                   {"target", kind.target}});
    append(buffer_, data, bytes);
    buffer_.resize((buffer_.size() + 3) / 4 * 4);
    const auto index = static_cast<int>(root["accessors"].size());
    root["accessors"].push_back({{"bufferView", root["bufferViews"].size() - 1},
                                 {"componentType", kind.component_type},
                                 {"count", count},
                                 {"type", kind.type}});
    return index;
}

int GlbWriter::add_floats(std::span<const float> values, int components, bool bounds) {
    const std::size_t n = static_cast<std::size_t>(components), count = values.size() / n;
    const int index = add(values.data(), values.size_bytes(), count,
                          {kFloat, components == 2 ? "VEC2" : "VEC3", kVertices});
    if (bounds) {
        std::vector<float> low(values.begin(), values.begin() + components), high = low;
        for (std::size_t i = 0; i < values.size(); ++i) {
            low[i % n] = std::min(low[i % n], values[i]);
            high[i % n] = std::max(high[i % n], values[i]);
        }
        root["accessors"].back()["min"] = low;
        root["accessors"].back()["max"] = high;
    }
    return index;
}

int GlbWriter::add_unorm16(std::span<const std::uint16_t> values) {
    const int index = add(values.data(), values.size_bytes(), values.size() / 4,
                          {kUnsignedShort, "VEC4", kVertices});
    root["accessors"].back()["normalized"] = true;
    return index;
}

int GlbWriter::add_indices(std::span<const std::uint32_t> values, std::size_t vertices) {
    if (vertices > 65535) // the last code of 16 bits restarts a strip
        return add(values.data(), values.size_bytes(), values.size(),
                   {kUnsignedInt, "SCALAR", kIndices});
    const std::vector<std::uint16_t> small(values.begin(), values.end());
    return add(small.data(), small.size() * 2, small.size(), {kUnsignedShort, "SCALAR", kIndices});
}

std::vector<std::byte> GlbWriter::finish() {
    root["buffers"] = nlohmann::ordered_json::array({{{"byteLength", buffer_.size()}}});
    const std::string json = root.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
    const std::uint64_t total = 12 + 8 + (json.size() + 3) / 4 * 4 + 8 + buffer_.size();
    if (total > kMostBytes)
        throw base::Error(
            base::ExitCode::kOverLimit,
            fmt::format("meshes: found {} bytes, expected at most {}", total, kMostBytes));
    std::vector<std::byte> out;
    out.reserve(total);
    const std::uint32_t head[2] = {2, static_cast<std::uint32_t>(total)};
    append(out, "glTF", 4);
    append(out, head, sizeof head);
    append_chunk(out, "JSON", std::as_bytes(std::span(json)), std::byte{' '});
    append_chunk(out, "BIN\0", buffer_, std::byte{0});
    return out;
}

} // namespace sward::texgen
