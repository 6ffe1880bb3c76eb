# SPDX-License-Identifier: Apache-2.0
# `cmake --install`: programs in bin/, libraries and headers with a CMake package, configuration and maps in
# share/adit/, where programs look for them (core/config/search.hpp).
include(CMakePackageConfigHelpers)

foreach(folder core nav perception robot_agent basestation sim)
  if(EXISTS ${PROJECT_SOURCE_DIR}/${folder})
    install(DIRECTORY ${folder} DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/adit FILES_MATCHING PATTERN "*.hpp")
  endif()
endforeach()
install(DIRECTORY config/ DESTINATION ${CMAKE_INSTALL_DATADIR}/adit/config PATTERN systemd EXCLUDE)
configure_file(config/systemd/adit-robot@.service ${PROJECT_BINARY_DIR}/adit-robot@.service @ONLY)
install(FILES ${PROJECT_BINARY_DIR}/adit-robot@.service DESTINATION lib/systemd/system)
install(DIRECTORY data/maps/ DESTINATION ${CMAKE_INSTALL_DATADIR}/adit/maps OPTIONAL)
install(FILES LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR})

set(package ${CMAKE_INSTALL_LIBDIR}/cmake/adit)
install(EXPORT adit-targets NAMESPACE adit:: DESTINATION ${package})
configure_package_config_file(cmake/aditConfig.cmake.in ${PROJECT_BINARY_DIR}/aditConfig.cmake
  INSTALL_DESTINATION ${package})
write_basic_package_version_file(${PROJECT_BINARY_DIR}/aditConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/aditConfig.cmake ${PROJECT_BINARY_DIR}/aditConfigVersion.cmake
        DESTINATION ${package})
