// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace sward::blades {

/// Which tests of J7 run. Each costs a little for every blade in reach and saves the drawing of
/// those that it takes.
struct CullTests {
    bool frustum = true;
    /// Blades that turn their edge to the eye. Off where grass sets are drawn: a tenth of what they
    /// cover would go with them, which the far tier keeps showing.
    bool orientation = false;
    bool distance = true;  ///< of blades on meshes, which have no far tier; those that stay widen
    bool occlusion = true; ///< by the opaque scene
    /// Of the reference on elevation: blades that no sample of a picture falls on. It runs this
    /// test and the frustum's, whatever the others say, and occlusion by what has been drawn.
    bool samples = true;
};

} // namespace sward::blades
