// SPDX-License-Identifier: Apache-2.0
// Temporaries are named ".sward-<pid>-<start time>-<number>.tmp<extension>" and hold a lock while
// their process lives. One that no living process holds is left over from a crash and is swept.
#include <atomic>
#include <cerrno>
#include <charconv>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <map>
#include <mutex>
#include <set>
#include <utility>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/error.h"
#include "base/file.h"
#include "base/log.h"
#include "base/pending_registry.h"

namespace sward::base {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kPrefix = ".sward-";
constexpr std::string_view kMark = ".tmp";
constexpr std::size_t kLongestExtension = 16; // more is no extension; and a name ends at 255 bytes

std::mutex g_mutex;
std::map<fs::path, int> g_pending; // temporary -> descriptor that holds its lock
std::set<fs::path>
    g_swept; // once a directory and process: a sequence of frames must not list it each time

Error write_error(const fs::path& path, std::string_view found) {
    return input_error(ExitCode::kIo, path, 0, "cannot write", found, "room for the whole output");
}

/// Field 22 of /proc/PID/stat: with the process id it names one process for all time. 0 when there
/// is none.
unsigned long long start_time(long pid) {
    std::string stat;
    try {
        stat = read_text(fmt::format("/proc/{}/stat", pid), 4096);
    } catch (const Error&) {
        return 0;
    }
    std::size_t at =
        stat.rfind(')'); // the program's name may hold anything, blanks and brackets too
    for (int field = 2; field < 22 && at != std::string::npos; ++field)
        at = stat.find(' ', at + 1);
    unsigned long long value = 0;
    if (at != std::string::npos)
        std::from_chars(stat.data() + at + 1, stat.data() + stat.size(), value);
    return value;
}

/// True when `name` has our pattern and the process in it is gone.
bool is_left_over(std::string_view name) {
    if (!name.starts_with(kPrefix))
        return false;
    const char* at = name.data() + kPrefix.size();
    const char* const end = name.data() + name.size();
    long pid = 0;
    unsigned long long start = 0, number = 0;
    const auto read = [&](auto& value, char stop) {
        const auto result = std::from_chars(at, end, value);
        if (result.ec != std::errc() || result.ptr == end || *result.ptr != stop)
            return false;
        at = result.ptr + 1;
        return true;
    };
    if (!read(pid, '-') || !read(start, '-') || !read(number, '.') || pid <= 0)
        return false;
    if (!std::string_view(at - 1, end).starts_with(kMark))
        return false;
    return start_time(pid) != start;
}

/// A process of another container has ids that mean nothing here; its lock still counts.
bool is_locked(const fs::path& path) {
    const int fd = ::open(path.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC | O_NOFOLLOW);
    if (fd < 0)
        return true;
    const bool locked = ::flock(fd, LOCK_EX | LOCK_NB) != 0;
    ::close(fd);
    return locked;
}

void sweep(const fs::path& directory) {
    {
        const std::lock_guard lock(g_mutex);
        if (!g_swept.insert(directory).second)
            return;
    }
    std::error_code error;
    for (fs::directory_iterator it(directory, error), end; !error && it != end;
         it.increment(error)) {
        if (!is_left_over(it->path().filename().native()) || is_locked(it->path()))
            continue;
        std::error_code ignored; // someone else's, or swept by another process at the same time
        if (fs::remove_all(it->path(), ignored) > 0 && !ignored)
            log_debug("removed a temporary that a stopped run left: " + it->path().string());
    }
}

/// fsync of one file or directory; 0 or errno.
int sync_path(const fs::path& path) {
    const int fd = ::open(path.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC);
    if (fd < 0)
        return errno;
    const int error = ::fsync(fd) == 0 ? 0 : errno;
    ::close(fd);
    return error == EINVAL ? 0 : error; // file systems that cannot sync a directory
}

int sync_tree(const fs::path& directory) {
    try {
        for (const auto& entry : fs::recursive_directory_iterator(directory))
            if (const int error = entry.is_symlink() ? 0 : sync_path(entry.path()))
                return error;
    } catch (const fs::filesystem_error& e) {
        return e.code().value();
    }
    return sync_path(directory);
}

/// A set or cache directory of ours is flat: anything deeper is the user's and must not be swapped
/// away.
void refuse_foreign(const fs::path& directory, const fs::path& named) {
    std::error_code error;
    for (fs::directory_iterator it(directory, error), end; !error && it != end; it.increment(error))
        if (it->is_directory(error))
            throw input_error(ExitCode::kIo, named, 0, "cannot replace this directory",
                              "a directory in it: " + printable(it->path().filename().native()),
                              "a new name, or a directory that an earlier run wrote");
}

/// Moves `temporary` onto `final_path`, where a directory may stand. 0 or errno.
int move_directory(const fs::path& temporary, const fs::path& final_path) {
    if (::rename(temporary.c_str(), final_path.c_str()) == 0) // free, or an empty directory
        return 0;
    if (errno != ENOTEMPTY && errno != EEXIST)
        return errno;
    std::error_code ignored;
    if (::renameat2(AT_FDCWD, temporary.c_str(), AT_FDCWD, final_path.c_str(), RENAME_EXCHANGE) ==
        0) {
        fs::remove_all(temporary, ignored); // the old one
        return 0;
    }
    if (errno != EINVAL && errno != ENOSYS)
        return errno;
    // A file system that cannot exchange: for a moment nothing stands under the final name.
    fs::path old = temporary;
    old += ".old";
    if (::rename(final_path.c_str(), old.c_str()) != 0)
        return errno;
    if (::rename(temporary.c_str(), final_path.c_str()) != 0) {
        const int error = errno;
        ::rename(old.c_str(), final_path.c_str());
        return error;
    }
    fs::remove_all(old, ignored);
    return 0;
}

fs::path temporary_name(const fs::path& directory, const fs::path& final_path) {
    static std::atomic<unsigned> counter{0};
    static const unsigned long long start = start_time(::getpid());
    // The extension stays: writers choose their format by it.
    std::string extension = final_path.extension().native();
    if (extension.size() > kLongestExtension)
        extension.clear();
    return directory /
           fmt::format("{}{}-{}-{}{}{}", kPrefix, ::getpid(), start, counter++, kMark, extension);
}

/// The place that `path` names: absolute, without a trailing slash, behind a symbolic link where it
/// is one.
fs::path real_target(const fs::path& path) {
    fs::path target = fs::absolute(path).lexically_normal();
    if (!target.has_filename())
        target = target.parent_path();
    return fs::is_symlink(target) ? fs::canonical(target) : target;
}

} // namespace

void register_pending(const fs::path& temporary) {
    const int fd = ::open(temporary.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC | O_NOFOLLOW);
    if (fd >= 0)
        ::flock(fd, LOCK_EX | LOCK_NB); // best effort: not every file system has locks
    const std::lock_guard lock(g_mutex);
    g_pending.emplace(temporary, fd);
}

/// Gives the lock's handle back; the temporary stays known to the signals' clean-up.
static void unlock_pending(const fs::path& temporary) {
    const std::lock_guard lock(g_mutex);
    const auto it = g_pending.find(temporary);
    if (it != g_pending.end() && it->second >= 0)
        ::close(std::exchange(it->second, -1));
}

void unregister_pending(const fs::path& temporary) {
    const std::lock_guard lock(g_mutex);
    const auto it = g_pending.find(temporary);
    if (it == g_pending.end())
        return;
    if (it->second >= 0)
        ::close(it->second);
    g_pending.erase(it);
}

void remove_all_pending() {
    const std::lock_guard lock(g_mutex);
    std::error_code ignored;
    for (const auto& [temporary, fd] : g_pending)
        for (int attempt = 0; attempt < 10 && fs::exists(fs::symlink_status(temporary, ignored));
             ++attempt)
            fs::remove_all(temporary,
                           ignored); // again: another thread may still be writing into it
}

PendingOutput::PendingOutput(fs::path final_path, Kind kind)
    : final_(std::move(final_path)), kind_(kind) {
    require_writable(final_, kind);
    fs::path target;
    try {
        target = real_target(final_);
    } catch (const fs::filesystem_error& e) {
        throw write_error(final_, e.code().message());
    }
    if (kind == Kind::kDirectory && fs::is_directory(target))
        refuse_foreign(target, final_);
    final_ = target;
    sweep(target.parent_path());
    temporary_ = temporary_name(target.parent_path(), target);
    if (kind == Kind::kDirectory) {
        if (::mkdir(temporary_.c_str(), 0777) != 0)
            throw write_error(final_, std::strerror(errno));
    } else {
        const int fd = ::open(temporary_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
        if (fd < 0)
            throw write_error(final_, std::strerror(errno));
        ::close(fd);
    }
    register_pending(temporary_);
}

PendingOutput::~PendingOutput() {
    std::error_code ignored;
    if (!committed_) {
        unlock_pending(
            temporary_); // a directory is emptied through a handle, and ours may be the last
        fs::remove_all(temporary_, ignored);
    }
    unregister_pending(temporary_);
}

void PendingOutput::commit() {
    if (committed_)
        return;
    if (const int error = kind_ == Kind::kFile ? sync_path(temporary_) : sync_tree(temporary_))
        throw write_error(final_, std::strerror(error));
    const int error = kind_ == Kind::kDirectory ? move_directory(temporary_, final_)
                      : ::rename(temporary_.c_str(), final_.c_str()) == 0 ? 0
                                                                          : errno;
    if (error != 0)
        throw write_error(final_, std::strerror(error));
    committed_ = true;
    unregister_pending(temporary_);
    if (const int sync = sync_path(final_.parent_path()))
        throw write_error(final_, std::strerror(sync));
}

} // namespace sward::base
