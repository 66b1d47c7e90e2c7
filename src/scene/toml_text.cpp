// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "scene/toml_reader.h"

namespace sward::scene {
namespace {

constexpr int kMostDots = 32;

bool is_digit(char c) {
    return c >= '0' && c <= '9';
}

/// Whether the dot at `at` may be a number's: digits on both sides, and no second dot before them.
bool in_number(std::string_view line, std::size_t at) {
    std::size_t first = at;
    while (first > 0 && is_digit(line[first - 1]))
        --first;
    return first < at && at + 1 < line.size() && is_digit(line[at + 1]) &&
           (first == 0 || line[first - 1] != '.');
}

/// The parser nests one table for each dot of a key, with no limit, and its destructor would
/// overflow the stack. A key stands on one line, so counting dots line by line bounds the depth
/// whatever quotes and brackets stand around them.
void refuse_deep_keys(std::string_view text, const std::filesystem::path& file) {
    int number = 0;
    while (!text.empty()) {
        ++number;
        const std::string_view line = text.substr(0, text.find('\n'));
        text.remove_prefix(std::min(text.size(), line.size() + 1));
        const std::size_t start = line.find_first_not_of(" \t");
        if (start == std::string_view::npos || line[start] == '#')
            continue;
        int dots = 0;
        for (std::size_t i = 0; i < line.size(); ++i)
            dots += line[i] == '.' && !in_number(line, i) ? 1 : 0;
        if (dots > kMostDots)
            throw base::input_error(base::ExitCode::kOverLimit, file, number, "dots in one line",
                                    std::to_string(dots), "at most " + std::to_string(kMostDots));
    }
}

} // namespace

toml::table parse_toml(const std::string& text, const std::filesystem::path& file) {
    refuse_deep_keys(text, file);
    try {
        return toml::parse(text);
    } catch (const toml::parse_error& error) {
        throw base::input_error(base::ExitCode::kBadInput, file,
                                static_cast<int>(error.source().begin.line), "not valid TOML",
                                error.description(), "TOML 1.0");
    }
}

} // namespace sward::scene
