# Installs the rooms and the files that let others say find_package(Slabhull).
include(CMakePackageConfigHelpers)

install(EXPORT SlabhullTargets NAMESPACE Slabhull:: DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/Slabhull)
configure_package_config_file(${CMAKE_CURRENT_LIST_DIR}/SlabhullConfig.cmake.in
    ${PROJECT_BINARY_DIR}/SlabhullConfig.cmake
    INSTALL_DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/Slabhull)
write_basic_package_version_file(${PROJECT_BINARY_DIR}/SlabhullConfigVersion.cmake
    COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/SlabhullConfig.cmake ${PROJECT_BINARY_DIR}/SlabhullConfigVersion.cmake
    ${CMAKE_CURRENT_LIST_DIR}/SlabhullFindLibrary.cmake
    ${CMAKE_CURRENT_LIST_DIR}/FindLZ4.cmake ${CMAKE_CURRENT_LIST_DIR}/FindTetGen.cmake
    ${CMAKE_CURRENT_LIST_DIR}/FindOCCT.cmake ${CMAKE_CURRENT_LIST_DIR}/FindHDF5C.cmake
    DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/Slabhull)
