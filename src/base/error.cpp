// SPDX-License-Identifier: Apache-2.0
#include "base/error.h"

#include <algorithm>
#include <cstdint>
#include <numeric>
#include <vector>

#include <fmt/format.h>

namespace sward::base {
namespace {

constexpr std::size_t kPathLimit = 1024; // a path is worth more room than a value
constexpr std::size_t kFoundLimit = 160;

struct CodePoint {
    std::uint32_t value = 0;
    std::size_t bytes = 0; ///< 0: not valid UTF-8 here
};

/// Strict UTF-8 (RFC 3629): no overlong forms, no surrogates, nothing past U+10FFFF.
CodePoint decode(std::string_view text) {
    const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
    const unsigned lead = byte(0);
    std::size_t bytes = lead < 0x80   ? 1
                        : lead < 0xC2 ? 0
                        : lead < 0xE0 ? 2
                        : lead < 0xF0 ? 3
                        : lead < 0xF5 ? 4
                                      : 0;
    if (bytes == 0 || text.size() < bytes)
        return {};
    std::uint32_t value = bytes == 1 ? lead : lead & (0x7Fu >> bytes);
    for (std::size_t i = 1; i < bytes; ++i) {
        if ((byte(i) & 0xC0u) != 0x80u)
            return {};
        value = (value << 6) | (byte(i) & 0x3Fu);
    }
    constexpr std::uint32_t kSmallest[5] = {0, 0, 0x80, 0x800, 0x10000};
    if (value < kSmallest[bytes] || value > 0x10FFFF || (value >= 0xD800 && value < 0xE000))
        return {};
    return {value, bytes};
}

/// Optimal string alignment distance (Damerau 1964, without edits inside a swapped pair).
std::size_t edit_distance(std::string_view a, std::string_view b) {
    std::vector<std::size_t> before(b.size() + 1), row(b.size() + 1), last(b.size() + 1);
    std::iota(last.begin(), last.end(), std::size_t{0});
    for (std::size_t i = 1; i <= a.size(); ++i) {
        row[0] = i;
        for (std::size_t j = 1; j <= b.size(); ++j) {
            const std::size_t replace = last[j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1);
            row[j] = std::min({last[j] + 1, row[j - 1] + 1, replace});
            if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
                row[j] = std::min(row[j], before[j - 2] + 1);
        }
        before.swap(last);
        last.swap(row);
    }
    return last[b.size()];
}

/// Would move the cursor, end the line or reorder the text around it.
bool is_unsafe(std::uint32_t c) {
    return c < 0x20 || (c >= 0x7F && c < 0xA0) || (c >= 0x200B && c <= 0x200F) ||
           (c >= 0x2028 && c <= 0x202E) || (c >= 0x2060 && c <= 0x206F) || c == 0xFEFF;
}

} // namespace

std::string printable(std::string_view text, std::size_t limit) {
    constexpr std::string_view kMore = "...";
    std::string out;
    std::size_t fits = 0; // length of `out` up to which the ellipsis still fits
    for (std::size_t i = 0; i < text.size();) {
        const CodePoint c = decode(text.substr(i));
        std::string piece;
        if (c.bytes == 0)
            piece = fmt::format("\\x{:02x}", static_cast<unsigned char>(text[i]));
        else if (c.value == '\n')
            piece = "\\n";
        else if (c.value == '\t')
            piece = "\\t";
        else if (c.value == '\r')
            piece = "\\r";
        else if (is_unsafe(c.value))
            piece = c.value < 0x80 ? fmt::format("\\x{:02x}", c.value)
                                   : fmt::format("\\u{{{:x}}}", c.value);
        else
            piece = text.substr(i, c.bytes);
        if (out.size() + piece.size() > limit) {
            out.resize(fits);
            if (fits + kMore.size() <= limit)
                out += kMore;
            return out;
        }
        out += piece;
        if (out.size() + kMore.size() <= limit)
            fits = out.size();
        i += c.bytes == 0 ? 1 : c.bytes;
    }
    return out;
}

Error input_error(ExitCode code, const std::filesystem::path& file, int line, std::string_view what,
                  std::string_view found, std::string_view expected) {
    std::string message = printable(file.native(), kPathLimit);
    if (line > 0)
        message += fmt::format(":{}", line);
    message += fmt::format(": {}", what);
    if (!found.empty())
        message += fmt::format(": found {}", printable(found, kFoundLimit));
    if (!expected.empty())
        message += fmt::format("{} expected {}", found.empty() ? ":" : ",", expected);
    return {code, message};
}

std::string nearest_name(std::string_view name, std::span<const std::string> known) {
    constexpr std::size_t kLongest =
        64; // a longer name is no slip of the finger; the distance is quadratic
    constexpr std::size_t kPart = 3;
    std::string best;
    std::size_t least = std::max<std::size_t>(2, name.size() / 2) + 1;
    if (name.size() > kLongest)
        return best;
    for (const std::string& candidate : known) {
        std::size_t distance = edit_distance(name, candidate);
        if (name.size() >= kPart && candidate.starts_with(name))
            distance =
                std::min(distance, std::size_t{1}); // "fov" for "fov_deg": the unit was left out
        if (distance < least)
            least = distance, best = candidate;
    }
    return best;
}

} // namespace sward::base
