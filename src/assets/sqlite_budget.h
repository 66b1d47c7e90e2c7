// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace sward::assets {

/// Bounds what SQLite does for this thread while one stands. A GeoPackage is a database: what it
/// calls a table may be a view that counts for ever, and GDAL waits for it. Counts for connections
/// that are opened meanwhile; a query past the bound fails as interrupted.
class SqliteBudget {
public:
    SqliteBudget();
    ~SqliteBudget();
    SqliteBudget(const SqliteBudget&) = delete;
    SqliteBudget& operator=(const SqliteBudget&) = delete;

    [[nodiscard]] bool spent() const;
};

} // namespace sward::assets
