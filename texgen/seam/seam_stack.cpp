// SPDX-License-Identifier: Apache-2.0
// Which pictures a stack is made of.
#include <algorithm>
#include <cctype>

#include <fmt/format.h>

#include "assets/limits.h"
#include "base/error.h"
#include "base/file.h"
#include "base/log.h"
#include "texgen/seam/seam_images.h"
#include "texgen/seam/stack_json.h"

namespace sward::texgen {
namespace {

namespace fs = std::filesystem;
using assets::Format;
using assets::LayerImage;
using base::ExitCode;

constexpr std::size_t kMaxPictures = 2048;
constexpr std::uint64_t kMaxStackBytes = std::uint64_t{1} << 31; // as floats
constexpr int kMaxPatternWidth = 9;
constexpr std::uint64_t kSoonFileBytes = std::uint64_t{4} << 20; // read in a second

/// "layer2" before "layer10": runs of digits compare as numbers.
bool natural_before(const std::string& a, const std::string& b) {
    std::size_t i = 0, j = 0;
    const auto digit = [](char c) { return c >= '0' && c <= '9'; };
    while (i < a.size() && j < b.size()) {
        if (!digit(a[i]) || !digit(b[j])) {
            if (a[i] != b[j])
                return a[i] < b[j];
            ++i, ++j;
            continue;
        }
        const auto run = [&](const std::string& s, std::size_t& at) {
            while (at + 1 < s.size() && s[at] == '0' && digit(s[at + 1]))
                ++at;
            const std::size_t from = at;
            while (at < s.size() && digit(s[at]))
                ++at;
            return s.substr(from, at - from);
        };
        const std::string left = run(a, i), right = run(b, j);
        if (left.size() != right.size())
            return left.size() < right.size();
        if (left != right)
            return left < right;
    }
    return a.size() - i != b.size() - j ? a.size() - i < b.size() - j : a < b;
}

std::vector<fs::path> in_directory(const fs::path& directory) {
    std::vector<fs::path> files;
    if (const auto described = read_stack_json(directory)) {
        for (const StackLayer& layer : described->layers)
            files.push_back(directory / layer.file);
        return files;
    }
    for (const auto& entry : fs::directory_iterator(directory)) {
        std::string extension = entry.path().extension().string();
        std::ranges::transform(extension, extension.begin(),
                               [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
        if (extension == ".png" || extension == ".tif" || extension == ".tiff" ||
            extension == ".exr")
            files.push_back(entry.path());
    }
    std::ranges::sort(files, [](const fs::path& a, const fs::path& b) {
        return natural_before(a.filename().string(), b.filename().string());
    });
    if (files.empty())
        throw base::input_error(ExitCode::kBadInput, directory, 0, "pictures", "none",
                                "PNG, TIFF or EXR files");
    return files;
}

/// A printf pattern of one number, taken apart by hand: the text is a user's, not a format of ours.
struct Pattern {
    std::string before, after;
    int width = 0;
    bool zeros = false;

    [[nodiscard]] std::string name(int number) const {
        return zeros ? fmt::format("{}{:0{}}{}", before, number, width, after)
                     : fmt::format("{}{:{}}{}", before, number, width, after);
    }
};

bool parse_pattern(const std::string& text, Pattern& out) {
    const std::size_t percent = text.find('%');
    if (percent == std::string::npos)
        return false;
    std::size_t at = percent + 1;
    out.zeros = at < text.size() && text[at] == '0';
    while (at < text.size() && text[at] >= '0' && text[at] <= '9' && out.width <= kMaxPatternWidth)
        out.width = out.width * 10 + (text[at++] - '0');
    out.before = text.substr(0, percent);
    if (at >= text.size() || text[at] != 'd' || out.width > kMaxPatternWidth)
        return false;
    out.after = text.substr(at + 1);
    return out.after.find('%') == std::string::npos;
}

std::vector<fs::path> by_pattern(const fs::path& input) {
    Pattern pattern;
    if (!parse_pattern(input.filename().string(), pattern))
        throw base::input_error(ExitCode::kBadInput, input, 0, "pattern", input.filename().string(),
                                "one %d or %04d in the name");
    std::vector<fs::path> files;
    for (int number = 0; number < 10000 && files.size() <= kMaxPictures; ++number) {
        const fs::path file = input.parent_path() / pattern.name(number);
        if (fs::exists(file))
            files.push_back(file);
        else if (!files.empty())
            break;
    }
    if (files.empty())
        throw base::input_error(ExitCode::kIo, input, 0, "pictures", "none",
                                "files from number 0 to 9999 on");
    return files;
}

std::vector<fs::path> files_of(const fs::path& input) {
    std::error_code error;
    const fs::file_status status = fs::status(input, error);
    if (fs::is_directory(status))
        return in_directory(input);
    if (!fs::exists(status) && input.filename().string().find('%') != std::string::npos)
        return by_pattern(input);
    return {input};
}

std::string kind_of(const LayerImage& image) {
    static constexpr const char* kTypes[] = {"8 bits", "16 bits", "half", "float"};
    return fmt::format("{} x {}, {} channels, {}", image.width, image.height, image.channels,
                       kTypes[static_cast<int>(image.type)]);
}

} // namespace

LayerStack read_stack(const fs::path& input) {
    LayerStack stack{files_of(input), {}};
    if (stack.files.size() > kMaxPictures)
        throw base::input_error(ExitCode::kOverLimit, input, 0, "pictures",
                                std::to_string(stack.files.size()),
                                fmt::format("at most {}", kMaxPictures));
    std::uint64_t bytes = 0, file_bytes = 0;
    std::error_code unknown; // reading says what is wrong
    for (const fs::path& file : stack.files)
        if (const std::uintmax_t size = fs::file_size(file, unknown); !unknown)
            file_bytes += size;
    base::Progress progress("reading pictures",
                            file_bytes > kSoonFileBytes ? stack.files.size() : 0);
    for (const fs::path& file : stack.files) {
        stack.images.push_back(assets::read_layer_image(file));
        const LayerImage& image = stack.images.back();
        const LayerImage& first = stack.images.front();
        if (kind_of(image) != kind_of(first) || image.names != first.names)
            throw base::input_error(ExitCode::kBadInput, file, 0, "picture", kind_of(image),
                                    kind_of(first) + " as the first of the stack");
        bytes += image.values.size() * sizeof(float);
        if (bytes * stack.files.size() / stack.images.size() > kMaxStackBytes)
            throw base::input_error(
                ExitCode::kOverLimit, input, 0, "pictures",
                fmt::format("{} of {}", stack.files.size(), kind_of(first)),
                fmt::format("at most {} values in all", kMaxStackBytes / sizeof(float)));
        progress.advance();
    }
    return stack;
}

} // namespace sward::texgen
