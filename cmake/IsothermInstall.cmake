# Installs the export set and the package files that find_package(isotherm) reads.

include(CMakePackageConfigHelpers)

set(package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/isotherm)

configure_package_config_file(
  ${CMAKE_CURRENT_LIST_DIR}/isothermConfig.cmake.in
  ${CMAKE_CURRENT_BINARY_DIR}/isothermConfig.cmake
  INSTALL_DESTINATION ${package_dir})
write_basic_package_version_file(
  ${CMAKE_CURRENT_BINARY_DIR}/isothermConfigVersion.cmake
  COMPATIBILITY SameMinorVersion)

install(EXPORT isothermTargets NAMESPACE isotherm:: DESTINATION ${package_dir})
install(FILES
    ${CMAKE_CURRENT_BINARY_DIR}/isothermConfig.cmake
    ${CMAKE_CURRENT_BINARY_DIR}/isothermConfigVersion.cmake
    ${CMAKE_CURRENT_LIST_DIR}/FindCHOLMOD.cmake
  DESTINATION ${package_dir})
