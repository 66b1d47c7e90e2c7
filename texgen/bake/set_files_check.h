// SPDX-License-Identifier: Apache-2.0
// The files of a set, or of an export, against the sizes and hashes that its set.json or
// export.json lists.
#pragma once

#include <filesystem>
#include <span>
#include <vector>

#include "grass/set_files.h"
#include "texgen/bake/writer.h"

namespace sward::texgen {

/// The entries `files` of DIR/set.json (or of another such list). Throws base::Error: kIo no such
/// directory, kBadInput no set.json or a damaged one, kOverLimit.
[[nodiscard]] std::vector<FileEntry> listed_files(const std::filesystem::path& directory,
                                                  const char* list = grass::kSetJson);

/// The file's bytes when they are those that `entry` lists; base::Error(kBadInput) that names the
/// file when they are not, also when it is missing.
[[nodiscard]] std::vector<std::byte> checked_file(const std::filesystem::path& directory,
                                                  const FileEntry& entry,
                                                  const char* list = grass::kSetJson);

/// Names in the directory that no set of ours has: neither listed in its set.json, which may be
/// damaged, with the size and hash that they have, nor of the form of our files.
[[nodiscard]] std::vector<std::string> foreign_files(const std::filesystem::path& directory);

/// Names in the directory that the list does not name, sorted.
[[nodiscard]] std::vector<std::string> unlisted_files(const std::filesystem::path& directory,
                                                      std::span<const FileEntry> entries,
                                                      const char* list = grass::kSetJson);

} // namespace sward::texgen
