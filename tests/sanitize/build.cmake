# This script builds targets with a sanitizer preset in a separate folder.
#   SOURCE   the project
#   BUILD    the folder
#   PRESET   fuzz or tsan
#   OPTIONS  further options of CMake
#   TARGETS  the targets
cmake_minimum_required(VERSION 3.25)

function(run)
  execute_process(COMMAND ${ARGN} WORKING_DIRECTORY ${SOURCE}
    RESULT_VARIABLE status OUTPUT_VARIABLE output ERROR_VARIABLE output)
  if(NOT status EQUAL 0)
    message(FATAL_ERROR "${ARGN}\nends with ${status}:\n${output}")
  endif()
endfunction()

run(${CMAKE_COMMAND} --preset ${PRESET} -B ${BUILD} ${OPTIONS})
run(${CMAKE_COMMAND} --build ${BUILD} --target ${TARGETS})
