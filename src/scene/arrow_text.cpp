// SPDX-License-Identifier: Apache-2.0
#include "scene/arrow_text.h"

#include <algorithm>
#include <map>
#include <optional>

#include <fmt/format.h>

#include "base/error.h"
#include "base/file.h"
#include "scene/scene.h"
#include "scene/toml_reader.h"

namespace sward::scene {
namespace {

constexpr std::uint64_t kLimit = std::uint64_t{1} << 20;

/// A piece of the text that is replaced.
struct Change {
    std::size_t begin, end;
    std::string text;
};

std::string shown(double value) {
    return fmt::format("{}", value);
}
std::string shown(glm::dvec2 value) {
    return fmt::format("[{}, {}]", value.x, value.y);
}
std::string shown(const std::string& value) {
    return fmt::format("\"{}\"", value); // names hold nothing that needs an escape
}

/// The keys of an arrow with their values as text; times only where they say something.
std::vector<std::pair<std::string, std::string>> keys_of(const WindArrow& arrow) {
    std::vector<std::pair<std::string, std::string>> keys = {{"id", shown(arrow.id)}};
    if (!arrow.parent.empty())
        keys.emplace_back("parent", shown(arrow.parent));
    keys.emplace_back("root", shown(arrow.root));
    keys.emplace_back("tip", shown(arrow.tip));
    keys.emplace_back("strength_mps", shown(arrow.strength_mps));
    keys.emplace_back("radius_m", shown(arrow.radius_m));
    if (arrow.start_s != 0)
        keys.emplace_back("start_s", shown(arrow.start_s));
    if (arrow.end_s != kForever)
        keys.emplace_back("end_s", shown(arrow.end_s));
    return keys;
}

class ArrowText {
public:
    ArrowText(const std::string& text, const std::filesystem::path& file)
        : text_(text), file_(file) {
        line_begin_.push_back(0);
        for (std::size_t i = 0; i < text.size(); ++i)
            if (text[i] == '\n')
                line_begin_.push_back(i + 1);
        newline_ = text.find("\r\n") == std::string::npos ? "\n" : "\r\n";
        document_ = parse_toml(text, file);
    }

    std::string with(const std::vector<WindArrow>& arrows) {
        std::map<std::string, const WindArrow*> wanted;
        for (const WindArrow& arrow : arrows)
            wanted.emplace(arrow.id, &arrow);
        std::size_t last_end = 0; // of the last block
        for (const toml::table* table : blocks()) {
            last_end = std::max(last_end, block_end(*table));
            const auto id = (*table)["id"].value<std::string>();
            const auto found = id ? wanted.find(*id) : wanted.end();
            if (found == wanted.end()) {
                cut(*table);
                continue;
            }
            update(*table, *found->second);
            wanted.erase(found);
        }
        std::string fresh;
        for (const WindArrow& arrow : arrows)
            if (wanted.contains(arrow.id))
                fresh += block_of(arrow);
        if (!fresh.empty())
            insert(last_end > 0 ? last_end : text_.size(), fresh);
        return apply();
    }

private:
    /// The tables of [[wind.arrow]], in the order of the file.
    std::vector<const toml::table*> blocks() const {
        std::vector<const toml::table*> all;
        const toml::array* array = document_["wind"]["arrow"].as_array();
        if (!array)
            return all;
        for (const toml::node& node : *array) {
            const toml::table* table = node.as_table();
            if (!table || table->is_inline())
                throw base::input_error(base::ExitCode::kBadInput, file_,
                                        static_cast<int>(node.source().begin.line), "wind.arrow",
                                        "an array in one line",
                                        "[[wind.arrow]] blocks, which can be saved");
            all.push_back(table);
        }
        return all;
    }

    /// Offset of a place in the text. Columns count characters, of which arrows' lines hold only
    /// ASCII before their values.
    std::size_t offset(const toml::source_position& at) const {
        return line_begin_.at(at.line - 1) + at.column - 1;
    }
    std::size_t line_end(std::size_t line) const {
        return line < line_begin_.size() ? line_begin_[line] : text_.size();
    }

    /// Behind the last line (from 1) that belongs to the block: the comments before the next block
    /// are the next one's.
    std::size_t block_end(const toml::table& table) const {
        std::size_t last = table.source().begin.line;
        for (const auto& [key, node] : table)
            last = std::max<std::size_t>(last, node.source().end.line);
        return line_end(last);
    }

    void cut(const toml::table& table) {
        const std::size_t begin = line_begin_.at(table.source().begin.line - 1);
        std::size_t end = block_end(table);
        // The blank line behind it, so that cutting leaves one gap and not two.
        const std::size_t next = text_.find('\n', end);
        if (next != std::string::npos && text_.find_first_not_of(" \t\r", end) == next)
            end = next + 1;
        changes_.push_back({begin, end, ""});
    }

    void update(const toml::table& table, const WindArrow& arrow) {
        std::string added;
        for (const auto& [key, value] : keys_of(arrow)) {
            const toml::node* node =
                table.get(spelt(table, key)); // an older file keeps its spelling
            if (!node) {
                if (key != "radius_m" || arrow.radius_m != WindArrow{}.radius_m)
                    added += key + " = " + value + newline_;
            } else if (!same(*node, key, arrow)) {
                changes_.push_back(
                    {offset(node->source().begin), offset(node->source().end), value});
            }
        }
        if (const toml::node* node = table.get("parent"); node && arrow.parent.empty())
            changes_.push_back({offset(node->source().begin), offset(node->source().end), "\"\""});
        if (!added.empty())
            insert(block_end(table), added);
    }

    /// Whether the file's own spelling of a value says what the arrow says: 5.0 stays 5.0.
    static bool same(const toml::node& node, const std::string& key, const WindArrow& arrow) {
        const auto pair = [&](glm::dvec2 value) {
            const toml::array* array = node.as_array();
            return array && array->size() == 2 && array->get(0)->value<double>() == value.x &&
                   array->get(1)->value<double>() == value.y;
        };
        if (key == "id")
            return true;
        if (key == "parent")
            return node.value<std::string>() == arrow.parent;
        if (key == "root" || key == "tip")
            return pair(key == "root" ? arrow.root : arrow.tip);
        const double value = key == "strength_mps" ? arrow.strength_mps
                             : key == "radius_m"   ? arrow.radius_m
                             : key == "start_s"    ? arrow.start_s
                                                   : arrow.end_s;
        return node.value<double>() == value;
    }

    std::string block_of(const WindArrow& arrow) const {
        std::string block = newline_ + "[[wind.arrow]]" + newline_;
        for (const auto& [key, value] : keys_of(arrow))
            block += key + " = " + value + newline_;
        return block;
    }

    void insert(std::size_t at, std::string added) {
        if (at > 0 && text_[at - 1] != '\n') // the file ends without one
            added = newline_ + added;
        changes_.push_back({at, at, std::move(added)});
    }

    std::string apply() {
        std::stable_sort(changes_.begin(), changes_.end(),
                         [](const Change& a, const Change& b) { return a.begin < b.begin; });
        std::string out;
        std::size_t at = 0;
        for (const Change& change : changes_) {
            out.append(text_, at, std::max(change.begin, at) - at);
            out += change.text;
            at = std::max(at, change.end);
        }
        return out.append(text_, at, std::string::npos);
    }

    const std::string& text_;
    const std::filesystem::path& file_;
    toml::table document_;
    std::vector<std::size_t> line_begin_;
    std::string newline_;
    std::vector<Change> changes_;
};

} // namespace

std::string with_arrows(const std::string& text, const std::vector<WindArrow>& arrows,
                        const std::filesystem::path& file) {
    return ArrowText(text, file).with(arrows);
}

void save_arrows(const std::filesystem::path& file, const std::vector<WindArrow>& arrows) {
    const std::string text = with_arrows(base::read_text(file, kLimit), arrows, file);
    // Read back before the old file goes: a text that says something else never gets there.
    const std::vector<WindArrow> written = parse_scene(text, file).wind.arrows;
    const bool equal =
        written.size() == arrows.size() && std::ranges::all_of(arrows, [&](const WindArrow& arrow) {
            return std::find(written.begin(), written.end(), arrow) != written.end();
        });
    if (!equal)
        throw base::input_error(base::ExitCode::kBadInput, file, 0, "arrows",
                                "others when the new text was read back",
                                "[[wind.arrow]] blocks that can be replaced");
    base::write_file_atomic(file, text);
}

} // namespace sward::scene
