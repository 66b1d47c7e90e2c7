// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <type_traits>

namespace sward::feed {

template<class T> using BitsOf = std::conditional_t<sizeof(T) == 8, std::uint64_t, std::uint32_t>;

/// A number of 4 or 8 bytes in network byte order at `offset`; the caller has checked the size.
template<class T>
[[nodiscard]] T read_big_endian(std::span<const std::byte> bytes, std::size_t offset) {
    static_assert(sizeof(T) == 4 || sizeof(T) == 8);
    BitsOf<T> bits = 0;
    for (std::size_t i = 0; i < sizeof(T); ++i)
        bits = (bits << 8) | std::to_integer<BitsOf<T>>(bytes[offset + i]);
    return std::bit_cast<T>(bits);
}

template<class T> void write_big_endian(std::span<std::byte> bytes, std::size_t offset, T value) {
    static_assert(sizeof(T) == 4 || sizeof(T) == 8);
    BitsOf<T> bits = std::bit_cast<BitsOf<T>>(value);
    for (std::size_t i = sizeof(T); i-- > 0; bits >>= 8)
        bytes[offset + i] = static_cast<std::byte>(bits & 0xff);
}

} // namespace sward::feed
