# SPDX-License-Identifier: Apache-2.0
# Every library Sward uses, found in one place. Debian's own config files for OpenImageIO and OpenVDB fail or leak, so
# these two go through pkg-config and our own module.
find_package(PkgConfig REQUIRED)
find_package(glm 0.9.9 REQUIRED)
find_package(TinyGLTF CONFIG REQUIRED)
find_package(fmt CONFIG REQUIRED)
find_package(nlohmann_json CONFIG REQUIRED)
find_package(tomlplusplus CONFIG REQUIRED)
find_package(CLI11 CONFIG REQUIRED)
pkg_check_modules(epoxy REQUIRED IMPORTED_TARGET epoxy)
pkg_check_modules(zstd REQUIRED IMPORTED_TARGET libzstd)
pkg_check_modules(crypto REQUIRED IMPORTED_TARGET libcrypto)

if(NOT SWARD_CORE_ONLY)
    find_package(glfw3 3.3 CONFIG REQUIRED)
    find_package(Imath 3 CONFIG REQUIRED)
    find_package(OpenVDB REQUIRED)
    find_package(ZLIB REQUIRED) # what OpenVDB packs its files with: texgen unpacks them itself
    pkg_check_modules(blosc REQUIRED IMPORTED_TARGET blosc)
    find_path(STB_INCLUDE stb/stb_easy_font.h REQUIRED) # a header alone: the letters of texgen's preview
    find_package(GDAL REQUIRED)
    find_package(SQLite3 REQUIRED)
    pkg_check_modules(OIIO REQUIRED IMPORTED_TARGET OpenImageIO>=2.4)
    pkg_check_modules(bullet REQUIRED IMPORTED_TARGET bullet)
    pkg_check_modules(imgui REQUIRED IMPORTED_TARGET imgui)
endif()
if(SWARD_TESTS)
    find_package(GTest REQUIRED)
endif()
