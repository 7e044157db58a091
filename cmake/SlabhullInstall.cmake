# Installs the rooms and the files that let others say find_package(Slabhull).
include(CMakePackageConfigHelpers)

install(EXPORT SlabhullTargets NAMESPACE Slabhull:: DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/Slabhull
    COMPONENT dev)
configure_package_config_file(${CMAKE_CURRENT_LIST_DIR}/SlabhullConfig.cmake.in
    ${PROJECT_BINARY_DIR}/SlabhullConfig.cmake
    INSTALL_DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/Slabhull)
write_basic_package_version_file(${PROJECT_BINARY_DIR}/SlabhullConfigVersion.cmake
    COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/SlabhullConfig.cmake ${PROJECT_BINARY_DIR}/SlabhullConfigVersion.cmake
    ${CMAKE_CURRENT_LIST_DIR}/SlabhullFindLibrary.cmake
    ${CMAKE_CURRENT_LIST_DIR}/FindLZ4.cmake ${CMAKE_CURRENT_LIST_DIR}/FindTetGen.cmake
    ${CMAKE_CURRENT_LIST_DIR}/FindOCCT.cmake ${CMAKE_CURRENT_LIST_DIR}/FindHDF5C.cmake
    DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/Slabhull COMPONENT dev)

# For those who do not use CMake.
file(RELATIVE_PATH pc_to_prefix /prefix/${CMAKE_INSTALL_LIBDIR}/pkgconfig /prefix)
configure_file(${CMAKE_CURRENT_LIST_DIR}/slabhull.pc.in ${PROJECT_BINARY_DIR}/slabhull.pc @ONLY)
install(FILES ${PROJECT_BINARY_DIR}/slabhull.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig COMPONENT dev)

# What a user of the program reads and tries.
set(CMAKE_INSTALL_DOCDIR ${CMAKE_INSTALL_DATADIR}/doc/slabhull)
install(FILES ${PROJECT_SOURCE_DIR}/README.md ${PROJECT_SOURCE_DIR}/CHANGELOG.md DESTINATION ${CMAKE_INSTALL_DOCDIR}
    COMPONENT program)
install(DIRECTORY ${PROJECT_SOURCE_DIR}/docs DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT program
    PATTERN "*.in" EXCLUDE PATTERN "site" EXCLUDE PATTERN "api" EXCLUDE)
install(DIRECTORY ${PROJECT_SOURCE_DIR}/examples DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT program
    PATTERN "CMakeLists.txt" EXCLUDE PATTERN "heat" EXCLUDE PATTERN "solver" EXCLUDE PATTERN "__pycache__" EXCLUDE)
install(FILES ${PROJECT_SOURCE_DIR}/cmake/completion/slabhull
    DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions COMPONENT program)

# Manual pages, made from the help texts.
set(manual ${PROJECT_BINARY_DIR}/man1)
add_custom_command(OUTPUT ${manual}/slabhull.1.gz
    COMMAND ${CMAKE_COMMAND} -DPROGRAM=$<TARGET_FILE:slabhull> -DFOLDER=${manual} -DVERSION=${PROJECT_VERSION}
        -DDOCUMENTS=${CMAKE_INSTALL_PREFIX}/${CMAKE_INSTALL_DATADIR}/doc/slabhull/docs -P ${CMAKE_CURRENT_LIST_DIR}/write_manual.cmake
    DEPENDS slabhull ${CMAKE_CURRENT_LIST_DIR}/write_manual.cmake VERBATIM)
add_custom_target(manual ALL DEPENDS ${manual}/slabhull.1.gz)
install(DIRECTORY ${manual} DESTINATION ${CMAKE_INSTALL_MANDIR} COMPONENT program)
