// SPDX-License-Identifier: Apache-2.0
#include "tracks/track_twin.h"

#include "shared/track_seen.h"

namespace sward::tracks {

void TrackTwin::step(const shared::TrackRules& rules, std::span<const shared::TrackPrint> prints,
                     glm::vec2 slope) {
    constexpr int kSide = shared::kTrackCells;
    std::vector<glm::vec4> changes(kCount);
    for (int z = 0; z < kSide; ++z) {
        for (int x = 0; x < kSide; ++x) {
            const auto beside = [&](int dx, int dz) {
                const int bx = x + dx, bz = z + dz;
                const shared::TrackCell& cell = bx < 0 || bz < 0 || bx >= kSide || bz >= kSide
                                                    ? at(x, z)
                                                    : at(bx, bz); // nothing beyond: as here
                return glm::vec4(cell.theta, cell.omega);
            };
            changes[static_cast<std::size_t>(z * kSide + x)] = shared::track_change(
                rules, at(x, z), beside(-1, 0), beside(1, 0), beside(0, -1), beside(0, 1));
        }
    }
    for (int z = 0; z < kSide; ++z) {
        for (int x = 0; x < kSide; ++x) {
            const auto n = static_cast<std::size_t>(z * kSide + x);
            shared::TrackCell next = shared::track_advance(cells[n], changes[n]);
            const glm::vec2 middle = rules.cell_m * (glm::vec2(x, z) + 0.5f);
            bool touched = false;
            for (const shared::TrackPrint& print : prints) {
                const shared::TrackContact contact = shared::track_contact(rules, print, middle);
                if (contact.touched == 1) {
                    touched = true;
                    next = shared::track_bent(rules, next, contact, slope);
                    pressed[n] = shared::track_pressed(rules, pressed[n], contact, print.load);
                }
            }
            if (touched) { // kept in a word
                pressed[n] = shared::track_unpack(shared::track_pack(pressed[n]));
            }
            cells[n] = next;
        }
    }
}

} // namespace sward::tracks
