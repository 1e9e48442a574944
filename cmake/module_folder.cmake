# microtrace_add_module_folder(TARGET FOLDER) compiles the path of the modules' folder into an object. A program in any
# folder finds the modules if it links this object and the static library.
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
