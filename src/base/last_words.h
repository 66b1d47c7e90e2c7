// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace sward::base {

/// Where an exception is caught by nobody (a library's thread, or its beginning before main()), the
/// program ends with the contract's one line and code in place of a signal: 4 for want of memory or
/// threads, else 1. Where there is no room to begin with, it ends at once. `program` must outlive
/// the process. Also keeps libraries from starting threads that nobody here needs. To be called
/// before the libraries begin: SWARD_BEFORE_LIBRARIES.
void install_last_words(const char* program);

} // namespace sward::base

/// Calls install_last_words before any library's own beginning. Once, in the file with main().
#define SWARD_BEFORE_LIBRARIES(program)                                                            \
    static void sward_before_libraries(int, char**, char**) {                                      \
        sward::base::install_last_words(program);                                                  \
    }                                                                                              \
    __attribute__((section(".preinit_array"),                                                      \
                   used)) static void (*const g_sward_before_libraries)(int, char**, char**) =     \
        sward_before_libraries
