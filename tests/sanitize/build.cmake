# This script builds targets with a sanitizer preset in a separate folder.
#   SOURCE   the project
#   BUILD    the folder
#   PRESET   fuzz or tsan
#   LEVEL    the level of optimization, such as -O1
#   TARGETS  the targets
cmake_minimum_required(VERSION 3.25)

function(run)
  execute_process(COMMAND ${ARGN} WORKING_DIRECTORY ${SOURCE}
    RESULT_VARIABLE status OUTPUT_VARIABLE output ERROR_VARIABLE output)
  if(NOT status EQUAL 0)
    message(FATAL_ERROR "${ARGN}\nends with ${status}:\n${output}")
  endif()
endfunction()

# Omits the presets' line numbers (-g1), an eighth of the time, and all but the portable kernels, another eighth. A failure
# happens again in a build of the preset itself. Suites under the address sanitizer run all kernels.
run(${CMAKE_COMMAND} --preset ${PRESET} -B ${BUILD} "-DCMAKE_CXX_FLAGS_RELWITHDEBINFO=${LEVEL} -DNDEBUG"
  -DMICROTRACE_WITH_AVX=OFF)
run(${CMAKE_COMMAND} --build ${BUILD} --target ${TARGETS})
