# SPDX-License-Identifier: Apache-2.0
# OpenVDB::openvdb from the headers and the library alone; Debian's own config file demands what it does not ship.
find_package(TBB CONFIG QUIET)
find_package(Imath 3 CONFIG QUIET)
find_path(OpenVDB_INCLUDE_DIR openvdb/version.h)
find_library(OpenVDB_LIBRARY openvdb)
find_path(OpenVDB_BOOST_INCLUDE_DIR boost/any.hpp)
if(OpenVDB_INCLUDE_DIR)
    file(STRINGS "${OpenVDB_INCLUDE_DIR}/openvdb/version.h" OpenVDB_version_lines REGEX
         "define OPENVDB_LIBRARY_(MAJOR|MINOR|PATCH)_VERSION_NUMBER ")
    string(REGEX MATCHALL "[0-9]+" OpenVDB_version_parts "${OpenVDB_version_lines}")
    list(JOIN OpenVDB_version_parts "." OpenVDB_VERSION)
endif()
include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(OpenVDB
    REQUIRED_VARS OpenVDB_LIBRARY OpenVDB_INCLUDE_DIR OpenVDB_BOOST_INCLUDE_DIR TBB_FOUND Imath_FOUND
    VERSION_VAR OpenVDB_VERSION)
if(OpenVDB_FOUND AND NOT TARGET OpenVDB::openvdb)
    add_library(OpenVDB::openvdb UNKNOWN IMPORTED)
    set_target_properties(OpenVDB::openvdb PROPERTIES
        IMPORTED_LOCATION "${OpenVDB_LIBRARY}"
        INTERFACE_INCLUDE_DIRECTORIES "${OpenVDB_INCLUDE_DIR}"
        INTERFACE_LINK_LIBRARIES "TBB::tbb;Imath::Imath"
        INTERFACE_COMPILE_FEATURES cxx_std_17)
endif()
