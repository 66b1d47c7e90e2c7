// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "app/options.h"
#include "base/error.h"

namespace sward::app {

/// What main() returns when the trouble has been told already: by texgen, in its own words.
struct AlreadyReported {
    int code;
};

/// One picture, or a numbered sequence, without a window. Throws Error.
void run_render(const Options& options);
/// The wind's local window as pictures of numbers. Throws Error.
void run_wind(const Options& options);
/// Figures of this machine: times, and what the project promises of them. Throws Error(kFailure)
/// when one misses its limit.
void run_bench(const Options& options);
/// The viewer. Throws Error; kNoGpu where there is no display. The core build has none and says so.
void run_view(const Options& options);
/// Renderer, limits, versions and paths on stdout; a machine without a GPU is a fact to print, not
/// an error. With a scene: what its terrain is, and where. Throws Error.
void run_info(const Options& options);

/// Throws Error(kIo) unless everything written to stdout has arrived.
void flush_results();

} // namespace sward::app
