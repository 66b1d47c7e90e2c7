// SPDX-License-Identifier: Apache-2.0
// How the rays of a pixel go on over crests: from one stretch through the canopy to the next, of
// all its samples or of some. Before: `ndc`, the pixel's place on the screen.
#include "shells/crest.glsl"

const float kHorizon = 50000.0; // nobody sees grass beyond (m)
const float kBeside =
    1e-3; // of the distance: what is drawn of the ground may be so far from it (m a metre)
const float kSkims = 0.8;    // of the canopy: a ray that has left it and is lower is still within
const float kSkimFall = 0.1; // m a metre: how such a ray goes on
const float kEndFall = 0.5;  // and one that comes to the ground that is drawn behind
const float kAsGround = 0.0, kAsDrawn = -1.0; // in place of a fall: see entry_on()

// Beyond a crest: where the ray comes down into a canopy of this height again, before `last`; else
// kNever.
float next_entry(View view, float from, float last, float canopy) {
    const int kProbes = 20, kHalvings = 8;
    float low = from, high = kNever;
    float ratio = pow(max(last / from, 1.0001), 1.0 / float(kProbes));
    int halvings = 0;
    for (int i = 0; i < kProbes + kHalvings && halvings < kHalvings; ++i) {
        bool found = high < kNever;
        if (!found && i >= kProbes) {
            break;
        }
        halvings += found ? 1 : 0;
        float t = found ? 0.5 * (low + high) : low * ratio;
        vec3 at = frame.eye + view.way * t;
        bool under = at.y - ground_at(at.xz) < canopy;
        low = under ? low : t;
        high = under ? t : high;
    }
    return high;
}

// Is the ground that is drawn at `last` along the ray what the ray itself comes to there? It is
// drawn a little beside where it is looked up, and other samples of the pixel may see it than the
// ray's.
bool on_drawn_ground(View view, float last, float height) {
    vec3 at = frame.eye + view.way * last;
    return last < kHorizon &&
           at.y - ground_at(at.xz) < height + (kBeside + 1.0 / frame.focal_px) * last;
}

// A ray of some of the pixel's samples.
struct Ray {
    View view;
    Entry entry;
    vec4 members; // 1: these samples
    bool fresh;   // to be found: of samples that have not entered yet, and of `members`
};

// Where the ray goes on after a stretch; distance kNever: nowhere. `scene`: distance to what stands
// behind. `fall`: as entry_on() has it.
Entry entry_after(Ray ray, MarchPath path, MarchWalk walk, float scene, out float fall) {
    View view = ray.view;
    Entry entry = ray.entry;
    Entry next = entry;
    bool over_it = walk.layer >= kMarchLayers;
    fall = kAsDrawn;
    if (over_it &&
        eye_place.x > 0.5) { // from within: what is drawn from above is where it comes down first
        Entry drawn = entry_from_above(view, ivec2(gl_FragCoord.xy));
        if (drawn.distance > entry.distance + walk.s) {
            return drawn;
        }
    }
    fall = kAsGround;
    next.height = over_it ? path.bend.w * highest()
                          : march_height(path, walk.s) * (has_heights() ? entry.lying : 1.0);
    next.distance = walk.layer < 0 ? kNever : entry.distance + walk.s;
    next.comes_down = has_heights();
    if (over_it) {
        float last = min(scene, kHorizon);
        float from = next.distance + 0.1;
        vec3 here = frame.eye + view.way * from;
        float top = path.bend.w * land_height(here.xz, from / frame.focal_px);
        if (here.y - ground_at(here.xz) < kSkims * top) {
            next.distance = from;
            fall = kSkimFall;
            return next;
        }
        bool ends_soon = last < from * (1.0 + kSameShare);
        next.distance = ends_soon ? kNever : next_entry(view, from, last, next.height);
        if (next.distance >= kNever && on_drawn_ground(view, last, next.height)) {
            next.distance = max(last - 2.0 * next.height, from);
            fall = kEndFall;
        }
    }
    return next;
}

// The entry with the ground that is under it: as that lies, or so that the ray comes down through
// the grass by `fall` for a metre.
Entry entry_on(View view, Entry entry, float fall) {
    if (fall == kAsDrawn) {
        return entry;
    }
    entry.ground = ground_under(frame.eye.xz + view.way.xz * min(entry.distance, kHorizon));
    if (fall > 0.0) {
        entry.comes_down = false;
        entry.ground.xy =
            view.way.xz * ((view.way.y + fall) / max(dot(view.way.xz, view.way.xz), 1e-4));
    }
    return entry;
}

// The ray of those samples that enter the canopy nearest; what came through before goes on to the
// same place.
Ray nearest_ray(ivec2 pixel, vec4 came_through, vec4 entries) {
    View view = view_of(pixel, ndc);
    Ray ray = Ray(view, entry_at(view, nearest_of(entries)), vec4(1.0), false);
    ray.members = members_of(view, entries, ray.entry.ground.xy);
    ray.view = view_through(pixel, ray.members, ndc);
    ray.entry.distance = dot(ray.members, vec4(1.0)) /
                         dot(ray.members, 1.0 / entries); // of a plane that is the middle's
    ray.members = max(ray.members, came_through);
    return ray;
}

// Samples of a ray that left the canopy over a crest whose own ends lie on the crest itself: far
// away a pixel is higher than the grass there, and what its middle passes over its lower samples
// meet.
vec4 ends_at_crest(Ray ray, float from, float height, vec4 scene) {
    vec4 ends = vec4(0.0);
    for (int i = 0; i < 4 && eye_place.x < 0.5; ++i) {
        bool soon = ray.members[i] > 0.0 && scene[i] < from * kMaybeValley;
        ends[i] = soon && on_drawn_ground(ray.view, scene[i], height) ? 1.0 : 0.0;
    }
    return ends;
}

// The ray to march after `ray`: of samples that have not entered yet (`entries`), else of the same
// through what comes behind.
Ray ray_after(Ray ray, MarchPath path, MarchWalk walk, vec4 scene, inout vec4 entries) {
    vec4 behind = mix(vec4(0.0), scene, ray.members);
    float fall = kEndFall;
    vec4 soon = vec4(0.0);
    if (walk.layer >= kMarchLayers) {
        float from = ray.entry.distance + walk.s + 0.1;
        soon = ends_at_crest(ray, from, path.bend.w * highest(), scene);
        if (dot(soon, vec4(1.0)) > 0.0) { // these, then the rest from here on
            bvec4 rest = greaterThan(ray.members - soon, vec4(0.5)); // kNever is too large to blend
            entries = mix(entries, vec4(from), rest);
            ray.members = soon;
            ray.entry.height = path.bend.w * highest();
            float first = nearest_of(mix(vec4(kNever), scene, greaterThan(soon, vec4(0.5))));
            ray.entry.distance = first - 2.0 * ray.entry.height;
        }
    }
    if (dot(soon, vec4(1.0)) <= 0.0) {
        if (nearest_of(entries) < kNever) {
            ray.fresh = true;
            ray.members = walk.layer < 0 ? vec4(0.0) : ray.members;
            return ray;
        }
        ray.entry = entry_after(ray, path, walk,
                                max(max(behind.x, behind.y), max(behind.z, behind.w)), fall);
    }
    ray.entry = entry_on(ray.view, ray.entry, fall);
    return ray;
}
