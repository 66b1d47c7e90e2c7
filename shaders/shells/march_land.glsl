// SPDX-License-Identifier: Apache-2.0
// Where classes of a landcover meet: the grass that a path passes, which is not that of its entry
// alone. For march_view.glsl.

// Greatest density of the grass that a ray passes: a border may lie on its way. The march's steps
// know what stands at each.
float densest(View view, Entry entry, MarchPath path) {
#ifdef SURFACE
    return entry.ground.z;
#else
    if (!has_land()) {
        return entry.ground.z;
    }
    const int kProbes = 4;
    float width = entry.distance / frame.focal_px;
    float reach = min(ground_reach(path), path.height.w);
    float most = 0.0;
    for (int i = 0; i < kProbes; ++i) {
        vec2 xz =
            frame.eye.xz + view.way.xz * (entry.distance + reach * float(i) / float(kProbes - 1));
        most = max(most, mask_density(xz, width));
    }
    return most * frame.density_scale;
#endif
}

// 1 where any grass stands on the path.
float bears_any(Entry entry, MarchPlan plan) {
#ifndef SURFACE
    if (has_land()) {
        return step(0.0021, plan.density);
    }
#endif
    return step(0.0021, entry.ground.z);
}

// Share of the plan's density that stands at a place of the path, at rest.
float land_share(Entry entry, MarchPlan plan, vec3 rest) {
#ifndef SURFACE
    if (has_land()) {
        float share = mask_density(rest.xz, plan.footprint) * frame.density_scale / plan.density;
        bool over_it =
            has_heights() &&
            rest.y * entry.lying > 1.02 * frame.canopy_m * land_height(rest.xz, plan.footprint);
        return over_it ? 0.0 : share;
    }
#endif
    return 1.0;
}

// Mean tangent of blades that are drawn out or pressed by the entry's factor: as if all leaned as
// far as the mean is upright.
vec3 land_tangent(Entry entry, vec3 mean) {
#ifndef SURFACE
    if (has_heights()) {
        float height = entry.lying;
        return vec3(mean.x, height * mean.y, mean.z) *
               inversesqrt(max(1.0 - mean.y * mean.y * (1.0 - height * height), 1e-4));
    }
#endif
    return mean;
}
