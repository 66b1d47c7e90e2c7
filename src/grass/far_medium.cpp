// SPDX-License-Identifier: Apache-2.0
#include "grass/far_medium.h"

#include <cstring>

#include <fmt/format.h>

#include "base/error.h"

namespace sward::grass {

TextureArray encode_correction(const FarMedium& march) {
    TextureArray array{shared::kMarchElevations, shared::kMarchMips, static_cast<int>(kMarchDensities.size()), {}, TexelFormat::kRgba32f};
    array.mips.emplace_back(march.correction.size() * sizeof(float));
    std::memcpy(array.mips[0].data(), march.correction.data(), array.mips[0].size());
    return array;
}

void decode_correction(const TextureArray& array, const std::filesystem::path& name, FarMedium& march) {
    if (array.width != shared::kMarchElevations || array.height != shared::kMarchMips)
        throw base::input_error(base::ExitCode::kBadInput, name, 0, "size", fmt::format("{} x {}", array.width, array.height),
                                fmt::format("{} x {}", shared::kMarchElevations, shared::kMarchMips));
    march.correction.resize(kMarchCorrections);
    std::memcpy(march.correction.data(), array.mips[0].data(), kMarchCorrections * sizeof(float));
    for (const float factor : march.correction)
        if (!(factor >= 0 && factor <= 100))
            throw base::input_error(base::ExitCode::kBadInput, name, 0, "factor", std::to_string(factor), "0 to 100");
}

} // namespace sward::grass
