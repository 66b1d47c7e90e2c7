// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

namespace sward::base {

/// SHA-256 as 64 lower-case hex digits (FIPS 180-4): content keys of caches and of every file in a
/// grass set.
[[nodiscard]] std::string sha256_hex(std::span<const std::byte> bytes);
[[nodiscard]] std::string sha256_hex(const std::string& text);

/// Counter-based random numbers: the same (seed, stream, index) gives the same value on any thread,
/// in any order.
[[nodiscard]] std::uint64_t hash64(std::uint64_t seed, std::uint64_t stream, std::uint64_t index);
/// Uniform in [0, 1), 53 bits, of hash64.
[[nodiscard]] double hash_unit(std::uint64_t seed, std::uint64_t stream, std::uint64_t index);

} // namespace sward::base
