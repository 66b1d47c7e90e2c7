// SPDX-License-Identifier: Apache-2.0
// What the AOV `tier` says.
const float kTierGround = 0.0;
const float kTierSimulatedBlade = 1.0;
const float kTierGroupedBlade = 2.0;
const float kTierShell = 3.0;
const float kTierSliceX = 4.0;
const float kTierSliceZ = 5.0;
const float kTierObject = 6.0;
const float kTierSky = 7.0;
