// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Every pass's name, once: for its timer, its debug group and its row of the statistics. In the
/// order of a frame (frame.cpp).
namespace sward::render::pass_names {

// The passes of FieldState::simulate, "wind" and "physics", are named where they run:
// blades/simulation.cpp.
inline constexpr const char* kWind = "wind";
inline constexpr const char* kTracks = "tracks";
inline constexpr const char* kClipmap = "clipmap";
inline constexpr const char* kLandShadow = "land shadow";
inline constexpr const char* kFarAppearance = "far appearance";
inline constexpr const char* kSelectBlocks = "select blocks";
inline constexpr const char* kSelectFar = "select far";
inline constexpr const char* kBlockSamples = "block samples";
inline constexpr const char* kHostScene = "host scene";
inline constexpr const char* kObjects = "objects";
inline constexpr const char* kSurface = "surface";
inline constexpr const char* kTerrain = "terrain";
inline constexpr const char* kDepthPyramid = "depth pyramid";
inline constexpr const char* kSelectBlades = "select blades";
inline constexpr const char* kChooseBlades = "choose blades";
inline constexpr const char* kGatherBlades = "gather blades";
inline constexpr const char* kSiftBlades = "sift blades";
inline constexpr const char* kCullBlades = "cull blades";
inline constexpr const char* kDrawBlades = "draw blades";
inline constexpr const char* kShells = "shells";
inline constexpr const char* kSlices = "slices";
inline constexpr const char* kSky = "sky";
inline constexpr const char* kResolve = "resolve";
inline constexpr const char* kFarLight = "far light";
inline constexpr const char* kCanopy = "canopy";
inline constexpr const char* kFarField = "far field";
inline constexpr const char* kToneMap = "tone map";
inline constexpr const char* kHandOut = "hand out";

} // namespace sward::render::pass_names
