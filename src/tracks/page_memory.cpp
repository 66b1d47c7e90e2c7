// SPDX-License-Identifier: Apache-2.0
#include "tracks/page_memory.h"

#include <algorithm>
#include <cstring>

#include <zstd.h>

#include "base/error.h"
#include "shared/track_field.h"

namespace sward::tracks {

namespace {

constexpr int kEffort = 3; // of zstd; a page of tyre tracks goes to some hundredths
constexpr std::size_t kCells = std::size_t{shared::kTrackCells} * shared::kTrackCells;
constexpr std::size_t kBlockCells = std::size_t{shared::kTrackBlock} * shared::kTrackBlock;

template<class T> void append(std::vector<std::byte>& out, const std::vector<T>& items) {
    const auto* bytes = reinterpret_cast<const std::byte*>(items.data());
    out.insert(out.end(), bytes, bytes + items.size() * sizeof(T));
}

template<class T>
void cut(const std::vector<std::byte>& from, std::size_t& at, std::vector<T>& items) {
    std::memcpy(items.data(), from.data() + at, items.size() * sizeof(T));
    at += items.size() * sizeof(T);
}

} // namespace

bool PageMemory::put(PageKey key, const PageContent& content) {
    std::vector<std::byte> plain;
    append(plain, content.pressed);
    append(plain, content.moving);
    append(plain, content.bends);
    append(plain, content.changes);
    Kept kept{{}, ++order_, content.epoch, content.moving.size()};
    kept.packed.resize(ZSTD_compressBound(plain.size()));
    const std::size_t size =
        ZSTD_compress(kept.packed.data(), kept.packed.size(), plain.data(), plain.size(), kEffort);
    if (ZSTD_isError(size)) {
        throw base::Error(base::ExitCode::kFailure,
                          std::string("tracks: cannot compress a page: ") +
                              ZSTD_getErrorName(size));
    }
    kept.packed.resize(size);
    kept.packed.shrink_to_fit();
    bytes_ += size;
    kept_[{key.y, key.x}] = std::move(kept);
    const std::size_t before = lost_;
    while (bytes_ > most_bytes_ && !kept_.empty()) {
        const auto oldest =
            std::min_element(kept_.begin(), kept_.end(), [](const auto& a, const auto& b) {
                return a.second.order < b.second.order;
            });
        bytes_ -= oldest->second.packed.size();
        kept_.erase(oldest);
        ++lost_;
    }
    return lost_ == before;
}

std::optional<PageContent> PageMemory::look(PageKey key) const {
    const auto found = kept_.find({key.y, key.x});
    if (found == kept_.end()) {
        return std::nullopt;
    }
    const Kept& kept = found->second;
    PageContent content;
    content.epoch = kept.epoch;
    content.pressed.resize(kCells);
    content.moving.resize(kept.moving);
    content.bends.resize(kept.moving / 2 * kBlockCells);
    content.changes.resize(content.bends.size());
    std::vector<std::byte> plain(kCells * sizeof(std::uint32_t) +
                                 kept.moving * sizeof(std::int64_t) +
                                 2 * content.bends.size() * sizeof(glm::vec4));
    const std::size_t size =
        ZSTD_decompress(plain.data(), plain.size(), kept.packed.data(), kept.packed.size());
    if (ZSTD_isError(size) || size != plain.size()) {
        throw base::Error(base::ExitCode::kFailure, "tracks: a page's memory is damaged");
    }
    std::size_t at = 0;
    cut(plain, at, content.pressed);
    cut(plain, at, content.moving);
    cut(plain, at, content.bends);
    cut(plain, at, content.changes);
    return content;
}

std::optional<PageContent> PageMemory::take(PageKey key) {
    std::optional<PageContent> content = look(key);
    if (content) {
        const auto found = kept_.find({key.y, key.x});
        bytes_ -= found->second.packed.size();
        kept_.erase(found);
    }
    return content;
}

std::vector<PageKey> PageMemory::keys() const {
    std::vector<PageKey> out;
    for (const auto& [key, unused] : kept_) {
        out.emplace_back(key.second, key.first);
    }
    return out;
}

void PageMemory::clear() {
    kept_.clear();
    bytes_ = 0;
}

} // namespace sward::tracks
