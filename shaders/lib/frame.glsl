// SPDX-License-Identifier: Apache-2.0
// The frame's constants, for every shader.
#include "shared/bindings.h"
#include "shared/frame.h"

layout(std140, binding = BIND_FRAME) uniform FrameBlock {
    FrameConstants frame;
};
#include "shared/sky.h"
