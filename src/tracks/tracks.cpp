// SPDX-License-Identifier: Apache-2.0
#include "tracks/tracks.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "base/log.h"
#include "shared/track_seen.h"

namespace sward::tracks {

namespace {

constexpr double kStep_s = 1.0 / 60;             // shared::kTrackStep_s, in double
constexpr double kEpochs = shared::kTrackEpochs; // in the time that lies until 1/e
constexpr double kNearEye_m = 1e4; // pages that the memory holds come back for an eye within

} // namespace

shared::TrackRules rules_of(const scene::TrackSpec& spec, double canopy_m) {
    shared::TrackRules rules{};
    rules.cell_m = static_cast<float>(spec.cell_m);
    rules.step_s = static_cast<float>(kStep_s);
    rules.damping = static_cast<float>(spec.damping);
    rules.recovery_per_s2 = static_cast<float>(spec.recovery_per_s2);
    rules.wave_mps = static_cast<float>(spec.wave_mps);
    rules.rate_wave_mps = static_cast<float>(spec.rate_wave_mps);
    rules.wave_gain_m = static_cast<float>(spec.wave_gain_m);
    rules.most_wave_mps =
        shared::track_greatest_wave(rules.cell_m, rules.step_s, rules.recovery_per_s2);
    rules.canopy_m = static_cast<float>(canopy_m);
    rules.broken = static_cast<float>(spec.broken);
    rules.left = 1;
    return rules;
}

std::int64_t steps_to_rest(const shared::TrackRules& rules) {
    shared::TrackCell cell{{1, 0}, {0, 0}, {0, 0}, {0, 0}};
    std::int64_t last = 1;
    for (std::int64_t n = 1; n <= 3600; ++n) {
        const glm::vec4 same(cell.theta, cell.omega);
        cell =
            shared::track_advance(cell, shared::track_change(rules, cell, same, same, same, same));
        last = std::abs(cell.theta.x) > 1e-3f ? n + 1 : last;
    }
    return std::min<std::int64_t>(last, 3600);
}

Tracks::Tracks(const scene::Scene& scene, double canopy_m, Inputs inputs)
    : spec_(scene.tracks.value()), prints_(spec_, scene.paths, canopy_m, inputs.ground),
      inputs_(std::move(inputs)), pages_(spec_.pages, spec_.cell_m * shared::kTrackCells),
      memory_(static_cast<std::size_t>(spec_.memory_mb * 1e6)),
      pass_(spec_.pages, spec_.pages * kMovingBlocksAPage, pages_.table_size()),
      rules_(rules_of(spec_, canopy_m)), settle_steps_(steps_to_rest(rules_)) {}

void Tracks::forget() {
    pages_.clear();
    memory_.clear();
    free_places_.clear();
    places_ever_ = 0;
    places_used_ = 0;
    table_changed_ = true;
}

void Tracks::restart() {
    forget();
    done_ = epoch_ = 0;
    rules_.left = 1;
    if (first_) {
        const scene::Image picture = *first_;
        begin_with(picture, first_name_);
    }
}

void Tracks::advance(double time_s, std::span<const glm::dvec3> eyes) {
    eyes_.clear();
    for (const glm::dvec3& eye : eyes) {
        eyes_.emplace_back(eye.x, eye.z);
    }
    const auto target = static_cast<std::int64_t>(std::floor(time_s / kStep_s + 1e-6));
    if (done_ < 0 || target < done_) {
        restart();
    }
    const bool leap =
        target - done_ > std::max(static_cast<std::int64_t>(kLeap_s / kStep_s), settle_steps_);
    const std::int64_t full_from = leap ? target - settle_steps_ : done_;
    while (done_ < target) {
        ++done_;
        step(done_, done_ > full_from);
    }
    time_s_ = time_s;
    bring_back();
    show();
    if (refused_ + stilled_ + memory_.lost() + prints_.leaps() > 0 && !told_) {
        told_ = true;
        base::log_warning(fmt::format(
            "tracks: {} pages found no room and {} blocks were stilled early (tracks.pages = {}), "
            "{} pages were forgotten "
            "(tracks.memory_mb = {}), {} ways were too fast to be followed",
            refused_, stilled_, spec_.pages, memory_.lost(), spec_.memory_mb, prints_.leaps()));
    }
}

void Tracks::follow_epoch(double time_s) {
    const double span = spec_.lasting_s / kEpochs;
    const auto epoch = static_cast<std::int64_t>(std::floor(time_s / span));
    for (; epoch_ < epoch; ++epoch_) {
        pass_.rebase(pages_.in_order());
        for (Pages::Page& page : pages_.slots()) {
            page.shown = false;
        }
    }
    rules_.left =
        shared::track_left(static_cast<float>(time_s - static_cast<double>(epoch_) * span),
                           static_cast<float>(spec_.lasting_s));
}

void Tracks::step(std::int64_t number, bool full) {
    const double then_s = static_cast<double>(number) * kStep_s;
    follow_epoch(then_s);
    settle(number);
    const std::vector<Ball> balls =
        inputs_.balls ? inputs_.balls(then_s, kStep_s) : std::vector<Ball>{};
    const std::vector<Print> prints = prints_.at(then_s, kStep_s, balls);
    wake(prints, number, full);
    const TrackPass::Work work = work_of(prints, number);
    pass_.step(rules_, work);
    stepped_ += work.moving.size() + work.resting.size();
    for (const auto* blocks : {&work.moving, &work.resting}) {
        for (const shared::TrackBlock& block : *blocks) {
            pages_.slots()[static_cast<std::size_t>(block.slot)].shown = false;
        }
    }
}

int Tracks::bring(PageKey key, std::span<const PageKey> kept) {
    if (const int slot = pages_.slot_of(key); slot >= 0) {
        return slot;
    }
    if (pages_.used() == pages_.slots().size()) {
        const int worst = pages_.least_needed(eyes_, done_, kept);
        if (worst < 0) {
            ++refused_;
            return -1;
        }
        drop(worst);
    }
    const int slot = pages_.open(key);
    pass_.reserve(slot + 1, 0);
    Pages::Page& page = pages_.slots()[static_cast<std::size_t>(slot)];
    const double side = pages_.side_m();
    const glm::dvec2 low = pages_.corner(key), high = low + side;
    const double nw = inputs_.ground(low.x, low.y), ne = inputs_.ground(high.x, low.y),
                 sw = inputs_.ground(low.x, high.y), se = inputs_.ground(high.x, high.y);
    page.slope = glm::vec2(glm::dvec2(ne + se - nw - sw, sw + se - nw - ne) / (2 * side));
    table_changed_ = true;
    pass_.clear(slot);
    if (std::optional<PageContent> content = memory_.take(key)) {
        restore(slot, std::move(*content));
    }
    return slot;
}

void Tracks::restore(int slot, PageContent content) {
    Pages::Page& page = pages_.slots()[static_cast<std::size_t>(slot)];
    const std::int64_t epochs = std::min<std::int64_t>(epoch_ - content.epoch, 1000);
    for (std::int64_t n = 0; n < epochs;
         ++n) { // step by step, as rebase() would have: the same bits
        for (std::uint32_t& cell : content.pressed) {
            cell = shared::track_rebased(cell);
        }
    }
    pass_.put(slot, content.pressed);
    constexpr std::size_t kBlockCells = std::size_t{shared::kTrackBlock} * shared::kTrackBlock;
    for (std::size_t n = 0; n < content.moving.size() / 2; ++n) {
        const std::int64_t until = content.moving[2 * n + 1];
        if (until < done_ && spec_.recovery_per_s2 > 0) {
            continue; // has risen since
        }
        Block& block = page.blocks[static_cast<std::size_t>(content.moving[2 * n])];
        block.place = take_place(until);
        if (block.place >= 0) {
            block.busy_until = until;
            page.busy_until = std::max(page.busy_until, until);
            pass_.put_block(block.place,
                            std::span(content.bends).subspan(n * kBlockCells, kBlockCells),
                            std::span(content.changes).subspan(n * kBlockCells, kBlockCells));
        }
    }
}

void Tracks::drop(int slot) {
    Pages::Page& page = pages_.slots()[static_cast<std::size_t>(slot)];
    PageContent content;
    content.pressed = pass_.get(slot);
    content.epoch = epoch_;
    for (std::size_t n = 0; n < page.blocks.size(); ++n) {
        Block& block = page.blocks[n];
        if (block.place >= 0) {
            content.moving.insert(content.moving.end(),
                                  {static_cast<std::int64_t>(n), block.busy_until});
            pass_.get_block(block.place, content);
            lay_to_rest(block);
        }
    }
    const bool something =
        !content.moving.empty() || std::any_of(content.pressed.begin(), content.pressed.end(),
                                               [](std::uint32_t word) { return word != 0; });
    if (something) {
        memory_.put(page.key, content);
    }
    pages_.close(slot);
    table_changed_ = true;
}

/// Pages of the memory that lie near an eye, nearest first, into free slots or those of farther
/// pages.
void Tracks::bring_back() {
    std::vector<std::pair<double, std::pair<int, int>>> near;
    for (const PageKey key : memory_.keys()) {
        for (const glm::dvec2& eye : eyes_) {
            const double away = glm::distance(
                eye, glm::clamp(eye, pages_.corner(key), pages_.corner(key) + pages_.side_m()));
            if (away < kNearEye_m) {
                near.push_back({away, {key.y, key.x}});
            }
        }
    }
    std::sort(near.begin(), near.end());
    std::vector<PageKey> kept;
    for (const auto& [away, at] : near) {
        const PageKey key(at.second, at.first);
        if (pages_.used() == pages_.slots().size()) {
            const int worst = pages_.least_needed(eyes_, done_, kept);
            const auto nearest = [&](PageKey page) {
                double least = 1e30;
                for (const glm::dvec2& eye : eyes_) {
                    least = std::min(least, glm::distance(eye, glm::clamp(eye, pages_.corner(page),
                                                                          pages_.corner(page) +
                                                                              pages_.side_m())));
                }
                return least;
            };
            if (worst < 0 || nearest(pages_.slots()[static_cast<std::size_t>(worst)].key) <= away) {
                return;
            }
        }
        if (bring(key, kept) >= 0) {
            kept.push_back(key);
        }
    }
}

void Tracks::show() {
    std::vector<int> stale;
    for (const int slot : pages_.in_order()) {
        Pages::Page& page = pages_.slots()[static_cast<std::size_t>(slot)];
        if (!page.shown) {
            stale.push_back(slot);
            page.shown = true;
        }
    }
    if (table_changed_) {
        pass_.set_table(pages_.table());
        table_changed_ = false;
    }
    pass_.show(stale);
}

shared::TrackField Tracks::field(glm::dvec2 anchor) const {
    shared::TrackField out{};
    const PageKey page = pages_.key_at(anchor);
    out.place = glm::vec2(anchor - pages_.corner(page));
    out.per_m = static_cast<float>(1 / spec_.cell_m);
    out.left = rules_.left;
    out.page = {page.x, page.y};
    out.table_mask = pages_.used() > 0 ? pages_.table_size() - 1 : -1;
    out.wave_mps = rules_.wave_mps;
    out.wave_gain_m = rules_.wave_gain_m;
    glm::dvec2 low(1e30), high(-1e30);
    for (const Pages::Page& one : pages_.slots()) {
        if (one.used) {
            low = glm::min(low, pages_.corner(one.key));
            high = glm::max(high, pages_.corner(one.key) + pages_.side_m());
        }
    }
    out.least = glm::vec2(low - anchor);
    out.most = glm::vec2(high - anchor);
    return out;
}

Tracks::Sample Tracks::at(double x, double z) const {
    const PageKey key = pages_.key_at({x, z});
    const int slot = pages_.slot_of(key);
    Sample sample;
    if (slot >= 0) {
        const glm::ivec2 at =
            glm::clamp(glm::ivec2((glm::dvec2(x, z) - pages_.corner(key)) / spec_.cell_m), 0,
                       shared::kTrackCells - 1);
        const Block& block = pages_.slots()[static_cast<std::size_t>(slot)]
                                 .blocks[static_cast<std::size_t>(shared::track_block_of(at))];
        const glm::vec4 cell = pass_.cell(slot, block.place, at);
        sample.theta = glm::vec2(cell);
        sample.pressed = glm::vec2(cell.z, cell.w) * rules_.left;
    }
    return sample;
}

} // namespace sward::tracks
