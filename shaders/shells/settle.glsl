// SPDX-License-Identifier: Apache-2.0
// Where tracks and a landcover's classes leave a ray that enters the canopy. For march_view.glsl.

// Tracks and classes are finer than the vertices that the canopy's surface was drawn by, which know
// the wind alone and stand as high as the highest class: the ray goes on down to the top of what
// stands where it is, or comes to the side of what stands beside it.
const int kTrackSteps = 4;
const int kLandSteps = 10;
const float kTrackReach = 1.0; // of canopies that a ray comes down while it is stopped: no more of
                               // a long footprint is seen at once
Entry come_down(View view, Entry entry) {
    float canopy = frame.canopy_m;
    float fall = max(dot(entry.ground.xy, view.way.xz) - view.way.y, 0.02);
    vec4 standing = entry.air;
    TrackSeen track = track_nothing();
    int most = has_heights() ? kLandSteps : kTrackSteps;
    float longest = 0.3 * canopy; // no farther at once: something may stand there
    float down = 0.0;
    bool trodden = false;
    vec3 at;
    for (int n = 0; n < most; ++n) {
        at = frame.eye + view.way * min(entry.distance, kFarthest);
        float width = entry.distance / frame.focal_px;
        entry.lying = land_height(at.xz, width);
        if (has_tracks()) {
            track = track_along(at.xz, width,
                                view.way.xz * min(width / fall, kTrackReach * canopy / fall));
            entry.lying *= lying_height(track.lying);
        }
        entry.aligned = 1.0;
        entry.air = standing;
        trodden = dot(track.theta, track.theta) + track.lying >= 1e-3;
        if (!trodden && !has_heights()) {
            return entry;
        }
        if (trodden) {
            vec2 ahead = track_ahead(
                at.xz, width,
                kLeanHeight); // the canopy has one bend: that of the height which stands for it
            if (dot(ahead, ahead) > 0.0) {
                track.theta = track_at(at.xz + ahead, width).theta;
            }
            Sway here = sway_of(standing.xy, track);
            entry.air.xy = here.wind;
            entry.aligned = here.aligned;
        }
        float over =
            entry.height -
            entry.lying *
                (canopy + bend_offset(canopy, canopy, entry.air.xy, frame.wind.response).y);
        bool past = has_heights() && over < -0.1 * canopy &&
                    down > 0.1 * canopy; // in the side of something: back by half
        if ((over < 0.02 * canopy && !past) || n == most - 1) {
            break;
        }
        longest = past ? 0.5 * down : longest;
        down = min(abs(over), longest);
        entry.height -= past ? -down : down;
        entry.distance += (past ? -down : down) / fall;
    }
    if (trodden) {
        entry.air.zw = sway_over(at - vec3(0.0, entry.height, 0.0), standing.xy, track).xy;
    }
    if (has_heights()) {
        entry.ground.z = mask_density(at.xz, entry.distance / frame.focal_px) * frame.density_scale;
    }
    return entry;
}

// An entry as it is marched from. The one call of come_down(), by far the longest function here:
// compilers write every call out.
Entry settled(View view, Entry entry) {
    if (entry.comes_down && entry.distance < kNever) {
        return come_down(view, entry);
    }
    return entry;
}
