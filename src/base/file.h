// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace sward::base {

/// Reads a whole regular file. Throws Error: kIo when it is missing, a directory, a FIFO or
/// unreadable; kOverLimit above `limit` bytes. Never blocks on a FIFO.
[[nodiscard]] std::vector<std::byte> read_file(const std::filesystem::path& path,
                                               std::uint64_t limit);
[[nodiscard]] std::string read_text(const std::filesystem::path& path, std::uint64_t limit);

/// The first `most` bytes of a regular file (fewer when it is shorter), to choose a reader by;
/// throws like read_file.
[[nodiscard]] std::vector<std::byte> read_head(const std::filesystem::path& path, std::size_t most);

/// Writes a file whole or not at all: temporary name in the same directory, write, fsync, rename,
/// fsync of the directory. Throws Error(kIo) that names `path`; the old file is then intact and the
/// temporary is gone.
void write_file_atomic(const std::filesystem::path& path, std::span<const std::byte> bytes);
void write_file_atomic(const std::filesystem::path& path, const std::string& text);

/// A temporary beside its final name, for writers that need a path of their own (a directory, or a
/// library that writes by name). Removed by the destructor, and by SIGINT/SIGTERM, unless commit()
/// moved it to the final name.
class PendingOutput {
public:
    enum class Kind { kFile, kDirectory };
    PendingOutput(std::filesystem::path final_path, Kind kind);
    ~PendingOutput();
    PendingOutput(const PendingOutput&) = delete;
    PendingOutput& operator=(const PendingOutput&) = delete;
    [[nodiscard]] const std::filesystem::path& path() const { return temporary_; } ///< write here
    /// fsync, then rename onto the final name (a directory that stands there is swapped out and
    /// removed; one that holds directories of its own was not written by us, and is refused by the
    /// constructor).
    void commit();

private:
    std::filesystem::path final_;
    std::filesystem::path temporary_;
    Kind kind_;
    bool committed_ = false;
};

/// SIGINT and SIGTERM remove pending outputs and exit with 130 or 143; a second signal exits at
/// once.
void install_signal_cleanup();

/// Throws Error(kIo) naming `path` unless a file (or directory) can be created under that name:
/// parent exists, is a directory and writable, and what stands there already is of the same kind.
/// For checks before long work.
void require_writable(const std::filesystem::path& path,
                      PendingOutput::Kind kind = PendingOutput::Kind::kFile);

/// Directory of the running executable.
[[nodiscard]] std::filesystem::path executable_directory();

} // namespace sward::base
