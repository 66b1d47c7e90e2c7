// SPDX-License-Identifier: Apache-2.0
#include "gl/program.h"

#include <algorithm>
#include <cctype>
#include <string_view>
#include <utility>

#include <epoxy/gl.h>
#include <fmt/format.h>

#include "base/error.h"
#include "gl/breath.h"
#include "gl/shader_source.h"

namespace sward::gl {

using base::Error;
using base::ExitCode;

namespace {

GLenum stage_of(const std::filesystem::path& path) {
    const std::string extension = path.extension().string();
    if (extension == ".vert")
        return GL_VERTEX_SHADER;
    if (extension == ".tesc")
        return GL_TESS_CONTROL_SHADER;
    if (extension == ".tese")
        return GL_TESS_EVALUATION_SHADER;
    if (extension == ".frag")
        return GL_FRAGMENT_SHADER;
    if (extension == ".comp")
        return GL_COMPUTE_SHADER;
    throw Error(ExitCode::kNoGpu, path.string() + ": shader: no stage has this extension");
}

/// A driver's log as one line: errors are one line by rule.
std::string one_line(std::string log) {
    while (!log.empty() && (log.back() == '\n' || log.back() == '\0')) {
        log.pop_back();
    }
    for (std::size_t at; (at = log.find('\n')) != std::string::npos;) {
        log.replace(at, 1, "; ");
    }
    return log;
}

/// Words of each declaration that begins with `uniform` and holds no block, in code that is left
/// out by the preprocessor too: a program's variants differ by it, and what sets their uniforms
/// does not ask which variant it has.
void add_uniforms(std::vector<std::string>& words, std::string_view text) {
    const auto is_word = [](char c) {
        return std::isalnum(static_cast<unsigned char>(c)) || c == '_';
    };
    bool declares = false;
    for (std::size_t at = 0; at < text.size();) {
        if (text.substr(at, 2) == "//") {
            at = std::min(text.find('\n', at), text.size());
        } else if (is_word(text[at])) {
            const std::size_t end = static_cast<std::size_t>(
                std::find_if_not(text.begin() + static_cast<std::ptrdiff_t>(at), text.end(),
                                 is_word) -
                text.begin());
            const std::string_view word = text.substr(at, end - at);
            if (declares) {
                words.emplace_back(word);
            }
            declares |= word == "uniform";
            at = end;
        } else {
            declares &= text[at] != ';' && text[at] != '{';
            ++at;
        }
    }
}

GLuint compile(const ShaderSource& source, const std::filesystem::path& path) {
    const GLuint shader = glCreateShader(stage_of(path));
    const char* text = source.text.c_str();
    glShaderSource(shader, 1, &text, nullptr);
    glCompileShader(shader);
    GLint ok = 0;
    glGetShaderiv(shader, GL_COMPILE_STATUS, &ok);
    if (!ok) {
        std::string log(16384, '\0');
        GLsizei length = 0;
        glGetShaderInfoLog(shader, static_cast<GLsizei>(log.size()), &length, log.data());
        log.resize(static_cast<std::size_t>(length));
        glDeleteShader(shader);
        throw Error(ExitCode::kNoGpu, one_line(readable_log(log, source)));
    }
    return shader;
}

GLuint build(const std::string& name, const std::vector<std::filesystem::path>& stages,
             const std::vector<std::string>& defines, std::vector<std::string>& declared) {
    breathe(); // a driver may take seconds for each
    const GLuint program = glCreateProgram();
    try {
        for (const auto& stage : stages) {
            const ShaderSource source = expand_shader(stage, defines);
            add_uniforms(declared, source.text);
            const GLuint shader = compile(source, stage);
            glAttachShader(program, shader);
            glDeleteShader(shader); // lives on while attached
        }
        glLinkProgram(program);
        GLint ok = 0;
        glGetProgramiv(program, GL_LINK_STATUS, &ok);
        if (!ok) {
            std::string log(16384, '\0');
            GLsizei length = 0;
            glGetProgramInfoLog(program, static_cast<GLsizei>(log.size()), &length, log.data());
            log.resize(static_cast<std::size_t>(length));
            throw Error(ExitCode::kNoGpu,
                        fmt::format("{}: link: {}", stages.front().string(), one_line(log)));
        }
    } catch (...) {
        glDeleteProgram(program);
        throw;
    }
    glObjectLabel(GL_PROGRAM, program, -1, name.c_str());
    return program;
}

std::vector<std::pair<std::string, int>> uniforms_of(GLuint program) {
    GLint count = 0;
    glGetProgramInterfaceiv(program, GL_UNIFORM, GL_ACTIVE_RESOURCES, &count);
    std::vector<std::pair<std::string, int>> found;
    for (GLuint i = 0; i < static_cast<GLuint>(count); ++i) {
        constexpr GLenum kLocation = GL_LOCATION;
        GLint location = -1;
        glGetProgramResourceiv(program, GL_UNIFORM, i, 1, &kLocation, 1, nullptr, &location);
        char name[256];
        GLsizei length = 0;
        glGetProgramResourceName(program, GL_UNIFORM, i, sizeof name, &length, name);
        if (location >= 0) { // members of blocks have none
            found.emplace_back(std::string(name, static_cast<std::size_t>(length)), location);
        }
    }
    return found;
}

} // namespace

Program::Program(std::string name, std::vector<std::filesystem::path> stages,
                 std::vector<std::string> defines)
    : name_(std::move(name)), stages_(std::move(stages)), defines_(std::move(defines)) {
    reload();
}

Program::~Program() {
    if (id_) {
        glDeleteProgram(id_);
    }
}

Program::Program(Program&& other) noexcept
    : name_(std::move(other.name_)), stages_(std::move(other.stages_)),
      defines_(std::move(other.defines_)), id_(std::exchange(other.id_, 0)),
      locations_(std::move(other.locations_)), declared_(std::move(other.declared_)) {}

Program& Program::operator=(Program&& other) noexcept {
    std::swap(name_, other.name_);
    std::swap(stages_, other.stages_);
    std::swap(defines_, other.defines_);
    std::swap(id_, other.id_);
    std::swap(locations_, other.locations_);
    std::swap(declared_, other.declared_);
    return *this;
}

void Program::use() const {
    glUseProgram(id_);
}

int Program::location(const char* uniform) const {
    for (const auto& [name, at] : locations_) {
        if (name == uniform) {
            return at;
        }
    }
    const std::string_view whole =
        std::string_view(uniform).substr(0, std::string_view(uniform).find_first_of(".["));
    if (std::find(declared_.begin(), declared_.end(), whole) == declared_.end()) {
        throw Error(
            ExitCode::kNoGpu,
            fmt::format("{}: no shader of this program declares the uniform {}", name_, uniform));
    }
    return -1; // one that the compiler left out
}

void Program::reload() {
    std::vector<std::string> declared;
    const GLuint fresh = build(name_, stages_, defines_, declared);
    glDeleteProgram(std::exchange(id_, fresh)); // 0 of a new program: passed over
    declared_ = std::move(declared);
    locations_ = uniforms_of(id_);
}

void Program::set(const char* uniform, int value) const {
    glProgramUniform1i(id_, location(uniform), value);
}
void Program::set(const char* uniform, float value) const {
    glProgramUniform1f(id_, location(uniform), value);
}
void Program::set(const char* uniform, const glm::vec4& value) const {
    glProgramUniform4f(id_, location(uniform), value.x, value.y, value.z, value.w);
}
void Program::set(const char* uniform, const glm::ivec4& value) const {
    glProgramUniform4i(id_, location(uniform), value.x, value.y, value.z, value.w);
}

} // namespace sward::gl
