// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include <glm/glm.hpp>

namespace sward::gl {

/// A linked program made of files below the shader directory; the stage comes from the extension
/// (.vert .tesc .tese .frag .comp). Throws Error(kNoGpu) with file:line of the real source.
class Program {
public:
    Program() = default;
    Program(std::string name, std::vector<std::filesystem::path> stages,
            std::vector<std::string> defines = {});
    ~Program();
    Program(Program&& other) noexcept;
    Program& operator=(Program&& other) noexcept;

    void use() const;
    /// Builds again from disk; on failure the old program stays and the Error is thrown.
    void reload();
    /// A uniform that the compiler left out of this variant is passed over; one that no source of
    /// the program declares throws Error(kNoGpu) with the program's and the uniform's name.
    void set(const char* uniform, int value) const;
    void set(const char* uniform, float value) const;
    void set(const char* uniform, const glm::vec4& value) const;
    void set(const char* uniform, const glm::ivec4& value) const;
    [[nodiscard]] std::uint32_t id() const { return id_; }
    [[nodiscard]] const std::string& name() const { return name_; }

private:
    [[nodiscard]] int location(const char* uniform) const;
    std::string name_;
    std::vector<std::filesystem::path> stages_;
    std::vector<std::string> defines_;
    std::uint32_t id_ = 0;
    std::vector<std::pair<std::string, int>>
        locations_; ///< of the uniforms that it has: looked up once, for drivers search for names
                    ///< slowly
    std::vector<std::string>
        declared_; ///< words of its sources' uniform declarations, in every variant
};

} // namespace sward::gl
