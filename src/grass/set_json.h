// SPDX-License-Identifier: Apache-2.0
// set.json and the files that it names, every access checked. For the set's readers in this folder.
#pragma once

#include <cmath>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "grass/grass_set.h"

namespace sward::grass {

/// set.json with every access checked.
class SetJson {
public:
    /// Throws base::Error as every access does.
    explicit SetJson(const std::filesystem::path& path);

    [[noreturn]] void refuse(std::string_view what, const std::string& found,
                             const std::string& expected) const {
        throw base::input_error(base::ExitCode::kBadInput, path_, 0, what, found, expected);
    }
    [[noreturn]] void over(std::string_view what, const std::string& found,
                           const std::string& expected) const {
        throw base::input_error(base::ExitCode::kOverLimit, path_, 0, what, found, expected);
    }
    const nlohmann::json& root() const { return root_; }

    const nlohmann::json& at(const nlohmann::json& object, const char* key) const {
        if (!object.is_object() || !object.contains(key))
            refuse(key, "none", "a value");
        return object[key];
    }
    double number(const nlohmann::json& object, const char* key, double low, double high) const {
        return in_range(at(object, key), key, low, high);
    }
    double in_range(const nlohmann::json& value, const char* key, double low, double high) const {
        const double v = value.is_number() ? value.get<double>() : std::nan("");
        if (!(v >= low && v <= high))
            refuse(key, base::printable(value.dump()),
                   fmt::format("a number from {} to {}", low, high));
        return v;
    }
    float real(const nlohmann::json& object, const char* key, double low, double high) const {
        return static_cast<float>(number(object, key, low, high));
    }
    int whole(const nlohmann::json& object, const char* key, int low, int high) const {
        const double v = number(object, key, low, high);
        if (v != std::floor(v))
            refuse(key, std::to_string(v), "a whole number");
        return static_cast<int>(v);
    }
    std::string text(const nlohmann::json& object, const char* key) const {
        const nlohmann::json& value = at(object, key);
        if (!value.is_string() || value.get_ref<const std::string&>().size() > 128)
            refuse(key, base::printable(value.dump()), "a short text");
        return value.get<std::string>();
    }
    const nlohmann::json& array(const nlohmann::json& object, const char* key, std::size_t low,
                                std::size_t high) const {
        const nlohmann::json& value = at(object, key);
        if (!value.is_array() || value.size() < low || value.size() > high)
            refuse(key, value.is_array() ? fmt::format("{} entries", value.size()) : "no list",
                   fmt::format("{} to {} entries", low, high));
        return value;
    }
    shared::vec4 colour(const nlohmann::json& object, const char* key, float a) const {
        const nlohmann::json& list = array(object, key, 3, 3);
        shared::vec4 c(0, 0, 0, a);
        for (int i = 0; i < 3; ++i) {
            const nlohmann::json& part = list[static_cast<std::size_t>(i)];
            const double v = part.is_number() ? part.get<double>() : std::nan("");
            if (!(v >= 0 && v <= 1))
                refuse(key, base::printable(part.dump()), "linear reflectance from 0 to 1");
            c[i] = static_cast<float>(v);
        }
        return c;
    }

private:
    void check_depth(const std::string& text) const;

    std::filesystem::path path_;
    nlohmann::json root_;
};

/// A file of the set, whole and as its writer left it, or an error.
[[nodiscard]] std::vector<std::byte>
verified_file(const SetJson& set, const std::filesystem::path& directory, const std::string& name);

/// One of its textures, of so many images in this format, or an error.
[[nodiscard]] TextureArray read_array(const SetJson& set, const std::filesystem::path& directory,
                                      const std::string& name, int images,
                                      TexelFormat format = TexelFormat::kRgba8);

/// What the far field's march reads; the set's head has been read.
void read_march(const SetJson& set, const std::filesystem::path& directory, GrassSet& out);

} // namespace sward::grass
