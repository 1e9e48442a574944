# What `cmake --install` puts where, beside the modules, and the package that find_package(microtrace) finds.
include(CMakePackageConfigHelpers)
set(microtrace_package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/microtrace)

install(TARGETS microtrace)
install(TARGETS microtrace_library EXPORT microtraceTargets)
install(DIRECTORY include/microtrace TYPE INCLUDE FILES_MATCHING PATTERN *.hpp)
install(DIRECTORY docs/ TYPE DOC FILES_MATCHING PATTERN *.md PATTERN *.json)

install(EXPORT microtraceTargets NAMESPACE microtrace:: DESTINATION ${microtrace_package_dir})
configure_package_config_file(cmake/microtraceConfig.cmake.in
  ${PROJECT_BINARY_DIR}/microtraceConfig.cmake
  INSTALL_DESTINATION ${microtrace_package_dir})
write_basic_package_version_file(${PROJECT_BINARY_DIR}/microtraceConfigVersion.cmake
  COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/microtraceConfig.cmake
              ${PROJECT_BINARY_DIR}/microtraceConfigVersion.cmake
  DESTINATION ${microtrace_package_dir})
