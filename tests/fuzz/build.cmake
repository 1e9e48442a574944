# A script: builds the fuzz targets by the preset "fuzz" in a folder of their own, where Clang and its libFuzzer are there.
cmake_minimum_required(VERSION 3.25)

function(run)
  execute_process(COMMAND ${ARGN} WORKING_DIRECTORY ${SOURCE}
    RESULT_VARIABLE status OUTPUT_VARIABLE output ERROR_VARIABLE output)
  if(NOT status EQUAL 0)
    message(FATAL_ERROR "${ARGN}\nends with ${status}:\n${output}")
  endif()
endfunction()

file(MAKE_DIRECTORY ${BUILD})
file(WRITE ${BUILD}/probe.cpp "extern \"C\" int LLVMFuzzerTestOneInput(const unsigned char*, unsigned long) { return 0; }\n")
execute_process(COMMAND clang++ -fsanitize=fuzzer,address,undefined ${BUILD}/probe.cpp -o ${BUILD}/probe
  RESULT_VARIABLE status OUTPUT_QUIET ERROR_QUIET)
if(NOT status EQUAL 0)
  message("skipped: there is no libFuzzer here")
  return()
endif()
run(${CMAKE_COMMAND} --preset fuzz -B ${BUILD})
run(${CMAKE_COMMAND} --build ${BUILD} --target fuzz_json_scene fuzz_gltf fuzz_image)
