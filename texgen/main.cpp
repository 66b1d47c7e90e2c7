// SPDX-License-Identifier: Apache-2.0
// texgen: a species preset becomes a grass set (docs/texgen.md).
#include <cstdio>
#include <exception>
#include <new>

#include "base/error.h"
#include "base/file.h"
#include "base/log.h"
#include "texgen/options.h"

namespace {

using namespace sward;

int run(int argc, char** argv) {
    const texgen::Options options = texgen::parse_options(argc, argv);
    if (!options.help.empty()) {
        std::fputs(options.help.c_str(), stdout);
        return 0;
    }
    base::install_signal_cleanup();
    return options.run(options);
}

int fail(base::ExitCode code, const std::string& message) {
    base::log_error(message);
    return static_cast<int>(code);
}

} // namespace

int main(int argc, char** argv) {
    try {
        return run(argc, argv);
    } catch (const base::Error& error) {
        return fail(error.code(), error.what());
    } catch (const std::bad_alloc&) {
        return fail(base::ExitCode::kOverLimit, "out of memory");
    } catch (const std::exception& error) {
        return fail(base::ExitCode::kFailure, error.what());
    }
}
