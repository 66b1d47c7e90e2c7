// SPDX-License-Identifier: Apache-2.0
#include "tracks/track_pass.h"

#include <algorithm>

#include <epoxy/gl.h>

#include "shared/bindings.h"
#include "shared/track_seen.h"

namespace sward::tracks {

namespace {

constexpr std::size_t kCells = std::size_t{shared::kTrackCells} * shared::kTrackCells;
constexpr std::size_t kBlockCells = std::size_t{shared::kTrackBlock} * shared::kTrackBlock;
constexpr std::size_t kPageBytes = shared::kTrackWords * sizeof(std::uint32_t),
                      kBlockBytes = kBlockCells * sizeof(glm::vec4);
constexpr int kLeastSlots = 8, kLeastPlaces = 64;
static_assert(shared::kTrackBlock == TRACK_GROUP);

/// The same with room for more bytes; the new ones are zeros.
void grow(gl::Buffer& buffer, std::size_t bytes) {
    gl::Buffer next(bytes);
    next.clear_to_zero();
    if (buffer.bytes() > 0) {
        glCopyNamedBufferSubData(buffer.id(), next.id(), 0, 0,
                                 static_cast<GLsizeiptr>(buffer.bytes()));
    }
    buffer = std::move(next);
}

void zero(const gl::Buffer& buffer, std::size_t first, std::size_t bytes) {
    glClearNamedBufferSubData(buffer.id(), GL_R32UI, static_cast<GLintptr>(first),
                              static_cast<GLsizeiptr>(bytes), GL_RED_INTEGER, GL_UNSIGNED_INT,
                              nullptr);
}

/// Room for `asked` of them: twice as many as there are, at most `most`.
int grown(int asked, int there, int least, int most) {
    return std::max(asked, std::min(most, std::max(least, 2 * there)));
}

} // namespace

TrackPass::TrackPass(int most_pages, int most_blocks, int table_size)
    : most_pages_(most_pages), most_blocks_(most_blocks), table_size_(table_size),
      change_("track change", {"tracks/change.comp"}),
      advance_("track advance", {"tracks/advance.comp"}),
      press_("track press", {"tracks/advance.comp"}, {"PRESS_ONLY"}),
      rebase_("track rebase", {"tracks/rebase.comp"}), show_("track show", {"tracks/show.comp"}),
      table_((static_cast<std::size_t>(table_size) +
              static_cast<std::size_t>(most_pages) * shared::kTrackBlocks / 4) *
             sizeof(glm::ivec4)) {
    glCreateTextures(GL_TEXTURE_BUFFER, 3, textures_);
    reserve(1, 1);
}

TrackPass::~TrackPass() {
    glDeleteTextures(3, textures_);
}

void TrackPass::reserve(int slots, int places) {
    if (slots <= slots_ && places <= places_) {
        return;
    }
    if (slots > slots_) {
        slots_ = grown(slots, slots_, kLeastSlots, most_pages_);
        grow(shown_, static_cast<std::size_t>(slots_) * kPageBytes);
    }
    if (places > places_) {
        places_ = grown(places, places_, kLeastPlaces, most_blocks_);
        grow(bends_, static_cast<std::size_t>(places_) * kBlockBytes);
        grow(changes_, static_cast<std::size_t>(places_) * kBlockBytes);
    }
    glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
    point_textures();
}

void TrackPass::point_textures() const {
    glTextureBuffer(textures_[0], GL_RGBA32F, bends_.id());
    glTextureBuffer(textures_[1], GL_R32UI, shown_.id());
    glTextureBuffer(textures_[2], GL_RGBA32I, table_.id());
}

void TrackPass::bind() const {
    glBindTextureUnit(TEX_TRACK_BENDS, textures_[0]);
    glBindTextureUnit(TEX_TRACK_SHOWN, textures_[1]);
    glBindTextureUnit(TEX_TRACK_TABLE, textures_[2]);
}

void TrackPass::bind_cells() const {
    bends_.bind_storage(BIND_TRACK_BENDS);
    changes_.bind_storage(BIND_TRACK_CHANGES);
    table_.bind_storage(BIND_TRACK_TABLE);
    work_.bind_storage(BIND_TRACK_WORK);
    shown_.bind_storage(BIND_TRACK_SHOWN);
}

void TrackPass::dispatch(const gl::Program& program, std::size_t entries, int side) const {
    const auto groups = static_cast<GLuint>((side + TRACK_GROUP - 1) / TRACK_GROUP);
    program.use();
    glDispatchCompute(groups, groups, static_cast<GLuint>(entries));
    glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_TEXTURE_FETCH_BARRIER_BIT |
                    GL_BUFFER_UPDATE_BARRIER_BIT);
}

void TrackPass::upload_work(std::span<const shared::TrackBlock> blocks) {
    work_.reserve(blocks.size_bytes());
    work_.upload(blocks.data(), blocks.size_bytes());
    bind_cells();
}

namespace {

void set_rules(const gl::Program& program, const shared::TrackRules& rules) {
    program.set("step_rules.cell_m", rules.cell_m);
    program.set("step_rules.step_s", rules.step_s);
    program.set("step_rules.damping", rules.damping);
    program.set("step_rules.recovery_per_s2", rules.recovery_per_s2);
    program.set("step_rules.wave_mps", rules.wave_mps);
    program.set("step_rules.rate_wave_mps", rules.rate_wave_mps);
    program.set("step_rules.wave_gain_m", rules.wave_gain_m);
    program.set("step_rules.most_wave_mps", rules.most_wave_mps);
    program.set("step_rules.canopy_m", rules.canopy_m);
    program.set("step_rules.broken", rules.broken);
    program.set("step_rules.left", rules.left);
}

} // namespace

void TrackPass::step(const shared::TrackRules& rules, const Work& work) {
    prints_.reserve(std::max(work.prints.size(), std::size_t{1}) * sizeof(shared::TrackPrint));
    prints_.upload(work.prints.data(), work.prints.size() * sizeof(shared::TrackPrint));
    const auto run = [&](const gl::Program& program, std::size_t entries) {
        program.use();
        set_rules(program, rules);
        dispatch(program, entries, TRACK_GROUP);
    };
    prints_.bind_storage(BIND_TRACK_PRINTS);
    if (!work.moving.empty()) {
        upload_work(work.moving);
        run(change_, work.moving.size());
        run(advance_, work.moving.size());
    }
    if (!work.resting.empty()) {
        upload_work(work.resting);
        run(press_, work.resting.size());
    }
}

void TrackPass::upload_pages(std::span<const int> slots) {
    std::vector<shared::TrackBlock> pages(slots.size());
    for (std::size_t n = 0; n < slots.size(); ++n) {
        pages[n].slot = slots[n];
    }
    upload_work(pages);
}

void TrackPass::rebase(std::span<const int> slots) {
    if (!slots.empty()) {
        upload_pages(slots);
        dispatch(rebase_, slots.size(), shared::kTrackCells);
    }
}

void TrackPass::show(std::span<const int> slots) {
    if (slots.empty()) {
        return;
    }
    upload_pages(slots);
    show_.use();
    show_.set("table_size", table_size_);
    for (int level = 1; level < shared::kTrackLevels; ++level) {
        show_.set("level", level);
        dispatch(show_, slots.size(), shared::kTrackCells >> level);
    }
}

void TrackPass::put(int slot, const std::vector<std::uint32_t>& pressed) {
    shown_.upload(pressed.data(), pressed.size() * sizeof(std::uint32_t),
                  static_cast<std::size_t>(slot) * kPageBytes);
}

std::vector<std::uint32_t> TrackPass::get(int slot) const {
    std::vector<std::uint32_t> pressed(kCells);
    shown_.read(pressed.data(), kCells * sizeof(std::uint32_t),
                static_cast<std::size_t>(slot) * kPageBytes);
    return pressed;
}

void TrackPass::clear(int slot) {
    zero(shown_, static_cast<std::size_t>(slot) * kPageBytes, kPageBytes);
}

void TrackPass::put_block(int place, std::span<const glm::vec4> bends,
                          std::span<const glm::vec4> changes) {
    bends_.upload(bends.data(), bends.size_bytes(), static_cast<std::size_t>(place) * kBlockBytes);
    changes_.upload(changes.data(), changes.size_bytes(),
                    static_cast<std::size_t>(place) * kBlockBytes);
}

void TrackPass::get_block(int place, PageContent& into) const {
    const std::size_t first = into.bends.size();
    into.bends.resize(first + kBlockCells);
    into.changes.resize(first + kBlockCells);
    bends_.read(into.bends.data() + first, kBlockBytes,
                static_cast<std::size_t>(place) * kBlockBytes);
    changes_.read(into.changes.data() + first, kBlockBytes,
                  static_cast<std::size_t>(place) * kBlockBytes);
}

void TrackPass::clear_block(int place) {
    zero(bends_, static_cast<std::size_t>(place) * kBlockBytes, kBlockBytes);
    zero(changes_, static_cast<std::size_t>(place) * kBlockBytes, kBlockBytes);
}

glm::vec4 TrackPass::cell(int slot, int place, glm::ivec2 at) const {
    std::uint32_t word = 0;
    shown_.read(&word, sizeof(word),
                static_cast<std::size_t>(slot) * kPageBytes +
                    static_cast<std::size_t>(at.y * shared::kTrackCells + at.x) * sizeof(word));
    glm::vec4 bend(0);
    if (place >= 0) {
        bends_.read(&bend, sizeof(bend),
                    static_cast<std::size_t>(place) * kBlockBytes +
                        static_cast<std::size_t>(shared::track_in_block(at)) * sizeof(bend));
    }
    const glm::vec2 lying = shared::track_unpack(word);
    return {bend.x, bend.y, lying.x, lying.y};
}

std::size_t TrackPass::bytes() const {
    std::size_t sum = 0;
    for (const gl::Buffer* buffer : {&bends_, &changes_, &shown_, &table_, &work_, &prints_}) {
        sum += buffer->bytes();
    }
    return sum;
}

void TrackPass::reload() {
    for (gl::Program* program : {&change_, &advance_, &press_, &rebase_, &show_}) {
        program->reload();
    }
}

} // namespace sward::tracks
