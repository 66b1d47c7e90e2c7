// SPDX-License-Identifier: Apache-2.0
// What a landcover's grounds look like, from a centimetre up to ten metres; from afar their mean. All noise has the mean 0.
// Needs lib/ground.glsl.

// Shares of what lies here, sharp near the eye; what is left is soil.
struct Grounds {
    float water, asphalt, gravel, sand, rock;
};

Grounds grounds_at(vec2 xz, float width) {
    vec2 uv = mask_uv(xz);
    if (!has_land() || off_mask(uv)) {
        return Grounds(0.0, 0.0, 0.0, 0.0, 0.0);
    }
    vec4 cover = textureLod(land_cover, uv, land_lod(width));
    vec4 ground = textureLod(land_ground, uv, land_lod(width));
    float all = cover.b + cover.a + ground.r + ground.g + ground.b;
    if (all <= kAllOrNone) {
        return Grounds(0.0, 0.0, 0.0, 0.0, 0.0);
    }
    // One after the other as far as the shares add up: of each what lies before the edge's level.
    LandEdge edge = land_edge(xz, width);
    float a = beyond_edge(cover.b, edge);
    float b = beyond_edge(cover.b + cover.a, edge);
    float c = beyond_edge(cover.b + cover.a + ground.r, edge);
    float d = beyond_edge(cover.b + cover.a + ground.r + ground.g, edge);
    return Grounds(a, b - a, c - b, d - c, beyond_edge(all, edge) - d);
}

// Octaves of noise. `shape`: size of the widest cells (m), octaves, weight of each over the one before, width of what is seen (m).
float noise_from(vec2 xz, vec4 shape, uint salt) {
    ivec2 anchor = ivec2(frame.anchor_x, frame.anchor_z);
    float sum = 0.0;
    float weight = 1.0;
    float size = shape.x;
    for (int i = 0; i < int(shape.y); ++i) {
        float share = octave_share(size, shape.w);
        if (share <= 0.0) {
            break;
        }
        sum += weight * share * cell_noise(xz, anchor, size, salt + uint(i));
        size *= 0.5;
        weight *= shape.z;
    }
    return sum;
}

// Stones of about `size` metres: x their own brightness, -1..1; y how far a place is from the middle of its stone, 0..1. Mean (0, 0.5).
vec2 stones_at(vec2 xz, ivec2 anchor, float size, uint salt, float width) {
    float share = octave_share(2.0 * size, width);
    if (share <= 0.0) {
        return vec2(0.0, 0.5);
    }
    vec2 p = xz / size;
    vec2 base = floor(p);
    ivec2 cell = ivec2(base) + anchor * int(kAnchorGrid_m / size);
    float nearest = 9.0;
    float own = 0.0;
    for (int i = 0; i < 9; ++i) {
        ivec2 aside = ivec2(i % 3 - 1, i / 3 - 1);
        uint h = hash_ivec2(cell + aside, salt);
        vec2 middle = vec2(float(h & 255u), float((h >> 8u) & 255u)) / 255.0;
        vec2 way = base + vec2(aside) + middle - p;
        float apart = dot(way, way);
        if (apart < nearest) {
            nearest = apart;
            own = float(h >> 16u) / 32767.5 - 1.0;
        }
    }
    return share * vec2(own, min(sqrt(nearest), 1.0) - 0.5) + vec2(0.0, 0.5);
}

vec3 rock_colour(vec2 xz, ivec2 anchor, float tint, float width) {
    float slabs = noise_from(xz, vec4(4.0, 8.0, 0.75, width), 0x30c4u);
    float cracks = octave_share(0.5, width) * (0.22 - smoothstep(0.0, 0.06, abs(cell_noise(xz, anchor, 0.5, 0x30d4u))) * 0.25);
    float lichen = noise_from(xz, vec4(0.5, 5.0, 0.8, width), 0x30e4u);
    vec3 colour = frame.rock.rgb * mix(0.85, 1.2, tint) * max(1.0 + 0.9 * slabs - cracks, 0.25);
    return mix(colour, colour * vec3(1.05, 1.15, 0.85), clamp(0.3 + 1.5 * lichen, 0.0, 1.0));
}

vec3 sand_colour(vec2 xz, ivec2 anchor, float width) {
    float waves = noise_from(xz + 0.15 * vec2(cell_noise(xz, anchor, 2.0, 0x5a01u)), vec4(8.0, 3.0, 0.8, width), 0x5a10u);
    float ripples = octave_share(0.0625, width) * stretched_noise(xz, anchor, vec2(0.5, 0.0625), 0x5a20u);
    float grains = noise_from(xz, vec4(0.015625, 3.0, 1.0, width), 0x5a30u);
    return vec3(0.40, 0.32, 0.21) * max(1.0 + 0.25 * waves + 0.35 * ripples + 0.5 * grains, 0.3);
}

vec3 gravel_colour(vec2 xz, ivec2 anchor, float width) {
    vec2 large = stones_at(xz, anchor, 0.03125, 0x9a01u, width);
    vec2 small = stones_at(xz, anchor, 0.0078125, 0x9a02u, width);
    float worn = noise_from(xz, vec4(4.0, 6.0, 0.75, width), 0x9a10u);
    float value = 1.0 + 0.45 * large.x - 0.9 * (large.y - 0.5) + 0.25 * small.x - 0.4 * (small.y - 0.5) + 0.45 * worn;
    return vec3(0.23, 0.215, 0.19) * (vec3(1.0) + 0.06 * large.x * vec3(1.0, 0.2, -1.0)) * max(value, 0.15);
}

vec3 asphalt_colour(vec2 xz, ivec2 anchor, float width) {
    vec2 chips = stones_at(xz, anchor, 0.0078125, 0xa501u, width);
    float worn = noise_from(xz, vec4(8.0, 7.0, 0.7, width), 0xa510u);
    float crack = octave_share(0.125, width) * (0.05 - (1.0 - smoothstep(0.0, 0.012, abs(cell_noise(xz, anchor, 2.0, 0xa520u) + 0.1 * cell_noise(xz, anchor, 0.25, 0xa521u)))));
    return vec3(0.064, 0.063, 0.062) * max(1.0 + 0.5 * chips.x - 0.5 * (chips.y - 0.5) + 0.4 * worn + 0.5 * crack, 0.2);
}

// Reflectance of the ground where `soil` is that of the class's soil.
vec3 ground_colour(vec3 soil, Grounds grounds, vec2 xz, float tint, float width) {
    ivec2 anchor = ivec2(frame.anchor_x, frame.anchor_z);
    float hard = grounds.asphalt + grounds.gravel + grounds.sand + grounds.rock;
    vec3 colour = soil * max(1.0 - hard - grounds.water, 0.0);
    colour += grounds.asphalt > 0.0 ? grounds.asphalt * asphalt_colour(xz, anchor, width) : vec3(0.0);
    colour += grounds.gravel > 0.0 ? grounds.gravel * gravel_colour(xz, anchor, width) : vec3(0.0);
    colour += grounds.sand > 0.0 ? grounds.sand * sand_colour(xz, anchor, width) : vec3(0.0);
    colour += grounds.rock > 0.0 ? grounds.rock * rock_colour(xz, anchor, tint, width) : vec3(0.0);
    return colour / max(1.0 - grounds.water, 1e-3);
}

// Radiance of still water, level whatever the ground is, toward the eye: the sky by Fresnel (Schlick, 2 percent), and what its depth gives back.
vec3 water_radiance(vec2 xz, vec3 to_eye, float width) {
    ivec2 anchor = ivec2(frame.anchor_x, frame.anchor_z);
    vec2 slope = vec2(noise_from(xz, vec4(2.0, 5.0, 0.8, width), 0x3a7au), noise_from(xz, vec4(2.0, 5.0, 0.8, width), 0x3b7au));
    vec3 normal = normalize(vec3(0.045 * slope.x, 1.0, 0.045 * slope.y));
    vec3 mirrored = reflect(-to_eye, normal);
    mirrored.y = abs(mirrored.y); // ripples that would mirror the bank
    float grazing = 1.0 - max(dot(normal, to_eye), 0.0);
    float fresnel = 0.02 + 0.98 * grazing * grazing * grazing * grazing * grazing;
    vec3 deep = vec3(0.012, 0.022, 0.018) * (frame.light.sun.rgb * max(frame.light.to_sun.y, 0.0) + even_sky(frame.light));
    return mix(deep, sky_radiance(mirrored), fresnel);
}
