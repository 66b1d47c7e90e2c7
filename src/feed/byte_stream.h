// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "feed/network_order.h"

namespace sward::feed {

/// Writes one after another, in network byte order.
class ByteWriter {
public:
    explicit ByteWriter(std::vector<std::byte>& out) : out_(out) {}
    template<class T> void put(T value) {
        const std::size_t at = out_.size();
        out_.resize(at + sizeof(T));
        write_big_endian(std::span(out_), at, value);
    }
    void put(const glm::dvec2& v) {
        put(v.x);
        put(v.y);
    }
    void put(const glm::dvec3& v) {
        put(v.x);
        put(v.y);
        put(v.z);
    }

private:
    std::vector<std::byte>& out_;
};

/// Reads likewise. What is past the end, or out of its range, is 0 and spoils all of it.
class ByteReader {
public:
    ByteReader(std::span<const std::byte> bytes, std::size_t at) : bytes_(bytes), at_(at) {}
    template<class T> [[nodiscard]] T take() {
        if (bytes_.size() - at_ < sizeof(T)) {
            good_ = false;
            return T{};
        }
        at_ += sizeof(T);
        return read_big_endian<T>(bytes_, at_ - sizeof(T));
    }
    [[nodiscard]] std::uint32_t count(std::size_t most) {
        const auto value = take<std::uint32_t>();
        good_ = good_ && value <= most;
        return good_ ? value : 0;
    }
    [[nodiscard]] double number(double least, double most) {
        const auto value = take<double>();
        good_ = good_ && value >= least && value <= most; // no NaN
        return good_ ? value : 0;
    }
    [[nodiscard]] glm::dvec2 two(double most) {
        const double x = number(-most, most);
        return {x, number(-most, most)};
    }
    [[nodiscard]] glm::dvec3 three(double most) {
        const glm::dvec2 xy = two(most);
        return {xy, number(-most, most)};
    }
    [[nodiscard]] bool good() const { return good_; }
    [[nodiscard]] std::size_t at() const { return at_; }

private:
    std::span<const std::byte> bytes_;
    std::size_t at_;
    bool good_ = true;
};

} // namespace sward::feed
