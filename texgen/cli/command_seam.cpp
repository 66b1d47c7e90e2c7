// SPDX-License-Identifier: Apache-2.0
// `texgen seam`: G2 for what comes from elsewhere.
#include <algorithm>
#include <array>
#include <cstdio>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "base/file.h"
#include "base/log.h"
#include "texgen/cli/commands.h"
#include "texgen/seam/seam_images.h"
#include "texgen/seam/stack_json.h"
#include "texgen/support/output_place.h"
#include "texgen/vdb/vdb_file.h"

namespace sward::texgen {
namespace {

namespace fs = std::filesystem;
using base::ExitCode;

// Below these a step takes less than a second and needs no progress.
constexpr std::size_t kSoonValues = std::size_t{1} << 24, kSoonFileBytes = std::size_t{2} << 20;

std::size_t value_count(const LayerStack& stack) {
    return stack.images.front().values.size() * stack.images.size();
}

/// What the report says.
struct Outcome {
    std::string size;
    JointReport before, after;
};

SeamCut cut_of(double value) {
    return value < 1 ? SeamCut{.share = value} : SeamCut{.texels = static_cast<int>(value)};
}

bool is_vdb(const fs::path& path) {
    std::error_code error;
    if (!fs::is_regular_file(path, error))
        return false;
    const std::vector<std::byte> head = base::read_head(path, 4);
    static constexpr std::array kMagic = {std::byte{0x20}, std::byte{'B'}, std::byte{'D'},
                                          std::byte{'V'}};
    return head.size() == 4 && std::ranges::equal(head, kMagic);
}

/// The result must not stand in the place of what it is made from.
void refuse_same_place(const fs::path& input, const fs::path& output) {
    std::error_code error;
    const bool same = fs::equivalent(input, output, error) ||
                      fs::weakly_canonical(input, error) == fs::weakly_canonical(output, error);
    if (same)
        throw base::input_error(ExitCode::kUsage, output, 0, "output", "the input", "another name");
}

/// A directory that is there already is replaced whole: never one that holds anything but pictures
/// of those names.
void require_stack_place(const LayerStack& stack, const fs::path& output) {
    for (const fs::path& file : stack.files)
        refuse_same_place(file.parent_path().empty() ? fs::path(".") : file.parent_path(), output);
    std::error_code error;
    if (!fs::exists(output, error))
        return base::require_writable(output, base::PendingOutput::Kind::kDirectory);
    if (!fs::is_directory(output, error))
        throw base::input_error(ExitCode::kIo, output, 0, "output", "a file",
                                "a directory for the stack, or none yet");
    for (const auto& entry : fs::directory_iterator(output)) {
        const bool ours = entry.path().filename() == kStackJson ||
                          std::ranges::any_of(stack.files, [&](const fs::path& file) {
                              return file.filename() == entry.path().filename();
                          });
        if (!ours)
            throw base::input_error(ExitCode::kIo, output, 0, "output",
                                    "a directory with other files: " +
                                        base::printable(entry.path().filename().string()),
                                    "an earlier result, an empty directory, or none yet");
    }
    base::require_writable(output, base::PendingOutput::Kind::kDirectory);
}

/// What is known of the input, for the smaller pictures.
StackDescription description_of(const fs::path& input, const LayerStack& stack,
                                const LayerStack& done) {
    std::error_code error;
    StackDescription out;
    if (fs::is_directory(input, error))
        out = read_stack_json(input).value_or(out);
    if (out.layers.empty())
        for (const fs::path& file : done.files)
            out.layers.push_back({file.filename().string(), std::nullopt});
    if (out.side_m)
        out.side_m = *out.side_m * done.images.front().width / stack.images.front().width;
    return out;
}

Outcome seam_pictures(const SeamOptions& options) {
    const LayerStack stack = read_stack(options.input);
    const bool single = stack.files.size() == 1 && stack.files.front() == options.input;
    if (single)
        base::require_writable(options.output);
    else
        require_stack_place(stack, options.output);
    const LayerStack done = seam_stack(stack, cut_of(options.cut));
    if (single) {
        base::write_file_atomic(options.output,
                                assets::encode_layer_image(done.images.front(), options.output));
    } else {
        base::PendingOutput pending(options.output, base::PendingOutput::Kind::kDirectory);
        base::write_file_atomic(pending.path() / kStackJson,
                                stack_json_text(description_of(options.input, stack, done)));
        base::Progress progress("writing pictures",
                                value_count(done) < kSoonValues ? 0 : done.images.size());
        for (std::size_t i = 0; i < done.images.size(); ++i) {
            base::write_file_atomic(pending.path() / done.files[i].filename(),
                                    assets::encode_layer_image(done.images[i], done.files[i]));
            progress.advance();
        }
        pending.commit();
    }
    return {fmt::format("{} x {} texels, {} pictures", done.images.front().width,
                        done.images.front().height, done.images.size()),
            measure_stack(stack), measure_stack(done)};
}

Outcome seam_vdb(const SeamOptions& options) {
    base::require_writable(options.output);
    const std::vector<std::byte> bytes = read_vdb_file(options.input);
    base::Progress progress("volume",
                            bytes.size() < kSoonFileBytes ? 0 : 3); // reading, the borders, writing
    const VdbFile file(bytes, options.input);
    const VdbCells cells = file.read_cells();
    progress.advance();
    if (cells.at.empty())
        throw base::input_error(ExitCode::kBadInput, options.input, 0,
                                "grid " + base::printable(cells.key_grid), "no active voxel",
                                "some");
    CellQuery query{cells.at, cells.key, options.z_up ? 2 : 1, cells.at.front(), {}, {}};
    glm::ivec3 high = query.low;
    for (const glm::ivec3& at : cells.at) {
        query.low = glm::min(query.low, at);
        high = glm::max(high, at);
    }
    query.size = high - query.low + 1;
    const SeamCut cut = cut_of(options.cut);
    for (const int axis : {0, options.z_up ? 1 : 2})
        query.cut[axis] = cut.of(query.size[axis], options.input);
    const CellSeam seam = seam_cells(query);
    progress.advance();
    std::vector<VdbMove> moves;
    moves.reserve(seam.moves.size());
    for (const CellMove& move : seam.moves)
        moves.push_back({cells.at[move.from], move.to + seam.low});
    // Only a square volume has one period; others tile as well, by their box.
    const int other = options.z_up ? 1 : 2;
    const double period = seam.size.x == seam.size[other] ? seam.size.x * cells.voxel.x : 0;
    base::write_file_atomic(options.output, file.moved(moves, period));
    progress.advance();
    return {fmt::format("{} x {} x {} voxels", seam.size.x, seam.size.y, seam.size.z), seam.before,
            seam.after};
}

void report(const SeamOptions& options, const Outcome& outcome) {
    base::log_info(fmt::format("{}: {}, joint {:.2f} of the interior's gradient, before {:.2f}",
                               options.output.string(), outcome.size, outcome.after.ratio(),
                               outcome.before.ratio()));
    if (outcome.after.ratio() > kMostJointRatio)
        base::log_warning(
            fmt::format("the joint's gradient is {}: try another --cut", outcome.after.words()));
    if (options.json)
        fmt::print("{}\n", nlohmann::ordered_json({{"output", options.output.string()},
                                                   {"size", outcome.size},
                                                   {"joint_before", outcome.before.ratio()},
                                                   {"joint_after", outcome.after.ratio()}})
                               .dump(2, ' ', false, nlohmann::json::error_handler_t::replace));
}

} // namespace

int run_seam(const SeamOptions& options) {
    base::set_verbosity(options.verbosity);
    if (!(options.cut > 0))
        throw base::Error(ExitCode::kUsage,
                          "--cut: found 0, expected a share of the side below 1, or texels from 3");
    refuse_same_place(options.input, options.output);
    const OutputParents parents(options.output);
    report(options, is_vdb(options.input) ? seam_vdb(options) : seam_pictures(options));
    return 0;
}

} // namespace sward::texgen
