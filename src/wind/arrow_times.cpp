// SPDX-License-Identifier: Apache-2.0
#include "wind/arrow_times.h"

#include <algorithm>
#include <string_view>
#include <unordered_map>

namespace sward::wind {

std::vector<Span> arrow_spans(const std::vector<scene::WindArrow>& arrows) {
    std::unordered_map<std::string_view, std::size_t> index;
    for (std::size_t i = 0; i < arrows.size(); ++i)
        index.emplace(arrows[i].id, i);
    std::vector<Span> spans(arrows.size());
    std::vector<bool> known(arrows.size(), false);
    std::vector<std::size_t>
        chain; // from an arrow up to one that is known: no recursion, chains may be long
    for (std::size_t i = 0; i < arrows.size(); ++i) {
        for (std::size_t at = i; !known[at]; at = index.at(arrows[at].parent)) {
            chain.push_back(at);
            if (arrows[at].parent.empty())
                break;
        }
        for (; !chain.empty(); chain.pop_back()) {
            const scene::WindArrow& arrow = arrows[chain.back()];
            Span& span = spans[chain.back()];
            span = {arrow.start_s, arrow.end_s};
            known[chain.back()] = true;
            if (arrow.parent.empty())
                continue;
            const std::size_t parent = index.at(arrow.parent);
            const double length = glm::distance(arrows[parent].root, arrows[parent].tip);
            const double flight = arrows[parent].strength_mps > 0
                                      ? length / arrows[parent].strength_mps
                                      : scene::kForever;
            span.start_s = std::max(span.start_s, spans[parent].start_s + flight);
            span.end_s = std::min(span.end_s, spans[parent].end_s + flight);
        }
    }
    return spans;
}

} // namespace sward::wind
