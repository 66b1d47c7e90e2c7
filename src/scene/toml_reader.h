// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include <glm/glm.hpp>
#include <toml++/toml.h>

#include "base/error.h"
#include "scene/ranges.h"

namespace sward::scene {

/// How a table spells a key: as asked, or as it was once called. Metres a second ended in "_ms"
/// then, which is milliseconds; such files are still read.
[[nodiscard]] std::string spelt(const toml::table& table, std::string_view key);

/// One table of a TOML file. Asking for a key declares it, so finish() can refuse every key that
/// nobody asked for. A key that is absent leaves its target as it is. Everything throws base::Error
/// with file, line, key, found and expected.
class TableReader {
public:
    /// `name` is the table's dotted name in messages, empty for the whole file.
    TableReader(const toml::table& table, std::filesystem::path file, std::string name);

    bool number(const char* key, double& value, const Range& range);
    bool number(const char* key, std::optional<double>& value, const Range& range);
    bool integer(const char* key, int& value, int low, int high);
    bool integer(const char* key, std::int64_t& value, const Range& range);
    bool span(const char* key, Span& value, const Range& range); ///< [low, high], rising or equal
    bool boolean(const char* key, bool& value);
    bool text(const char* key, std::string& value);
    /// A short name: letters, digits, '_' and '-'.
    bool name(const char* key, std::string& value);
    /// The same, or an empty text for none.
    bool name_or_none(const char* key, std::string& value);
    /// One of an enum's words, which stand in its order.
    template<class Enum, std::size_t n>
    bool word(const char* key, Enum& value, const std::array<const char*, n>& words) {
        const std::optional<std::size_t> found = number_of_word(key, words);
        if (found)
            value = static_cast<Enum>(*found);
        return found.has_value();
    }
    /// A file name, resolved against the scene's directory.
    bool path(const char* key, std::filesystem::path& value);
    bool numbers(const char* key, std::vector<double>& values, const std::vector<Range>& ranges);
    /// Three of a kind: anything that is made of three doubles.
    template<class Three> bool three(const char* key, Three& values, const Range& range) {
        std::vector<double> n;
        if (!numbers(key, n, {range, range, range}))
            return false;
        values = {n[0], n[1], n[2]};
        return true;
    }
    bool place(const char* key, glm::dvec2& value); ///< [x, z]
    bool place(const char* key, glm::dvec3& value); ///< [x, y, z]

    /// The table under `key`, or nothing.
    std::optional<TableReader> table(const char* key);
    /// The tables of [[key]]; more than `limit` is over a limit.
    std::vector<TableReader> tables(const char* key, std::size_t limit);
    /// Every entry of this table as a table of its own, by name: [camera.NAME].
    std::vector<std::pair<std::string, TableReader>> named_tables(std::size_t limit);
    /// Every entry as integer = number, or as integer = table: [terrain.classes].
    using NumberOrTable = std::variant<double, TableReader>;
    std::vector<std::pair<int, NumberOrTable>> integer_keys(int high, const Range& range);

    /// A key that is read elsewhere.
    void knows(const char* key) { known_.emplace_back(key); }
    /// Refuses the keys that were never asked for. `elsewhere`: full names of keys of other tables,
    /// one of which may have been meant.
    void finish(std::span<const std::string> elsewhere = {}) const;
    /// Refuses the absence of `key`.
    void require(const char* key) const;

    /// With the names of the tables around it.
    [[nodiscard]] std::string full_name(std::string_view key) const;
    [[nodiscard]] bool has(const char* key) const { return table_->contains(spelt(*table_, key)); }
    /// Whether the table under `table` has `key`.
    [[nodiscard]] bool holds(const char* table, const char* key) const;
    [[nodiscard]] base::Error error(const char* key, std::string_view found,
                                    std::string_view expected) const;
    [[nodiscard]] base::Error over_limit(const char* key, std::size_t found,
                                         std::size_t limit) const;

private:
    const toml::node* find(const char* key);
    std::optional<std::size_t> number_of_word(const char* key, std::span<const char* const> words);
    [[nodiscard]] std::string meant_by(std::string_view key,
                                       std::span<const std::string> elsewhere) const;
    [[nodiscard]] int line_of(std::string_view key) const;
    [[nodiscard]] base::Error wrong(std::string_view name, const toml::node& node,
                                    std::string_view expected) const;
    [[nodiscard]] double checked(std::string_view name, const toml::node& node,
                                 const Range& range) const;
    [[nodiscard]] const toml::table& as_table(std::string_view name, const toml::node& node) const;

    const toml::table* table_;
    std::filesystem::path file_;
    std::string name_;
    std::vector<std::string> known_;
};

/// A node as messages show it: scalars by value, the rest by kind.
[[nodiscard]] std::string described(const toml::node& node);
/// "a whole number from 1 to 4", for messages.
[[nodiscard]] std::string whole_number(const Range& range);

/// A whole file's text. Throws Error: kBadInput with the line where it is no TOML, kOverLimit for
/// keys that nest too deep.
[[nodiscard]] toml::table parse_toml(const std::string& text, const std::filesystem::path& file);

/// What a name of a camera, path or arrow may be: it stands on command lines, where a comma means a
/// pose.
[[nodiscard]] bool is_name(std::string_view text);

} // namespace sward::scene
