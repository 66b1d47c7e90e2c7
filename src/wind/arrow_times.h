// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "scene/scene.h"

namespace sward::wind {

struct Span {
    double start_s = 0;
    double end_s = 0; ///< may be infinite
};

/// When each arrow pushes (methods.md W5): a tree starts at its root, and a child when the gust
/// could have flown its parent's length at its parent's strength; it ends when the parent's last
/// air has passed likewise. An arrow's own start_s and end_s narrow that. A parent without strength
/// sends nothing on: its children's start is infinite. Every parent is there, and chains end (the
/// scene reader and the editor see to it).
[[nodiscard]] std::vector<Span> arrow_spans(const std::vector<scene::WindArrow>& arrows);

} // namespace sward::wind
