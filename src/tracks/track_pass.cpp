// SPDX-License-Identifier: Apache-2.0
#include "tracks/track_pass.h"

#include <algorithm>

#include <epoxy/gl.h>

#include "shared/bindings.h"

namespace sward::tracks {

namespace {

constexpr std::size_t kCells = std::size_t{shared::kTrackCells} * shared::kTrackCells;
constexpr int kLeastSlots = 8;

/// The same with room for more bytes; the new ones are zeros.
void grow(gl::Buffer& buffer, std::size_t bytes) {
    gl::Buffer next(bytes);
    next.clear_to_zero();
    if (buffer.bytes() > 0) {
        glCopyNamedBufferSubData(buffer.id(), next.id(), 0, 0, static_cast<GLsizeiptr>(buffer.bytes()));
    }
    buffer = std::move(next);
}

void zero(const gl::Buffer& buffer, std::size_t first, std::size_t bytes) {
    glClearNamedBufferSubData(buffer.id(), GL_R32UI, static_cast<GLintptr>(first), static_cast<GLsizeiptr>(bytes), GL_RED_INTEGER, GL_UNSIGNED_INT,
                              nullptr);
}

} // namespace

TrackPass::TrackPass(int table_size)
    : change_("track change", {"tracks/change.comp"}), advance_("track advance", {"tracks/advance.comp"}),
      press_("track press", {"tracks/advance.comp"}, {"PRESS_ONLY"}), rebase_("track rebase", {"tracks/rebase.comp"}),
      show_("track show", {"tracks/show.comp"}), table_(static_cast<std::size_t>(table_size) * sizeof(glm::ivec4)) {
    glCreateTextures(GL_TEXTURE_BUFFER, 2, textures_);
    reserve(kLeastSlots);
}

TrackPass::~TrackPass() { glDeleteTextures(2, textures_); }

void TrackPass::reserve(int slots) {
    if (slots <= slots_) {
        return;
    }
    slots_ = std::max(slots, std::max(kLeastSlots, 2 * slots_));
    const auto count = static_cast<std::size_t>(slots_);
    grow(bends_, count * kCells * sizeof(glm::vec4));
    grow(changes_, count * kCells * sizeof(glm::vec4));
    grow(pressed_, count * kCells * sizeof(glm::vec2));
    grow(shown_, count * shared::kTrackTexels * sizeof(glm::uvec2));
    glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
    point_textures();
}

void TrackPass::point_textures() const {
    glTextureBuffer(textures_[0], GL_RGBA16F, shown_.id());
    glTextureBuffer(textures_[1], GL_RGBA32I, table_.id());
}

void TrackPass::bind() const {
    glBindTextureUnit(TEX_TRACK_SHOWN, textures_[0]);
    glBindTextureUnit(TEX_TRACK_TABLE, textures_[1]);
}

void TrackPass::bind_cells() const {
    bends_.bind_storage(BIND_TRACK_BENDS);
    changes_.bind_storage(BIND_TRACK_CHANGES);
    pressed_.bind_storage(BIND_TRACK_PRESSED);
    pages_.bind_storage(BIND_TRACK_PAGES);
}

void TrackPass::dispatch(const gl::Program& program, std::size_t pages, int side) const {
    const auto groups = static_cast<GLuint>((side + TRACK_GROUP - 1) / TRACK_GROUP);
    program.use();
    glDispatchCompute(groups, groups, static_cast<GLuint>(pages));
    glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_TEXTURE_FETCH_BARRIER_BIT | GL_BUFFER_UPDATE_BARRIER_BIT);
}

void TrackPass::step(const shared::TrackRules& rules, std::span<const shared::TrackPage> pages, std::span<const shared::TrackPrint> prints, bool press_only) {
    if (pages.empty()) {
        return;
    }
    pages_.reserve(pages.size_bytes());
    pages_.upload(pages.data(), pages.size_bytes());
    prints_.reserve(std::max(prints.size_bytes(), sizeof(shared::TrackPrint)));
    prints_.upload(prints.data(), prints.size_bytes());
    bind_cells();
    prints_.bind_storage(BIND_TRACK_PRINTS);
    for (const gl::Program* program : {&change_, &advance_, &press_}) {
        if (press_only != (program == &press_)) {
            continue;
        }
        program->use();
        program->set("rules_grid", rules.grid);
        program->set("rules_waves", rules.waves);
        program->set("rules_grass", rules.grass);
        dispatch(*program, pages.size(), press_only ? TRACK_GROUP : shared::kTrackCells);
    }
}

void TrackPass::upload_pages(std::span<const int> slots) {
    std::vector<shared::TrackPage> pages(slots.size());
    for (std::size_t n = 0; n < slots.size(); ++n) {
        pages[n].slot.x = slots[n];
    }
    pages_.reserve(pages.size() * sizeof(pages[0]));
    pages_.upload(pages.data(), pages.size() * sizeof(pages[0]));
}

void TrackPass::rebase(std::span<const int> slots, float factor) {
    if (slots.empty()) {
        return;
    }
    upload_pages(slots);
    bind_cells();
    rebase_.use();
    rebase_.set("factor", factor);
    dispatch(rebase_, slots.size(), shared::kTrackCells);
}

void TrackPass::show(std::span<const int> slots) {
    if (slots.empty()) {
        return;
    }
    upload_pages(slots);
    bind_cells();
    shown_.bind_storage(BIND_TRACK_SHOWN);
    show_.use();
    for (int level = 0; level < shared::kTrackLevels; ++level) {
        show_.set("level", level);
        dispatch(show_, slots.size(), shared::kTrackCells >> level);
    }
}

void TrackPass::put(int slot, const PageContent& content) {
    const auto first = static_cast<std::size_t>(slot) * kCells;
    clear(slot, false);
    glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
    pressed_.upload(content.pressed.data(), content.pressed.size() * sizeof(glm::vec2), first * sizeof(glm::vec2));
    bends_.upload(content.bends.data(), content.bends.size() * sizeof(glm::vec4), first * sizeof(glm::vec4));
    changes_.upload(content.changes.data(), content.changes.size() * sizeof(glm::vec4), first * sizeof(glm::vec4));
}

PageContent TrackPass::get(int slot, bool moves) const {
    const auto first = static_cast<std::size_t>(slot) * kCells;
    PageContent content;
    content.pressed.resize(kCells);
    pressed_.read(content.pressed.data(), kCells * sizeof(glm::vec2), first * sizeof(glm::vec2));
    if (moves) {
        content.bends.resize(kCells);
        content.changes.resize(kCells);
        bends_.read(content.bends.data(), kCells * sizeof(glm::vec4), first * sizeof(glm::vec4));
        changes_.read(content.changes.data(), kCells * sizeof(glm::vec4), first * sizeof(glm::vec4));
    }
    return content;
}

glm::vec4 TrackPass::cell(int slot, glm::ivec2 place) const {
    const std::size_t n = static_cast<std::size_t>(slot) * kCells + static_cast<std::size_t>(place.y * shared::kTrackCells + place.x);
    glm::vec4 bend;
    glm::vec2 lying;
    bends_.read(&bend, sizeof(bend), n * sizeof(bend));
    pressed_.read(&lying, sizeof(lying), n * sizeof(lying));
    return {bend.x, bend.y, lying.x, lying.y};
}

void TrackPass::clear(int slot, bool bends_only) {
    const auto first = static_cast<std::size_t>(slot) * kCells;
    zero(bends_, first * sizeof(glm::vec4), kCells * sizeof(glm::vec4));
    zero(changes_, first * sizeof(glm::vec4), kCells * sizeof(glm::vec4));
    if (!bends_only) {
        zero(pressed_, first * sizeof(glm::vec2), kCells * sizeof(glm::vec2));
    }
}

std::size_t TrackPass::bytes() const {
    std::size_t sum = 0;
    for (const gl::Buffer* buffer : {&bends_, &changes_, &pressed_, &shown_, &table_, &pages_, &prints_}) {
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
