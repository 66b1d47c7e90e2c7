// SPDX-License-Identifier: Apache-2.0
// In: chunks of tiles' blades, the samples of a round of jittered pictures. Out: for each blade the
// pictures in which a sample may fall on it, and the counts. What is left out shows in none of
// their samples. A blade much thinner than a pixel falls between the samples of nearly all
// pictures; and one pose of it serves them all.
#include "lib/blade_samples.glsl"

layout(local_size_x = CULL_GROUP) in;
layout(std430, binding = BIND_CHOICE_ITEMS) readonly buffer ChoiceItems {
    uvec2 items[];
};
layout(std430, binding = BIND_CHOICE_MASKS) writeonly buffer ChoiceMasks {
    uint masks[];
};
layout(std430, binding = BIND_CHOICE_TOTAL) buffer ChoiceTotals {
    uint totals[CULL_COUNTS];
};
uniform int first_item; // of this dispatch
uniform int first_mask; // item whose masks lie first

shared uint lane_masks[CULL_GROUP];
shared uint counts[CULL_COUNTS];

const uint kGone = 0xffffffffu; // the blade does not stand here
const uint kOutside = 0xfffffffeu;

bool outside(vec3 root, float reach) {
    vec4 clip = frame.clip_from_world * vec4(root, 1.0);
    vec2 slack =
        reach * (1.0 + vec2(length(vec3(frame.clip_from_world[0].x, frame.clip_from_world[1].x,
                                        frame.clip_from_world[2].x)),
                            length(vec3(frame.clip_from_world[0].y, frame.clip_from_world[1].y,
                                        frame.clip_from_world[2].y))));
    vec2 jitter = 2.0 / vec2(frame.picture_px); // a pixel: pictures of a round lie less apart
    return clip.w < -reach || any(greaterThan(abs(clip.xy), clip.ww * (1.0 + jitter) + slack));
}

uint choose(uvec2 item, uint index) {
    BladeRecord blade = tile_blade(item.x, index);
    vec3 root = blade_root(item.x, blade);
    if (!handover_may_be_near(blade.root.z, distance(root, frame.lod_eye), frame.handover_band,
                              frame.handover_mode) ||
        blade.root.w >= ground_surface(root.xz).density) {
        return kGone;
    }
    if (outside(root, blade.shape.y * highest())) {
        return kOutside;
    }
    return pictures_with(blade, blade_pose(uvec2(item.x, index), blade));
}

void count(uint test, int pictures) {
    if (pictures > 0) {
        atomicAdd(counts[test], uint(pictures));
    }
}

void main() {
    uint group = gl_WorkGroupID.x + uint(first_item);
    uint lane = gl_LocalInvocationID.x;
    if (lane < uint(CULL_COUNTS)) {
        counts[lane] = 0u;
    }
    barrier();
    uvec2 item = items[group];
    uint index = item.y + lane;
    uint found = 0u;
    if (index < tiles[item.x].end) {
        found = choose(item, index);
        int pictures = round.counts.x;
        if (found == kGone || found == kOutside) {
            count(found == kGone ? uint(CULL_LEFT) : uint(CULL_FRUSTUM), pictures);
            found = 0u;
        } else {
            count(uint(CULL_KEPT), bitCount(found));
            count(uint(CULL_SAMPLES), pictures - bitCount(found));
        }
    }
    lane_masks[lane] = found;
    barrier();
    if (lane % 2u == 0u) {
        masks[((group - uint(first_mask)) * uint(CULL_GROUP) + lane) / 2u] =
            lane_masks[lane] | lane_masks[lane + 1u] << 16;
    }
    if (lane < uint(CULL_COUNTS) && counts[lane] > 0u) {
        atomicAdd(totals[lane], counts[lane]);
    }
}
