// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <gdal.h>

namespace sward::assets {

struct CloseDataset {
    void operator()(void* dataset) const { GDALClose(dataset); }
};
using Dataset = std::unique_ptr<void, CloseDataset>;

/// GDAL as we want it while one stands: silent, without side files, without a network. Its settings
/// are of this thread. GDAL opens local paths only, and only with the drivers it is told.
class GdalScope {
public:
    GdalScope();
    ~GdalScope();
    GdalScope(const GdalScope&) = delete;
    GdalScope& operator=(const GdalScope&) = delete;

    /// Null where no driver of the list (ended by a null) knows the file.
    [[nodiscard]] Dataset open(const std::filesystem::path& path, const char* const* drivers);
    /// The same of a file of areas and lines.
    [[nodiscard]] Dataset open_features(const std::filesystem::path& path,
                                        const char* const* drivers);
    /// The whole band as float. Its size must have been checked; throws Error where a block is too
    /// large or broken.
    void read(GDALRasterBandH band, const std::filesystem::path& path, std::vector<float>& values);
    /// 0 where a pixel of the band has no value: its nodata number, a mask inside the file, or an
    /// alpha of 0. Empty where every pixel has one. `values` as `read` gave them.
    [[nodiscard]] std::vector<std::uint8_t> read_valid(GDALRasterBandH band,
                                                       const std::filesystem::path& path,
                                                       const std::vector<float>& values);
    /// The first error since the last call, or `otherwise`. Throws where memory or handles ran out:
    /// then that is the reason.
    [[nodiscard]] std::string error(const char* otherwise);

private:
    std::optional<std::string> error_;
    std::string opened_; ///< the path that GDAL was given last, which its messages begin with
};

/// Band `number` of a raster, from 1; 0: the first, with a warning where others beside it are no
/// alpha (`what` it is then). Throws kBadInput where there is none, kOverLimit for a picture of
/// more than four.
[[nodiscard]] GDALRasterBandH choose_band(GDALDatasetH dataset, const std::filesystem::path& path,
                                          int number, const char* what);

/// Does a band hold signed bytes? The GDAL that has no type for them says so beside, and reads them
/// as unsigned.
[[nodiscard]] bool is_signed_byte(GDALRasterBandH band);
/// The type of a band's pixels, for messages.
[[nodiscard]] const char* type_name(GDALRasterBandH band);

/// Largest value that a band of unsigned integers of up to 16 bits can hold, by the bits that it
/// says it uses (1 to 16); 0 for every other type.
[[nodiscard]] double full_scale_of(GDALRasterBandH band);

} // namespace sward::assets
