// SPDX-License-Identifier: Apache-2.0
// What the tests of grass sets share.
#pragma once

#include <string>
#include <utility>

#include "base/error.h"
#include "base/log.h"
#include "texgen/bake/writer.h"
#include "texgen/patch/patch.h"
#include "texgen/preset/preset.h"

namespace sward::texgen {

inline Preset small_meadow() {
    Preset preset;
    preset.name = "small";
    preset.density_per_m2 = 300;
    preset.species.front().width_m = {0.004, 0.007};
    preset.variants = 3;
    preset.size = 256;
    preset.layers = 8;
    preset.slices = 8;
    preset.levels = 3;
    preset.far_rays = 1024; // where the table itself is not the question
    return preset;
}

inline const grass::GrassSet& small_set() {
    static const grass::GrassSet set = [] {
        base::set_verbosity(base::Verbosity::kQuiet);
        Preset preset = small_meadow();
        preset.far_rays = kFarRays;
        return bake_set(preset, {.threads = 2, .volume = false, .preview = false});
    }();
    return set;
}

inline Patch small_patch() {
    return generate_patch(small_meadow(), 2);
}

/// Runs `act` and returns the error's code and text.
template<typename Act> std::pair<base::ExitCode, std::string> error_of(const Act& act) {
    try {
        act();
    } catch (const base::Error& error) {
        return {error.code(), error.what()};
    }
    return {base::ExitCode::kDone, "no error"};
}

} // namespace sward::texgen
