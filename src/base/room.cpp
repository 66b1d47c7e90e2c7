// SPDX-License-Identifier: Apache-2.0
#include "base/room.h"

#include <cerrno>
#include <string>

#include <fcntl.h>
#include <sys/mman.h>
#include <unistd.h>

#include "base/error.h"

namespace sward::base {
bool has_room(std::size_t bytes) {
    void* place =
        ::mmap(nullptr, bytes, PROT_NONE, MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
    if (place == MAP_FAILED)
        return false;
    ::munmap(place, bytes);
    return true;
}

void refuse_if_starved(std::size_t enough) {
    if (!has_room(enough))
        throw Error(ExitCode::kOverLimit, "memory: found less than " +
                                              std::to_string(enough >> 20) +
                                              " MiB left, expected more (ulimit -v)");
    const int fd = ::open("/dev/null", O_RDONLY | O_CLOEXEC);
    if (fd < 0 && (errno == EMFILE || errno == ENFILE))
        throw Error(ExitCode::kIo, "file handles: found none left, expected more (ulimit -n)");
    if (fd >= 0)
        ::close(fd);
}

} // namespace sward::base
