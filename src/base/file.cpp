// SPDX-License-Identifier: Apache-2.0
#include "base/file.h"

#include <algorithm>
#include <cerrno>
#include <cstring>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/error.h"

namespace sward::base {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kChunk = std::size_t{1}
                               << 20; // read() past the size fstat told: files of /proc tell 0

class Descriptor {
public:
    explicit Descriptor(int fd) : fd_(fd) {}
    ~Descriptor() {
        if (fd_ >= 0)
            ::close(fd_);
    }
    Descriptor(const Descriptor&) = delete;
    Descriptor& operator=(const Descriptor&) = delete;
    [[nodiscard]] int get() const { return fd_; }
    [[nodiscard]] int close() {
        const int result = ::close(fd_);
        fd_ = -1;
        return result;
    }

private:
    int fd_;
};

std::string reason(int error) {
    return std::strerror(error);
}

Error io_error(const fs::path& path, std::string_view what, std::string_view found,
               std::string_view expected) {
    return input_error(ExitCode::kIo, path, 0, what, found, expected);
}

const char* kind_name(mode_t mode) {
    switch (mode & S_IFMT) {
    case S_IFDIR:
        return "a directory";
    case S_IFIFO:
        return "a FIFO";
    case S_IFSOCK:
        return "a socket";
    case S_IFCHR:
    case S_IFBLK:
        return "a device";
    default:
        return "a special file";
    }
}

/// Opens a regular file for reading; `size` becomes what fstat tells.
int open_regular(const fs::path& path, std::uint64_t& size) {
    // O_NONBLOCK: opening a FIFO that nobody writes to would wait for ever.
    const int fd = ::open(path.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC | O_NOCTTY);
    struct stat info {};
    if (fd < 0)
        throw io_error(path, "cannot read", reason(errno), "a readable file");
    const int failed = ::fstat(fd, &info) == 0 ? 0 : errno;
    if (failed == 0 && S_ISREG(info.st_mode)) {
        size = static_cast<std::uint64_t>(info.st_size);
        return fd;
    }
    ::close(fd);
    throw io_error(path, "cannot read", failed ? reason(failed) : kind_name(info.st_mode),
                   "a regular file");
}

template<class Container> Container read_whole(const fs::path& path, std::uint64_t limit) {
    std::uint64_t told = 0;
    const Descriptor fd(open_regular(path, told));
    const auto over_limit = [&](std::uint64_t size) {
        return input_error(ExitCode::kOverLimit, path, 0, "file too large",
                           fmt::format("{} bytes", size), fmt::format("at most {}", limit));
    };
    if (told > limit)
        throw over_limit(told);

    Container content;
    content.resize(static_cast<std::size_t>(told));
    std::size_t done = 0;
    while (true) {
        if (done == content.size()) {
            // The end, unless the file grew since: one more byte tells.
            unsigned char more = 0;
            const ssize_t n = ::read(fd.get(), &more, 1);
            if (n < 0 && errno == EINTR)
                continue;
            if (n < 0)
                throw io_error(path, "cannot read", reason(errno), "a readable file");
            if (n == 0)
                return content;
            if (done + 1 > limit)
                throw over_limit(done + 1);
            const std::uint64_t grown = std::min<std::uint64_t>(limit, done + kChunk);
            content.resize(static_cast<std::size_t>(grown));
            std::memcpy(content.data() + done++, &more, 1);
            continue;
        }
        const ssize_t n = ::read(fd.get(), content.data() + done, content.size() - done);
        if (n < 0 && errno == EINTR)
            continue;
        if (n < 0)
            throw io_error(path, "cannot read", reason(errno), "a readable file");
        if (n == 0) {
            content.resize(done); // shorter than told: cut while we read
            return content;
        }
        done += static_cast<std::size_t>(n);
    }
}

void write_whole(const fs::path& temporary, const fs::path& final_path,
                 std::span<const std::byte> bytes) {
    const auto fail = [&](int error) {
        return io_error(final_path, "cannot write", reason(error), "room for the whole file");
    };
    Descriptor fd(::open(temporary.c_str(), O_WRONLY | O_TRUNC | O_CLOEXEC | O_NOFOLLOW));
    if (fd.get() < 0)
        throw fail(errno);
    for (std::size_t done = 0; done < bytes.size();) {
        const ssize_t n = ::write(fd.get(), bytes.data() + done, bytes.size() - done);
        if (n < 0 && errno == EINTR)
            continue;
        if (n <= 0)
            throw fail(n < 0 ? errno : ENOSPC);
        done += static_cast<std::size_t>(n);
    }
    if (::fsync(fd.get()) != 0)
        throw fail(errno);
    if (fd.close() != 0)
        throw fail(errno);
    struct stat info {};
    if (::stat(temporary.c_str(), &info) != 0)
        throw fail(errno);
    if (static_cast<std::uint64_t>(info.st_size) != bytes.size())
        throw io_error(final_path, "wrong size after writing",
                       fmt::format("{} bytes", info.st_size),
                       fmt::format("{} bytes", bytes.size()));
}

} // namespace

std::vector<std::byte> read_file(const fs::path& path, std::uint64_t limit) {
    return read_whole<std::vector<std::byte>>(path, limit);
}

std::string read_text(const fs::path& path, std::uint64_t limit) {
    return read_whole<std::string>(path, limit);
}

std::vector<std::byte> read_head(const fs::path& path, std::size_t most) {
    std::uint64_t size = 0;
    const Descriptor fd(open_regular(path, size));
    std::vector<std::byte> head(most);
    std::size_t done = 0;
    while (done < most) {
        const ssize_t n = ::read(fd.get(), head.data() + done, most - done);
        if (n < 0 && errno == EINTR)
            continue;
        if (n < 0)
            throw io_error(path, "cannot read", reason(errno), "a readable file");
        if (n == 0)
            break;
        done += static_cast<std::size_t>(n);
    }
    head.resize(done);
    return head;
}

void write_file_atomic(const fs::path& path, std::span<const std::byte> bytes) {
    PendingOutput pending(path, PendingOutput::Kind::kFile);
    write_whole(pending.path(), path, bytes);
    pending.commit();
}

void write_file_atomic(const fs::path& path, const std::string& text) {
    write_file_atomic(path, std::as_bytes(std::span(text.data(), text.size())));
}

void require_writable(const fs::path& path, PendingOutput::Kind kind) {
    const bool file = kind == PendingOutput::Kind::kFile;
    const char* wanted = file ? "the name of a file to write" : "the name of a directory to write";
    if (path.empty() || path.native().find('\0') != std::string::npos)
        throw io_error(path, "cannot write", "an empty name", wanted);
    if (file && !path.has_filename())
        throw io_error(path, "cannot write", "the name of a directory", wanted);

    struct stat info {};
    if (::stat(path.c_str(), &info) == 0) {
        if (file ? !S_ISREG(info.st_mode) : !S_ISDIR(info.st_mode))
            throw io_error(path, "cannot write",
                           S_ISREG(info.st_mode) ? "a file" : kind_name(info.st_mode), wanted);
    } else if (errno != ENOENT) {
        throw io_error(path, "cannot write", reason(errno), wanted); // a loop, a name too long, ...
    } else if (::lstat(path.c_str(), &info) == 0) {
        throw io_error(path, "cannot write", "a symbolic link that leads nowhere", wanted);
    }

    fs::path parent = fs::absolute(path).lexically_normal();
    if (!parent.has_filename())
        parent = parent.parent_path(); // "out/" is the directory out
    parent = parent.parent_path();
    if (::stat(parent.c_str(), &info) != 0)
        throw io_error(path, fmt::format("cannot write: directory {}", printable(parent.native())),
                       reason(errno), "a directory that exists");
    if (!S_ISDIR(info.st_mode))
        throw io_error(path, fmt::format("cannot write: {}", printable(parent.native())),
                       "no directory", "a directory");
    if (::access(parent.c_str(), W_OK | X_OK) != 0)
        throw io_error(path, fmt::format("cannot write: directory {}", printable(parent.native())),
                       reason(errno), "a writable directory");
}

fs::path executable_directory() {
    std::error_code error;
    const fs::path self = fs::read_symlink("/proc/self/exe", error);
    if (error)
        throw Error(ExitCode::kIo, "/proc/self/exe: cannot read: found " + error.message() +
                                       ", expected the program's own path");
    return self.parent_path();
}

} // namespace sward::base
