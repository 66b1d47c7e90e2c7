// SPDX-License-Identifier: Apache-2.0
#include <cstdio>

#include <fmt/format.h>

#include "app/commands.h"
#include "app/io.h"
#include "app/paths.h"
#include "gl/context.h"

namespace sward::app {
namespace {

void row(std::string_view name, std::string_view value) {
    fmt::print("{:<10} {}\n", name, value);
}

void print_gpu() {
    try {
        const gl::HeadlessContext context;
        const gl::ContextInfo info = gl::context_info();
        row("gpu", fmt::format("{} ({}), EGL {}", info.renderer, info.vendor, context.platform()));
        row("opengl", fmt::format("{}, GLSL {}", info.version, info.glsl_version));
        row("limits",
            fmt::format("samples {}, texture side {}, array layers {}, storage block {} MiB",
                        info.max_samples, info.max_texture_size, info.max_array_layers,
                        info.max_storage_bytes >> 20));
    } catch (const base::Error& error) {
        row("gpu", fmt::format("none that can render: {}", error.what()));
    }
}

std::string cache_text() {
    try {
        return set_cache_directory().string();
    } catch (const base::Error& error) {
        return fmt::format("none: {}", error.what());
    }
}

} // namespace

void run_info() {
    row("sward", fmt::format("{} ({} build)", SWARD_VERSION, build_name()));
    print_gpu();
    row("formats", format_libraries());
    row("data", data_directory().string());
    row("scene", default_scene().string());
    row("presets", presets_directory().string());
    row("sets", cache_text());
    row("texgen", texgen_program().string());
    if (std::fflush(stdout) != 0 || std::ferror(stdout) != 0)
        throw base::Error(base::ExitCode::kIo, "stdout: cannot write: found a full or closed "
                                               "stream, expected room for the report");
}

} // namespace sward::app
