// SPDX-License-Identifier: Apache-2.0
#pragma once

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
    /// The whole band as float. Its size must have been checked; throws Error where a block is too
    /// large or broken.
    void read(GDALRasterBandH band, const std::filesystem::path& path, std::vector<float>& values);
    /// The first error since the last call, or `otherwise`.
    [[nodiscard]] std::string error(const char* otherwise);

private:
    std::optional<std::string> error_;
};

} // namespace sward::assets
