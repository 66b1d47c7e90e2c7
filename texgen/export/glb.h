// SPDX-License-Identifier: Apache-2.0
// Binary glTF 2.0 of meshes: accessors over one buffer, and the JSON that names them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <nlohmann/json.hpp>

namespace sward::texgen {

class GlbWriter {
public:
    GlbWriter();

    /// Index of a new accessor. Floats of 2 or 3 components, with their bounds where `bounds`
    /// (POSITION needs them).
    int add_floats(std::span<const float> values, int components, bool bounds = false);
    /// Four 16-bit numbers a vertex that stand for 0..1.
    int add_unorm16(std::span<const std::uint16_t> values);
    /// 16 bits each where `vertices` allows it.
    int add_indices(std::span<const std::uint32_t> values, std::size_t vertices);

    /// Everything but buffers, bufferViews and accessors is the caller's to add.
    nlohmann::ordered_json root;

    /// The file's bytes. Throws base::Error(kOverLimit) above what a GLB can hold.
    [[nodiscard]] std::vector<std::byte> finish();

private:
    struct Kind {
        int component_type;
        const char* type;
        int target;
    };
    int add(const void* data, std::size_t bytes, std::size_t count, Kind kind);

    std::vector<std::byte> buffer_;
};

} // namespace sward::texgen
