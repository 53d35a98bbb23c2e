# Installation: program, library, headers, package for find_package(nephroid), manual page, shell completion.
include(CMakePackageConfigHelpers)

set(NEPHROID_CMAKE_DIR ${CMAKE_INSTALL_LIBDIR}/cmake/nephroid)

# A static library needs what it was built with when it is linked, so that travels with it.
install(TARGETS nephroid nephroid_dependencies EXPORT nephroid ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR})
install(EXPORT nephroid NAMESPACE nephroid:: DESTINATION ${NEPHROID_CMAKE_DIR} FILE nephroid-targets.cmake)
install(DIRECTORY ${PROJECT_SOURCE_DIR}/include/nephroid DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}
        FILES_MATCHING PATTERN "*.h")

# The same major version of Embree as here: its other ones have other library names.
configure_package_config_file(
  ${PROJECT_SOURCE_DIR}/cmake/nephroid-config.cmake.in ${PROJECT_BINARY_DIR}/nephroid-config.cmake
  INSTALL_DESTINATION ${NEPHROID_CMAKE_DIR} NO_SET_AND_CHECK_MACRO)
write_basic_package_version_file(${PROJECT_BINARY_DIR}/nephroid-config-version.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/nephroid-config.cmake ${PROJECT_BINARY_DIR}/nephroid-config-version.cmake
        DESTINATION ${NEPHROID_CMAKE_DIR})

install(FILES ${PROJECT_SOURCE_DIR}/docs/nephroid.1 DESTINATION ${CMAKE_INSTALL_MANDIR}/man1)
install(FILES ${PROJECT_SOURCE_DIR}/data/completion/nephroid
        DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions)
install(FILES ${PROJECT_SOURCE_DIR}/LICENSE ${PROJECT_SOURCE_DIR}/README.md ${PROJECT_SOURCE_DIR}/CHANGELOG.md
        DESTINATION ${CMAKE_INSTALL_DOCDIR})
