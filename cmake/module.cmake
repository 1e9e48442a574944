# The path of the modules' folder relative to the program's folder is the same in the build folder and after installation.
# The shared library looks for modules in microtrace/ beside itself (src/io/module_folders.hpp).
file(RELATIVE_PATH microtrace_modules_from_program ${CMAKE_INSTALL_FULL_BINDIR} ${CMAKE_INSTALL_FULL_LIBDIR}/microtrace)
cmake_path(SET microtrace_module_dir NORMALIZE ${PROJECT_BINARY_DIR}/src/cli/${microtrace_modules_from_program})

# The loader knows only one name of each module.
foreach(config ${CMAKE_BUILD_TYPE})
  string(TOUPPER ${config} config)
  set(CMAKE_${config}_POSTFIX "")
endforeach()

# microtrace_module(NAME SOURCE...) builds a shared object that the library loads on first use.
function(microtrace_module name)
  set(target microtrace_${name})
  add_library(${target} MODULE ${ARGN})
  set_target_properties(${target} PROPERTIES
    PREFIX "" LIBRARY_OUTPUT_DIRECTORY ${microtrace_module_dir}
    CXX_VISIBILITY_PRESET hidden VISIBILITY_INLINES_HIDDEN ON)
  target_include_directories(${target} PRIVATE ${PROJECT_SOURCE_DIR}/src)
  target_link_libraries(${target} PRIVATE microtrace_flags)
  add_dependencies(microtrace_all ${target})
  set_property(GLOBAL APPEND PROPERTY microtrace_modules ${name})
  install(TARGETS ${target} LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR}/microtrace)
endfunction()

# Programs of this build that are not installed, such as tests, may be in any folder. They link the path of the modules'
# folder.
include(${CMAKE_CURRENT_LIST_DIR}/module_folder.cmake)
microtrace_add_module_folder(microtrace_built_modules ${microtrace_module_dir})
