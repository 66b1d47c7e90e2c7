// SPDX-License-Identifier: Apache-2.0
#include <cerrno>
#include <cstdio>
#include <cstring>

#include "app/io.h"
#include "base/error.h"

namespace sward::app {

void write_raw(const scene::Picture& picture) {
    if (std::fwrite(picture.rgb.data(), 1, picture.rgb.size(), stdout) != picture.rgb.size() ||
        std::fflush(stdout) != 0)
        throw base::Error(base::ExitCode::kIo, std::string("stdout: cannot write: found ") +
                                                   std::strerror(errno) +
                                                   ", expected a program that reads it");
}

} // namespace sward::app
