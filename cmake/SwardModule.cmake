# SPDX-License-Identifier: Apache-2.0
# Warnings and optimisation as interface targets, and one static library per module.
set(CMAKE_CXX_STANDARD 20)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_RUNTIME_OUTPUT_DIRECTORY "${PROJECT_BINARY_DIR}/bin")
find_program(SWARD_CCACHE ccache)
if(SWARD_CCACHE)
    set(CMAKE_CXX_COMPILER_LAUNCHER "${SWARD_CCACHE}")
endif()

add_library(sward_options INTERFACE)
target_compile_options(sward_options INTERFACE -Wall -Wextra -Wshadow -Wconversion -Wno-sign-conversion
                       -ffp-contract=off)  # the same bits from the CPU twins at every optimisation level
if(SWARD_SANITIZE)
    target_compile_options(sward_options INTERFACE -fsanitize=address,undefined -fno-omit-frame-pointer)
    target_link_options(sward_options INTERFACE -fsanitize=address,undefined)
endif()

# sward_module(NAME SOURCES ... LINKS ... PRIVATE_LINKS ...): LINKS are the arrows of docs/architecture.md.
function(sward_module name)
    cmake_parse_arguments(ARG "" "" "SOURCES;LINKS;PRIVATE_LINKS" ${ARGN})
    add_library(sward_${name} STATIC ${ARG_SOURCES})
    target_include_directories(sward_${name} PUBLIC "${PROJECT_SOURCE_DIR}/src" "${PROJECT_SOURCE_DIR}/shaders")
    target_link_libraries(sward_${name} PUBLIC ${ARG_LINKS} PRIVATE sward_options ${ARG_PRIVATE_LINKS})
endfunction()
