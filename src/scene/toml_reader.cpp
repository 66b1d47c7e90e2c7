// SPDX-License-Identifier: Apache-2.0
#include "scene/toml_reader.h"

#include <algorithm>
#include <charconv>
#include <cmath>

#include <fmt/format.h>

namespace sward::scene {
namespace {

constexpr std::size_t kLongestText = 4096; // PATH_MAX
constexpr std::size_t kLongestName = 64;
constexpr const char* kNameRule = "1 to 64 letters, digits, '_' or '-'";

std::string in_quotes(std::string_view text) {
    return fmt::format("\"{}\"", base::printable(text));
}

std::string number_in(const char* kind, const Range& range) {
    return fmt::format("{} from {} to {}{}{}", kind, range.low, range.high, *range.unit ? " " : "",
                       range.unit);
}

} // namespace

std::string described(const toml::node& node) {
    if (const auto* value = node.as_integer())
        return fmt::format("{}", value->get());
    if (const auto* value = node.as_floating_point())
        return fmt::format("{}", value->get());
    if (const auto* value = node.as_boolean())
        return value->get() ? "true" : "false";
    if (const auto* value = node.as_string())
        return in_quotes(value->get());
    if (const auto* value = node.as_array())
        return fmt::format("an array of {}", value->size());
    return node.is_table() ? "a table" : "a date or time";
}

std::string whole_number(const Range& range) {
    return number_in("a whole number", range);
}

std::string spelt(const toml::table& table, std::string_view key) {
    constexpr std::string_view kNow = "_mps", kOnce = "_ms";
    if (table.contains(key) || !key.ends_with(kNow))
        return std::string(key);
    const std::string once = std::string(key.substr(0, key.size() - kNow.size())).append(kOnce);
    return table.contains(once) ? once : std::string(key);
}

bool is_name(std::string_view text) {
    const auto fits = [](char c) {
        return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
               c == '_' || c == '-';
    };
    return !text.empty() && text.size() <= kLongestName &&
           std::all_of(text.begin(), text.end(), fits);
}

TableReader::TableReader(const toml::table& table, std::filesystem::path file, std::string name)
    : table_(&table), file_(std::move(file)), name_(std::move(name)) {}

const toml::node* TableReader::find(const char* key) {
    known_.emplace_back(key);
    const std::string in_file = spelt(*table_, key);
    if (in_file != key)
        known_.push_back(in_file);
    return table_->get(in_file);
}

std::string TableReader::full_name(std::string_view key) const {
    const std::string shown = base::printable(key);
    return name_.empty() ? shown : key.empty() ? name_ : fmt::format("{}.{}", name_, shown);
}

int TableReader::line_of(std::string_view key) const {
    const toml::node* node = table_->get(spelt(*table_, key));
    const toml::source_region& region = node ? node->source() : table_->source();
    return static_cast<int>(region.begin.line);
}

base::Error TableReader::error(const char* key, std::string_view found,
                               std::string_view expected) const {
    return base::input_error(base::ExitCode::kBadInput, file_, line_of(key), full_name(key), found,
                             expected);
}

base::Error TableReader::over_limit(const char* key, std::size_t found, std::size_t limit) const {
    return base::input_error(base::ExitCode::kOverLimit, file_, line_of(key), full_name(key),
                             fmt::format("{} entries", found), fmt::format("at most {}", limit));
}

base::Error TableReader::wrong(std::string_view name, const toml::node& node,
                               std::string_view expected) const {
    return base::input_error(base::ExitCode::kBadInput, file_,
                             static_cast<int>(node.source().begin.line), name, described(node),
                             expected);
}

double TableReader::checked(std::string_view name, const toml::node& node,
                            const Range& range) const {
    const auto* whole = node.as_integer();
    const auto* real = node.as_floating_point();
    const double value = whole ? static_cast<double>(whole->get()) : real ? real->get() : NAN;
    if (!(value >= range.low && value <= range.high)) // NaN fails too
        throw wrong(name, node, number_in("a number", range));
    return value;
}

const toml::table& TableReader::as_table(std::string_view name, const toml::node& node) const {
    if (!node.is_table())
        throw wrong(name, node, "a table");
    return *node.as_table();
}

bool TableReader::number(const char* key, double& value, const Range& range) {
    const toml::node* node = find(key);
    if (node)
        value = checked(full_name(key), *node, range);
    return node != nullptr;
}

bool TableReader::number(const char* key, std::optional<double>& value, const Range& range) {
    double given = 0;
    if (!number(key, given, range))
        return false;
    value = given;
    return true;
}

bool TableReader::integer(const char* key, int& value, int low, int high) {
    const toml::node* node = find(key);
    if (!node)
        return false;
    const auto* whole = node->as_integer();
    if (!whole || whole->get() < low || whole->get() > high)
        throw wrong(full_name(key), *node, fmt::format("a whole number from {} to {}", low, high));
    value = static_cast<int>(whole->get());
    return true;
}

bool TableReader::integer(const char* key, std::int64_t& value, const Range& range) {
    const toml::node* node = find(key);
    if (!node)
        return false;
    const auto* whole = node->as_integer();
    if (!whole || !(static_cast<double>(whole->get()) >= range.low &&
                    static_cast<double>(whole->get()) <= range.high))
        throw wrong(full_name(key), *node, whole_number(range));
    value = whole->get();
    return true;
}

bool TableReader::span(const char* key, Span& value, const Range& range) {
    const toml::node* node = find(key);
    if (!node)
        return false;
    const toml::array* array = node->as_array();
    if (!array || array->size() != 2)
        throw wrong(full_name(key), *node, number_in("[low, high], two rising numbers", range));
    const Span given{checked(full_name(key) + "[0]", (*array)[0], range),
                     checked(full_name(key) + "[1]", (*array)[1], range)};
    if (given.low > given.high)
        throw error(key, fmt::format("[{}, {}]", given.low, given.high),
                    "two rising numbers, the lesser first");
    value = given;
    return true;
}

std::optional<std::size_t> TableReader::number_of_word(const char* key,
                                                       std::span<const char* const> words) {
    std::string found;
    if (!name(key, found))
        return std::nullopt;
    const auto at = std::find(words.begin(), words.end(), found);
    if (at == words.end())
        throw error(key, in_quotes(found), fmt::format("one of {}", fmt::join(words, ", ")));
    return static_cast<std::size_t>(at - words.begin());
}

bool TableReader::boolean(const char* key, bool& value) {
    const toml::node* node = find(key);
    if (!node)
        return false;
    if (!node->is_boolean())
        throw wrong(full_name(key), *node, "true or false");
    value = node->as_boolean()->get();
    return true;
}

bool TableReader::text(const char* key, std::string& value) {
    const toml::node* node = find(key);
    if (!node)
        return false;
    const auto* string = node->as_string();
    if (!string || string->get().empty() || string->get().size() > kLongestText ||
        string->get().find('\0') != std::string::npos)
        throw wrong(full_name(key), *node, fmt::format("a text of 1 to {} bytes", kLongestText));
    value = string->get();
    return true;
}

bool TableReader::name(const char* key, std::string& value) {
    const toml::node* node = find(key);
    if (!node)
        return false;
    if (!node->is_string() || !is_name(node->as_string()->get()))
        throw wrong(full_name(key), *node, kNameRule);
    value = node->as_string()->get();
    return true;
}

bool TableReader::name_or_none(const char* key, std::string& value) {
    const toml::node* node = find(key);
    if (!node)
        return false;
    if (!node->is_string() ||
        !(node->as_string()->get().empty() || is_name(node->as_string()->get())))
        throw wrong(full_name(key), *node, kNameRule);
    value = node->as_string()->get();
    return true;
}

bool TableReader::path(const char* key, std::filesystem::path& value) {
    std::string given;
    if (!text(key, given))
        return false;
    value = file_.parent_path() / given;
    return true;
}

bool TableReader::numbers(const char* key, std::vector<double>& values,
                          const std::vector<Range>& ranges) {
    const toml::node* node = find(key);
    if (!node)
        return false;
    const toml::array* array = node->as_array();
    if (!array || array->size() != ranges.size())
        throw wrong(full_name(key), *node, fmt::format("an array of {} numbers", ranges.size()));
    values.clear();
    for (std::size_t i = 0; i < ranges.size(); ++i)
        values.push_back(checked(fmt::format("{}[{}]", full_name(key), i), (*array)[i], ranges[i]));
    return true;
}

bool TableReader::place(const char* key, glm::dvec2& value) {
    std::vector<double> given;
    if (!numbers(key, given, {kPlace, kPlace}))
        return false;
    value = {given[0], given[1]};
    return true;
}

bool TableReader::place(const char* key, glm::dvec3& value) {
    std::vector<double> given;
    if (!numbers(key, given, {kPlace, kHeight, kPlace}))
        return false;
    value = {given[0], given[1], given[2]};
    return true;
}

bool TableReader::holds(const char* table, const char* key) const {
    const toml::node* node = table_->get(table);
    return node && node->is_table() && node->as_table()->contains(key);
}

std::optional<TableReader> TableReader::table(const char* key) {
    const toml::node* node = find(key);
    if (!node)
        return std::nullopt;
    return TableReader(as_table(full_name(key), *node), file_, full_name(key));
}

std::vector<TableReader> TableReader::tables(const char* key, std::size_t limit) {
    const toml::node* node = find(key);
    std::vector<TableReader> all;
    if (!node)
        return all;
    if (!node->is_array())
        throw wrong(full_name(key), *node, "an array of tables");
    const toml::array& array = *node->as_array();
    if (array.size() > limit)
        throw over_limit(key, array.size(), limit);
    for (std::size_t i = 0; i < array.size(); ++i) {
        const std::string element = fmt::format("{}[{}]", full_name(key), i);
        all.emplace_back(as_table(element, array[i]), file_, element);
    }
    return all;
}

std::vector<std::pair<std::string, TableReader>> TableReader::named_tables(std::size_t limit) {
    if (table_->size() > limit)
        throw over_limit("", table_->size(), limit);
    std::vector<std::pair<std::string, TableReader>> all;
    for (const auto& [key, node] : *table_) {
        const std::string entry(key.str());
        if (!is_name(entry))
            throw base::input_error(base::ExitCode::kBadInput, file_, line_of(entry),
                                    name_ + ": name", in_quotes(entry), kNameRule);
        known_.push_back(entry);
        all.emplace_back(entry,
                         TableReader(as_table(full_name(entry), node), file_, full_name(entry)));
    }
    return all;
}

std::vector<std::pair<int, TableReader::NumberOrTable>>
TableReader::integer_keys(int high, const Range& range) {
    std::vector<std::pair<int, NumberOrTable>> all;
    for (const auto& [key, node] : *table_) {
        const std::string entry(key.str());
        const char* const end = entry.data() + entry.size();
        int value = -1;
        const auto result = std::from_chars(entry.data(), end, value);
        if (result.ec != std::errc() || result.ptr != end || value < 0 || value > high)
            throw base::input_error(base::ExitCode::kBadInput, file_, line_of(entry),
                                    name_ + ": key", in_quotes(entry),
                                    fmt::format("a whole number from 0 to {}", high));
        known_.push_back(entry);
        if (node.is_table())
            all.emplace_back(value, TableReader(*node.as_table(), file_, full_name(entry)));
        else
            all.emplace_back(value, checked(full_name(entry), node, range));
    }
    return all;
}

std::string TableReader::meant_by(std::string_view key,
                                  std::span<const std::string> elsewhere) const {
    const std::string last = fmt::format(".{}", key);
    const auto there = std::find_if(elsewhere.begin(), elsewhere.end(),
                                    [&](const std::string& full) { return full.ends_with(last); });
    if (!key.empty() && there != elsewhere.end())
        return *there;
    const std::string nearest = base::nearest_name(key, known_);
    return nearest.empty() ? fmt::format("one of {}", fmt::join(known_, ", ")) : full_name(nearest);
}

void TableReader::finish(std::span<const std::string> elsewhere) const {
    for (const auto& [key, node] : *table_) {
        const std::string_view entry = key.str();
        if (std::find(known_.begin(), known_.end(), entry) != known_.end())
            continue;
        throw base::input_error(
            base::ExitCode::kBadInput, file_, static_cast<int>(key.source().begin.line),
            "unknown key", full_name(entry.empty() ? "\"\"" : entry), meant_by(entry, elsewhere));
    }
}

void TableReader::require(const char* key) const {
    if (!has(key))
        throw base::input_error(base::ExitCode::kBadInput, file_,
                                static_cast<int>(table_->source().begin.line), full_name(key),
                                "nothing", "this key");
}

} // namespace sward::scene
