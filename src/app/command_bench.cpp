// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <chrono>

#include <epoxy/gl.h>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "app/bench.h"
#include "app/commands.h"
#include "app/output_names.h"
#include "base/file.h"
#include "base/log.h"
#include "gl/context.h"

namespace sward::app {

Spread spread_of(std::vector<double> samples) {
    std::sort(samples.begin(), samples.end());
    return samples.empty() ? Spread{}
                           : Spread{samples.front(), samples[samples.size() / 2], samples.back()};
}

TimedFrame timed_frame(render::Renderer& renderer, const render::Moment& view,
                       const render::FrameSettings& settings) {
    glFinish();
    const auto start = std::chrono::steady_clock::now();
    renderer.draw(view, settings);
    glFinish();
    const std::chrono::duration<double, std::milli> passed =
        std::chrono::steady_clock::now() - start;
    TimedFrame frame{{{"frame", passed.count()}}, renderer.stats()};
    for (const render::PassTime& pass : frame.stats.passes)
        frame.ms[pass.name] += pass.cpu_ms;
    return frame;
}

void run_bench(const Options& options) {
    if (!options.bench_json.empty())
        require_place(options.bench_json);
    const gl::HeadlessContext context;
    BenchReport report;
    const auto asked = [&](const char* suite) {
        return options.bench_suite == "all" || options.bench_suite == suite;
    };
    if (asked("wind"))
        bench_wind(report);
    if (asked("tracks"))
        bench_tracks(report);
    if (asked("near"))
        bench_near(report, options);
    if (asked("far"))
        bench_far(report, options);

    using Json = nlohmann::ordered_json;
    Json rows = Json::array(), figures = Json::array(), checks = Json::array();
    for (const BenchRow& row : report.rows) {
        rows.push_back(
            {{"scene", row.scene},
             {"variant", row.variant},
             {"pass", row.pass},
             {"ms", {{"min", row.ms.min}, {"median", row.ms.median}, {"max", row.ms.max}}},
             {"bytes", row.bytes}});
        fmt::print("{:<24} {:<16} {:<16} {:9.3f} ms ({:.3f} to {:.3f})\n", row.scene, row.variant,
                   row.pass, row.ms.median, row.ms.min, row.ms.max);
    }
    for (const BenchFigure& figure : report.figures) {
        Json json = {{"scene", figure.scene},
                     {"variant", figure.variant},
                     {"name", figure.name},
                     {"value", figure.value}};
        if (figure.published >= 0)
            json["published"] = figure.published;
        figures.push_back(std::move(json));
        fmt::print("{:<24} {:<16} {:<26} {:12.6g}{}\n", figure.scene, figure.variant, figure.name,
                   figure.value,
                   figure.published < 0 ? "" : fmt::format(" (published {:g})", figure.published));
    }
    bool all = true;
    for (const BenchCheck& check : report.checks) {
        all &= check.ok();
        checks.push_back({{"name", check.name},
                          {"value", check.value},
                          {"limit", check.limit},
                          {"ok", check.ok()}});
        fmt::print("{:<44} {:9.5f}, limit {} {}\n", check.name, check.value, check.limit,
                   check.ok() ? "ok" : "MISSED");
    }
    const Json json = {{"gpu", gl::context_info().renderer},
                       {"suite", options.bench_suite},
                       {"rows", rows},
                       {"figures", figures},
                       {"checks", checks}};
    if (!options.bench_json.empty()) {
        make_parent(options.bench_json);
        base::write_file_atomic(options.bench_json,
                                json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n");
    }
    if (!all)
        throw base::Error(base::ExitCode::kFailure,
                          fmt::format("bench {}: found a figure over its limit, expected none",
                                      options.bench_suite));
}

} // namespace sward::app
