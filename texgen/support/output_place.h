// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <vector>

#include "base/error.h"

namespace sward::texgen {

/// Makes the directories above an output that are missing. Those of them that are still empty when
/// it ends go again, so that a run that fails leaves nothing. Throws base::Error(kIo) that names
/// the output.
class OutputParents {
public:
    explicit OutputParents(const std::filesystem::path& output);
    ~OutputParents() { take_away(); }
    OutputParents(const OutputParents&) = delete;
    OutputParents& operator=(const OutputParents&) = delete;

private:
    void take_away();
    std::vector<std::filesystem::path> made_; ///< the outer before the inner
};

/// Throws `error` again with the name that the user asked for where it names the temporary.
[[noreturn]] void throw_for_place(const base::Error& error, const std::filesystem::path& temporary,
                                  const std::filesystem::path& output);

} // namespace sward::texgen
