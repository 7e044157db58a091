# Debian packages by CPack: the program, and the library for those who build on it. scripts/packages.sh makes and tries them.
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_CONTACT "The Slabhull authors <maintainers@slabhull.invalid>")
set(CPACK_PACKAGE_VENDOR "Slabhull")
set(CPACK_PACKAGE_HOMEPAGE_URL "https://github.com/slabhull/slabhull")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE
    WORLD_READ WORLD_EXECUTE)
set(CPACK_COMPONENTS_ALL program dev)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)

set(CPACK_DEBIAN_PROGRAM_PACKAGE_NAME slabhull)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_SECTION science)
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "space-time hull meshes of moving domains")
set(CPACK_COMPONENT_PROGRAM_DESCRIPTION
    "Builds the boundaries of space-time slabs of a moving domain, closed,
conforming and checked, and fills them with simplices, from a mesh or
surfaces and a motion.")

set(CPACK_DEBIAN_DEV_PACKAGE_NAME libslabhull-dev)
set(CPACK_DEBIAN_DEV_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_DEV_PACKAGE_DEPENDS "libopenmesh-dev, libtet1.5-dev, libboost-graph-dev, libcgal-dev, libeigen3-dev, \
libtomlplusplus-dev, libfmt-dev, libpugixml-dev, zlib1g-dev, liblz4-dev, libmuparser-dev, nlohmann-json3-dev")
if(OCCT_FOUND)
    string(APPEND CPACK_DEBIAN_DEV_PACKAGE_DEPENDS ", libocct-modeling-algorithms-dev, libocct-data-exchange-dev")
endif()
if(HDF5C_FOUND)
    string(APPEND CPACK_DEBIAN_DEV_PACKAGE_DEPENDS ", libhdf5-dev")
endif()
set(CPACK_COMPONENT_DEV_DESCRIPTION
    "Static libraries and headers of Slabhull, found by find_package(Slabhull)
of CMake and by pkg-config: marches of a solver, checks, sections and
fillings.")

set(packages slabhull libslabhull-dev)
if(BUILD_SHARED_LIBS)
    set(CPACK_DEBIAN_LIB_PACKAGE_NAME libslabhull${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR})
    set(CPACK_DEBIAN_LIB_PACKAGE_SECTION libs)
    set(CPACK_DEBIAN_PACKAGE_GENERATE_SHLIBS ON)
    set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS_PRIVATE_DIRS ${PROJECT_BINARY_DIR}/core ${PROJECT_BINARY_DIR}/topology
        ${PROJECT_BINARY_DIR}/geometry ${PROJECT_BINARY_DIR}/io ${PROJECT_BINARY_DIR}/slab ${PROJECT_BINARY_DIR}/edit
        ${PROJECT_BINARY_DIR}/cases)
    set(CPACK_COMPONENT_LIB_DESCRIPTION "Shared libraries of Slabhull.")
    set(CPACK_DEBIAN_DEV_PACKAGE_DEPENDS "${CPACK_DEBIAN_LIB_PACKAGE_NAME} (= ${PROJECT_VERSION})")
    list(APPEND packages ${CPACK_DEBIAN_LIB_PACKAGE_NAME})
    list(APPEND CPACK_COMPONENTS_ALL lib)
endif()
if(SLABHULL_HAS_PYTHON_MODULE)
    list(APPEND packages python3-slabhull)
    list(APPEND CPACK_COMPONENTS_ALL python)
    set(CPACK_DEBIAN_PYTHON_PACKAGE_NAME python3-slabhull)
    set(CPACK_DEBIAN_PYTHON_PACKAGE_SECTION python)
    set(CPACK_DEBIAN_PYTHON_PACKAGE_DEPENDS
        "python3 (>= ${Python3_VERSION_MAJOR}.${Python3_VERSION_MINOR}), python3-numpy")
    set(CPACK_COMPONENT_PYTHON_DESCRIPTION
        "The module slabhull of Python: marches with motions that are functions,
hulls as views of numpy, checks, sections, fillings and files.")
endif()

# What Debian wants with each package.
foreach(package IN LISTS packages)
    set(component program)
    if(package MATCHES "dev$")
        set(component dev)
    elseif(package STREQUAL "${CPACK_DEBIAN_LIB_PACKAGE_NAME}")
        set(component lib)
    elseif(package MATCHES "^python")
        set(component python)
    endif()
    file(CONFIGURE OUTPUT ${PROJECT_BINARY_DIR}/debian/${package}/changelog CONTENT
        "slabhull (@PROJECT_VERSION@) unstable; urgency=medium\n\n  * See CHANGELOG.md.\n\n -- @CPACK_PACKAGE_CONTACT@  Sun, 29 Nov 2026 12:00:00 +0000\n" @ONLY)
    execute_process(COMMAND gzip -9nkf ${PROJECT_BINARY_DIR}/debian/${package}/changelog)
    file(READ ${PROJECT_SOURCE_DIR}/LICENSE license)
    string(REGEX REPLACE "\n\n" "\n.\n" license "${license}")
    string(REGEX REPLACE "\n([^\n])" "\n \\1" license "${license}")
    file(WRITE ${PROJECT_BINARY_DIR}/debian/${package}/copyright
        "Format: https://www.debian.org/doc/packaging-manuals/copyright-format/1.0/\nUpstream-Name: Slabhull\n\nFiles: *\nCopyright: 2026, the Slabhull authors\nLicense: BSD-3-Clause\n ${license}")
    install(FILES ${PROJECT_BINARY_DIR}/debian/${package}/changelog.gz ${PROJECT_BINARY_DIR}/debian/${package}/copyright
        DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/${package} COMPONENT ${component} EXCLUDE_FROM_ALL)
endforeach()
include(CPack)
