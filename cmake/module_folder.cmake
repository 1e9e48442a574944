# microtrace_add_module_folder(TARGET FOLDER): makes an object that tells programs, which are linked with it and with the static
# library, of a folder with the library's modules. They may lie anywhere else.
function(microtrace_add_module_folder target folder)
  set(source ${CMAKE_CURRENT_BINARY_DIR}/${target}.cpp)
  file(CONFIGURE OUTPUT ${source} @ONLY CONTENT [[
extern "C" {
extern const char microtrace_module_folder[];
const char microtrace_module_folder[] = R"folder(@folder@)folder";
}
]])
  add_library(${target} OBJECT ${source})
  set_target_properties(${target} PROPERTIES POSITION_INDEPENDENT_CODE ON)
endfunction()
