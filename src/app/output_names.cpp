// SPDX-License-Identifier: Apache-2.0
#include "app/output_names.h"

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <system_error>

#include <fmt/format.h>

#include "app/io.h"
#include "app/parse.h"
#include "base/file.h"

namespace sward::app {
namespace {

namespace fs = std::filesystem;

constexpr const char* kPatternForm = "a name with one %d or %04d in it, as --frames is given";
constexpr int kMostDigits = 9;

bool same_file(const fs::path& a, const fs::path& b) {
    std::error_code error;
    if (fs::equivalent(a, b, error))
        return true;
    const fs::path whole_a = fs::weakly_canonical(fs::absolute(a), error);
    const fs::path whole_b = fs::weakly_canonical(fs::absolute(b), error);
    return !error && whole_a == whole_b;
}

void check_extension(const fs::path& output) {
    const auto known = picture_extensions();
    const std::string extension = output.extension().string();
    const bool fits =
        !extension.empty() &&
        std::find(known.begin(), known.end(), std::string_view(extension).substr(1)) != known.end();
    if (!fits)
        throw option_error("--output", output.string(),
                           fmt::format("a name that ends in .{}", fmt::join(known, " or .")));
}

} // namespace

OutputNames::OutputNames(const Options& options) : before_(options.output.string()) {
    if (!options.frames || options.raw)
        return;
    const std::string whole = before_;
    const std::size_t slash = whole.rfind('/'); // folders may be called what they like
    const std::size_t at = whole.find('%', slash == std::string::npos ? 0 : slash);
    std::size_t end = at == std::string::npos ? at : at + 1;
    while (end < whole.size() && std::isdigit(static_cast<unsigned char>(whole[end])) != 0)
        ++end;
    if (end >= whole.size() || whole[end] != 'd' || whole.find('%', end) != std::string::npos)
        throw option_error("--output", whole, kPatternForm);
    const std::string width = whole.substr(at + 1, end - at - 1); // "", or "0" and the digits
    if (!width.empty() && (width[0] != '0' || width.size() != 2 || width[1] > '0' + kMostDigits))
        throw option_error("--output", whole, kPatternForm);
    digits_ = width.empty() ? 0 : width[1] - '0';
    before_ = whole.substr(0, at);
    after_ = whole.substr(end + 1);
}

fs::path OutputNames::name(int frame) const {
    if (digits_ < 0)
        return before_;
    return fmt::format("{}{:0{}}{}", before_, frame, std::max(digits_, 1), after_);
}

void check_outputs(const Options& options) {
    std::error_code ignored;
    if ((options.output == "-") != options.raw)
        throw options.raw
            ? option_error("--output", options.output.string(), "-, as --format is given")
            : option_error("--output", "-", "--format rgb24 beside it, or the name of a file");
    if (options.raw) {
        if (!options.aovs.empty())
            throw option_error("--output", "-", "a name that ends in .exr, as --aov is given");
        if (!options.stats.empty())
            require_place(options.stats);
        return;
    }
    if (fs::exists(options.output, ignored))
        base::require_writable(options.output); // a directory or a device, whatever it is called
    check_extension(options.output);
    if (!options.aovs.empty() && !is_linear(options.output))
        throw option_error("--output", options.output.string(),
                           "a name that ends in .exr, as --aov is given");
    const OutputNames names(options);
    const fs::path first = names.name(options.frames ? options.frames->first : 0);
    require_place(first);
    if (options.stats.empty())
        return;
    if (same_file(options.stats, first))
        throw option_error("--stats", options.stats.string(), "another file than --output");
    require_place(options.stats);
}

void require_place(const fs::path& path) {
    std::error_code error;
    fs::path parent = fs::absolute(path).lexically_normal().parent_path();
    if (path.empty() || !path.has_filename() || fs::exists(fs::symlink_status(parent, error)) ||
        error.value() == ENAMETOOLONG)
        return base::require_writable(path);
    while (!parent.empty() && parent != parent.root_path() &&
           !fs::exists(fs::symlink_status(parent, error)))
        parent = parent.parent_path();
    base::require_writable(parent / path.filename());
}

void make_parent(const fs::path& path) {
    const fs::path parent = fs::absolute(path).lexically_normal().parent_path();
    std::error_code error;
    fs::create_directories(parent, error);
    if (error && !fs::is_directory(parent))
        throw base::input_error(base::ExitCode::kIo, path, 0, "cannot make its directory",
                                error.message(), "a directory that can be made");
}

void check_not_inputs(const Options& options, const scene::Scene& scene) {
    const OutputNames names(options);
    const fs::path first = names.name(options.frames ? options.frames->first : 0);
    std::vector<fs::path> inputs = {scene.file, scene.terrain.elevation, scene.terrain.mask,
                                    scene.terrain.surface,
                                    scene.file.parent_path() / scene.grass.set};
    for (const scene::LandFeature& feature : scene.terrain.features)
        inputs.push_back(feature.file);
    for (const fs::path& input : inputs) {
        if (input.empty())
            continue;
        if (!options.raw && same_file(first, input))
            throw option_error("--output", first.string(), "another file than the scene's own");
        if (!options.stats.empty() && same_file(options.stats, input))
            throw option_error("--stats", options.stats.string(),
                               "another file than the scene's own");
    }
}

} // namespace sward::app
