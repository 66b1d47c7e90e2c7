// SPDX-License-Identifier: Apache-2.0
#include "assets/ascii_grid.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <string_view>

#include <fmt/format.h>

#include "assets/limits.h"
#include "base/error.h"
#include "base/file.h"

namespace sward::assets {
namespace {

namespace fs = std::filesystem;

constexpr double kDefaultNodata = -9999; // Esri's, where the header names none
constexpr std::array<std::string_view, 10> kKeys = {
    "ncols",     "nrows",    "xllcorner", "yllcorner", "xllcenter",
    "yllcenter", "cellsize", "dx",        "dy",        "nodata_value"};

std::string lower(std::string_view text) {
    std::string small(text);
    for (char& c : small)
        c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
    return small;
}

/// Words of a text, and the line that the last one stood on.
class Words {
public:
    explicit Words(std::string_view text) : rest_(text) {}
    /// Empty at the end.
    std::string_view next() {
        std::size_t i = 0;
        for (; i < rest_.size() && is_blank(rest_[i]); ++i)
            line_ += rest_[i] == '\n' ? 1 : 0;
        rest_.remove_prefix(i);
        const std::size_t end = std::find_if(rest_.begin(), rest_.end(), is_blank) - rest_.begin();
        const std::string_view word = rest_.substr(0, end);
        rest_.remove_prefix(end);
        return word;
    }
    [[nodiscard]] int line() const { return line_; }

private:
    static bool is_blank(char c) {
        return c == ' ' || c == '\t' || c == '\r' || c == '\n' || c == '\f' || c == '\v';
    }
    std::string_view rest_;
    int line_ = 1;
};

/// A whole number in the C locale's form ("nan" too), or nothing.
std::optional<double> number(std::string_view word) {
    if (word.size() > 1 && word[0] == '+' && word[1] != '-')
        word.remove_prefix(1); // printf's "%+f"
    double value = 0;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (end != word.data() + word.size() || word.empty() || error != std::errc())
        return std::nullopt;
    return value;
}

struct Header {
    double nodata = kDefaultNodata;
    bool declared = false;
    std::string_view first; ///< word of the values
};

base::Error bad(const fs::path& path, int line, std::string_view what, std::string_view found,
                std::string_view expected) {
    return base::input_error(base::ExitCode::kBadInput, path, line, what, found, expected);
}

Header read_header(const fs::path& path, Words& words) {
    Header header;
    while (true) {
        const std::string_view key = words.next();
        const std::string name = lower(key);
        const bool letter =
            !name.empty() && name[0] >= 'a' && name[0] <= 'z' && name != "nan" && name != "inf";
        if (!letter) {
            header.first = key;
            return header;
        }
        if (std::find(kKeys.begin(), kKeys.end(), name) == kKeys.end())
            throw bad(path, words.line(), "word in the header", base::printable(key),
                      "a key of an ASCII grid, or a height");
        const std::string_view text = words.next();
        const std::optional<double> value = number(text);
        const bool may_be_nan = name == "nodata_value";
        if (!value || (!may_be_nan && !std::isfinite(*value)))
            throw bad(path, words.line(), name, text.empty() ? "nothing" : base::printable(text),
                      "a number, with a dot");
        if (may_be_nan)
            header.nodata = *value, header.declared = true;
    }
}

} // namespace

bool is_ascii_grid(std::span<const std::byte> head) {
    const std::string text = lower({reinterpret_cast<const char*>(head.data()), head.size()});
    return std::any_of(kKeys.begin(), kKeys.end(),
                       [&](std::string_view key) { return text.starts_with(key); });
}

std::vector<float> read_ascii_grid(const fs::path& path, int width, int height) {
    const std::string text = base::read_text(path, kMostFileBytes);
    Words words(text);
    const Header header = read_header(path, words);
    const std::size_t count = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
    const auto nodata = static_cast<float>(header.nodata);
    std::vector<float> values;
    values.reserve(count);
    std::string_view word = header.first;
    for (; values.size() < count; word = words.next()) {
        if (word.empty())
            throw bad(path, words.line(), "heights", fmt::format("{}", values.size()),
                      fmt::format("{} for {} x {} posts", count, width, height));
        const std::optional<double> value = number(word);
        // Where another number stands for voids, NaN is a mistake of whoever wrote it.
        if (!value || (std::isnan(*value) && header.declared && !std::isnan(header.nodata)))
            throw bad(path, words.line(),
                      fmt::format("height at column {}, row {}", values.size() % width,
                                  values.size() / width),
                      base::printable(word), "a number, with a dot");
        const auto metres = static_cast<float>(*value);
        // The largest floats are written with fewer digits than they have.
        const bool is_void =
            metres == nodata ||
            (std::abs(nodata) > 1e30f && std::abs(metres - nodata) <= 1e-5f * std::abs(nodata));
        values.push_back(is_void ? std::numeric_limits<float>::quiet_NaN() : metres);
    }
    if (!word.empty())
        throw bad(path, words.line(), "heights",
                  fmt::format("more than {}: {}", count, base::printable(word)),
                  fmt::format("{} for {} x {} posts", count, width, height));
    return values;
}

} // namespace sward::assets
