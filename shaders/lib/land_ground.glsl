// SPDX-License-Identifier: Apache-2.0
// What a landcover's grounds look like, from a centimetre up to ten metres; from afar their mean.
// All noise has the mean 0. Needs lib/ground.glsl.

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

// How one of them looks. One loop over the grounds draws them all: each loop more makes compilers
// of software rasterisers slower than the last.
struct GroundLook {
    vec3 colour;
    float wide; // widest cells of its noise (m)
    int octaves;
    float weight;   // of each over the one before
    float strength; // of the noise
    float stone;    // size of its stones (m)
    float own;      // how far they differ
    float rim;      // how much darker they are at their rims
};

GroundLook look_of(int ground, float tint) {
    if (ground == 0) {
        return GroundLook(vec3(0.064, 0.063, 0.062), 8.0, 7, 0.7, 0.4, 0.0078125, 0.5, 0.5);
    }
    if (ground == 1) {
        return GroundLook(vec3(0.23, 0.215, 0.19), 4.0, 7, 0.75, 0.5, 0.03125, 0.5, 1.0);
    }
    if (ground == 2) {
        return GroundLook(vec3(0.40, 0.32, 0.21), 8.0, 8, 0.75, 0.3, 0.00390625, 0.35, 0.5);
    }
    return GroundLook(frame.rock.rgb * mix(0.85, 1.2, tint), 4.0, 8, 0.75, 0.9, 0.125, 0.08, 0.0);
}

// Octaves of noise from `wide` metres on, as something `width` metres wide shows them.
float noise_from(vec2 xz, GroundLook look, float width, uint salt) {
    ivec2 anchor = ivec2(frame.anchor_x, frame.anchor_z);
    float sum = 0.0;
    float weight = 1.0;
    float size = look.wide;
    for (int i = 0; i < look.octaves; ++i) {
        float share = octave_share(size, width);
        if (share <= 0.0) {
            break;
        }
        sum += weight * share * cell_noise(xz, anchor, size, salt + uint(i));
        size *= 0.5;
        weight *= look.weight;
    }
    return sum;
}

// Stones of about `size` metres: x their own brightness, -1..1; y how far a place is from the
// middle of its stone, less its mean. Mean 0.
vec2 stones_at(vec2 xz, float size, uint salt, float width) {
    float share = octave_share(2.0 * size, width);
    if (share <= 0.0) {
        return vec2(0.0);
    }
    vec2 p = xz / size;
    vec2 base = floor(p);
    ivec2 cell = ivec2(base) + ivec2(frame.anchor_x, frame.anchor_z) * int(kAnchorGrid_m / size);
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
    return share * vec2(own, min(sqrt(nearest), 1.0) - 0.5);
}

// What of a ground's brightness neither noise nor stones are: cracks, of sand ripples.
float ground_marks(int ground, vec2 xz, float width) {
    ivec2 anchor = ivec2(frame.anchor_x, frame.anchor_z);
    if (ground == 1 || octave_share(0.0625, width) <= 0.0) {
        return 0.0;
    }
    if (ground == 2) {
        return 0.35 * octave_share(0.0625, width) *
               stretched_noise(xz, anchor, vec2(0.5, 0.0625), 0x5a20u);
    }
    float way = cell_noise(xz, anchor, ground == 0 ? 2.0 : 0.5, 0xa520u) +
                0.1 * cell_noise(xz, anchor, 0.25, 0xa521u);
    float wide = ground == 0 ? 0.012 : 0.06; // cracks are a ridge's line
    return octave_share(0.125, width) * (ground == 0 ? 0.5 : 0.25) *
           (3.0 * wide - 1.0 + smoothstep(0.0, wide, abs(way)));
}

// Reflectance of the ground where `soil` is that of the class's soil.
vec3 ground_colour(vec3 soil, Grounds grounds, vec2 xz, float tint, float width) {
    vec4 shares = vec4(grounds.asphalt, grounds.gravel, grounds.sand, grounds.rock);
    vec3 colour = soil * max(1.0 - dot(shares, vec4(1.0)) - grounds.water, 0.0);
    for (int ground = 0; ground < 4; ++ground) {
        if (shares[ground] > 0.0) {
            GroundLook look = look_of(ground, tint);
            uint salt = 0xa510u + 0x1000u * uint(ground);
            vec2 stones = stones_at(xz, look.stone, salt + 0x100u, width);
            float value = 1.0 + look.strength * noise_from(xz, look, width, salt) +
                          look.own * stones.x - look.rim * stones.y +
                          ground_marks(ground, xz, width);
            colour += shares[ground] * look.colour * max(value, 0.2);
        }
    }
    return colour / max(1.0 - grounds.water, 1e-3);
}

// Radiance of still water, level whatever the ground is, toward the eye: the sky by Fresnel
// (Schlick, 2 percent), and what its depth gives back.
vec3 water_radiance(vec2 xz, vec3 to_eye, float width) {
    ivec2 anchor = ivec2(frame.anchor_x, frame.anchor_z);
    vec2 slope = vec2(0.0);
    for (int i = 0; i < 5; ++i) {
        float size = 2.0 * exp2(-float(i));
        float share = octave_share(size, width) * (1.0 - 0.12 * float(i));
        slope += share * vec2(cell_noise(xz, anchor, size, 0x3a7au + uint(i)),
                              cell_noise(xz, anchor, size, 0x3b7au + uint(i)));
    }
    vec3 normal = normalize(vec3(0.045 * slope.x, 1.0, 0.045 * slope.y));
    vec3 mirrored = reflect(-to_eye, normal);
    mirrored.y = abs(mirrored.y); // ripples that would mirror the bank
    float grazing = 1.0 - max(dot(normal, to_eye), 0.0);
    float fresnel = 0.02 + 0.98 * grazing * grazing * grazing * grazing * grazing;
    vec3 deep = vec3(0.012, 0.022, 0.018) *
                (frame.light.sun.rgb * max(frame.light.to_sun.y, 0.0) + even_sky(frame.light));
    return mix(deep, sky_radiance(mirrored), fresnel);
}
