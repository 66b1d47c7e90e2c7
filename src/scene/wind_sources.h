// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "scene/scene.h"
#include "scene/toml_reader.h"

namespace sward::scene {

/// One [[wind.source]]; a key that its kind has no use for is refused like any unknown one.
[[nodiscard]] WindSource read_source(TableReader& table, const std::map<std::string, Path>& paths);

/// start_s and end_s of an arrow or source; check_span() once the table is known to be whole.
void read_span(TableReader& table, double& start_s, double& end_s);
void check_span(const TableReader& table, double start_s, double end_s);

} // namespace sward::scene
