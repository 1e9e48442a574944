# Installs everything except for modules, and makes the package for find_package(microtrace).
include(CMakePackageConfigHelpers)

# Below another project, the folder for documentation is the other project's.
set(microtrace_doc_dir ${CMAKE_INSTALL_DOCDIR})
if(NOT PROJECT_IS_TOP_LEVEL)
  set(microtrace_doc_dir ${CMAKE_INSTALL_DATAROOTDIR}/doc/microtrace)
endif()
set(microtrace_package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/microtrace)

# Installs one of the two libraries by default. `cmake --install --component shared` or `static` installs the other one.
set(unless_shared EXCLUDE_FROM_ALL)
set(unless_static)
if(BUILD_SHARED_LIBS)
  set(unless_shared)
  set(unless_static EXCLUDE_FROM_ALL)
endif()
foreach(kind shared static)
  install(TARGETS microtrace_${kind} EXPORT microtrace_${kind}
    ARCHIVE COMPONENT ${kind} ${unless_${kind}} LIBRARY COMPONENT ${kind} ${unless_${kind}})
  install(EXPORT microtrace_${kind} NAMESPACE microtrace:: DESTINATION ${microtrace_package_dir} COMPONENT ${kind} ${unless_${kind}})
endforeach()

install(TARGETS microtrace)
install(DIRECTORY include/microtrace TYPE INCLUDE FILES_MATCHING PATTERN *.hpp PATTERN *.h)
# Uses the folders of the repository, so that links between pages remain valid.
install(FILES README.md CHANGELOG.md CONTRIBUTING.md LICENSE DESTINATION ${microtrace_doc_dir})
install(FILES third_party/NOTICES.md DESTINATION ${microtrace_doc_dir}/third_party)
install(FILES third_party/meshoptimizer/LICENSE DESTINATION ${microtrace_doc_dir}/third_party/meshoptimizer)
install(FILES python/README.md DESTINATION ${microtrace_doc_dir}/python)
install(DIRECTORY python/notebooks DESTINATION ${microtrace_doc_dir}/python)
install(DIRECTORY docs DESTINATION ${microtrace_doc_dir} PATTERN CMakeLists.txt EXCLUDE PATTERN *.scd EXCLUDE)

# Debian requires one file of this name, which systems without other documentation keep.
set(microtrace_copyright)
foreach(file LICENSE third_party/NOTICES.md third_party/meshoptimizer/LICENSE)
  file(READ ${file} text)
  string(APPEND microtrace_copyright "${text}\n")
endforeach()
file(CONFIGURE OUTPUT ${PROJECT_BINARY_DIR}/copyright CONTENT "${microtrace_copyright}" @ONLY)
install(FILES ${PROJECT_BINARY_DIR}/copyright DESTINATION ${microtrace_doc_dir})

set(microtrace_modules_dir ${CMAKE_INSTALL_LIBDIR}/microtrace)
configure_package_config_file(cmake/microtraceConfig.cmake.in
  ${PROJECT_BINARY_DIR}/microtraceConfig.cmake
  INSTALL_DESTINATION ${microtrace_package_dir} PATH_VARS microtrace_modules_dir)
write_basic_package_version_file(${PROJECT_BINARY_DIR}/microtraceConfigVersion.cmake
  COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/microtraceConfig.cmake
              ${PROJECT_BINARY_DIR}/microtraceConfigVersion.cmake
              cmake/module_folder.cmake
  DESTINATION ${microtrace_package_dir})

# For other build systems. The C++ headers also need GLM, which has no libraries.
file(RELATIVE_PATH microtrace_prefix_from_pc ${CMAKE_INSTALL_FULL_LIBDIR}/pkgconfig ${CMAKE_INSTALL_PREFIX})
file(RELATIVE_PATH microtrace_includes_from_pc ${CMAKE_INSTALL_FULL_LIBDIR}/pkgconfig ${CMAKE_INSTALL_FULL_INCLUDEDIR})
configure_file(cmake/microtrace.pc.in ${PROJECT_BINARY_DIR}/microtrace.pc @ONLY)
install(FILES ${PROJECT_BINARY_DIR}/microtrace.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig)
