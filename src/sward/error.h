// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <stdexcept>
#include <string>

namespace sward {

/// What kind of trouble an Error tells of.
enum class ErrorKind {
    kInside,    ///< a failure inside Sward
    kUsage,     ///< a call or command line that cannot be meant
    kBadInput,  ///< a file or value that cannot be used
    kOverLimit, ///< more than Sward or this GPU takes
    kIo,        ///< reading or writing failed
    kNoGpu, ///< no usable OpenGL 4.5 core context, no memory on the GPU, or a shader that does not
            ///< build
};

/// Bad input or a bad environment. what() is one whole line that names the file and key, or the
/// argument, what was found and what was expected. Everything of <sward/...> throws this class
/// alone, and std::bad_alloc. A call that threw has changed nothing that the next one would see,
/// unless its own comment says otherwise.
class Error : public std::runtime_error {
public:
    Error(ErrorKind kind, const std::string& message) : std::runtime_error(message), kind_(kind) {}
    [[nodiscard]] ErrorKind kind() const { return kind_; }

private:
    ErrorKind kind_;
};

} // namespace sward
