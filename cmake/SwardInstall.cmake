# SPDX-License-Identifier: Apache-2.0
# `cmake --install`: the library with its headers, shaders and package files, the programs with their presets and terrains. `cpack`: a .deb of it.
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

set(SWARD_DATA "${CMAKE_INSTALL_DATADIR}/sward")
set(package_dir "${CMAKE_INSTALL_LIBDIR}/cmake/sward")

install(TARGETS sward_library EXPORT swardTargets ARCHIVE DESTINATION "${CMAKE_INSTALL_LIBDIR}")
install(FILES src/sward/blower.h src/sward/camera.h src/sward/error.h src/sward/field.h src/sward/log.h src/sward/view.h
              "${PROJECT_BINARY_DIR}/include/sward/version.h"
        DESTINATION "${CMAKE_INSTALL_INCLUDEDIR}/sward")
install(DIRECTORY shaders DESTINATION "${SWARD_DATA}" PATTERN ".clang-format" EXCLUDE)
if(SWARD_PROGRAMS)
    install(TARGETS sward RUNTIME DESTINATION "${CMAKE_INSTALL_BINDIR}")
    install(DIRECTORY terrains DESTINATION "${SWARD_DATA}")
    install(DIRECTORY aircraft vehicles DESTINATION "${SWARD_DATA}")
    install(DIRECTORY texgen/presets DESTINATION "${SWARD_DATA}")
    if(NOT SWARD_CORE_ONLY)
        install(TARGETS texgen RUNTIME DESTINATION "${CMAKE_INSTALL_BINDIR}")
    endif()
endif()
install(FILES LICENSE README.md DESTINATION "${CMAKE_INSTALL_DOCDIR}")

install(EXPORT swardTargets NAMESPACE sward:: DESTINATION "${package_dir}")
configure_package_config_file(cmake/swardConfig.cmake.in "${PROJECT_BINARY_DIR}/swardConfig.cmake" INSTALL_DESTINATION "${package_dir}"
                              PATH_VARS SWARD_DATA)
write_basic_package_version_file("${PROJECT_BINARY_DIR}/swardConfigVersion.cmake" COMPATIBILITY SameMinorVersion)
install(FILES "${PROJECT_BINARY_DIR}/swardConfig.cmake" "${PROJECT_BINARY_DIR}/swardConfigVersion.cmake" DESTINATION "${package_dir}")
file(RELATIVE_PATH SWARD_PC_UP "/${CMAKE_INSTALL_LIBDIR}/pkgconfig" "/")
configure_file(cmake/sward.pc.in "${PROJECT_BINARY_DIR}/sward.pc" @ONLY)
install(FILES "${PROJECT_BINARY_DIR}/sward.pc" DESTINATION "${CMAKE_INSTALL_LIBDIR}/pkgconfig")

set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME sward)
set(CPACK_PACKAGE_CONTACT "The Sward authors <sward@localhost>")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "Grassland for simulators: library, viewer, texture generator")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
# What a host needs to link the library; the programs run without.
set(CPACK_DEBIAN_PACKAGE_SUGGESTS "g++, pkg-config, libepoxy-dev, libfmt-dev, libglm-dev, libssl-dev, libtinygltf-dev, libtomlplusplus-dev, libzstd-dev, nlohmann-json3-dev")
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
include(CPack)
