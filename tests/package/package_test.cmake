# A script: what a user of the installed package does. Fails by FATAL_ERROR.
cmake_minimum_required(VERSION 3.25)

function(run)
  execute_process(COMMAND ${ARGN} RESULT_VARIABLE status OUTPUT_VARIABLE output ERROR_VARIABLE output)
  if(NOT status EQUAL 0)
    message(FATAL_ERROR "${ARGN}\nends with ${status}:\n${output}")
  endif()
  set(output "${output}" PARENT_SCOPE)
endfunction()

file(REMOVE_RECURSE ${WORK})
file(MAKE_DIRECTORY ${WORK})
# Moved after it is installed: nothing in it may depend on where it was meant to lie.
run(${CMAKE_COMMAND} --install ${BUILD} --prefix ${WORK}/installed)
file(RENAME ${WORK}/installed ${WORK}/moved)

run(${CMAKE_COMMAND} -S ${SOURCE}/tests/package/consumer -B ${WORK}/consumer -G ${GENERATOR}
  -DCMAKE_PREFIX_PATH=${WORK}/moved -DCMAKE_CXX_COMPILER=${COMPILER} -DCMAKE_CXX_FLAGS=${FLAGS}
  -DCMAKE_BUILD_TYPE=Release)
run(${CMAKE_COMMAND} --build ${WORK}/consumer)
run(${WORK}/consumer/consumer ${WORK}/consumer.ppm)

set(program ${WORK}/moved/${BINDIR}/microtrace)
run(${program} --version)
run(${program} ${SOURCE}/scenes/perspective1.json --size 64x48 -q -o ${WORK}/picture.ppm)
# The dynamic linker says which module was loaded: the build tree holds one, too.
foreach(module ${MODULES})
  set(picture ${WORK}/picture.png)
  if(module STREQUAL openimageio)
    set(picture ${WORK}/picture.tif)
  endif()
  run(${CMAKE_COMMAND} -E env --unset=MICROTRACE_MODULE_PATH LD_DEBUG=files
    ${program} ${SOURCE}/scenes/perspective1.json --size 64x48 -q -o ${picture})
  if(NOT output MATCHES "calling init: ${WORK}/moved/${MODULE_FOLDER}/microtrace_${module}.so")
    message(FATAL_ERROR "the installed program did not load its own module ${module}")
  endif()
  file(SIZE ${picture} size)
  if(size LESS 100)
    message(FATAL_ERROR "${picture} is no picture")
  endif()
endforeach()
