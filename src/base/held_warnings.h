// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

namespace sward::base {

/// Holds this thread's warnings back while one stands: they are shown at its end, or dropped where
/// it ends by an exception, whose one line is then all there is to say. Inner ones hand on to outer
/// ones.
class HeldWarnings {
public:
    HeldWarnings();
    ~HeldWarnings();
    HeldWarnings(const HeldWarnings&) = delete;
    HeldWarnings& operator=(const HeldWarnings&) = delete;

    void add(std::string warning);

private:
    HeldWarnings* outer_;
    int exceptions_;
    std::vector<std::string> warnings_;
};

} // namespace sward::base
