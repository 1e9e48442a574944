# This script checks that the scenes in the repository equal the output of the program that makes them.
execute_process(COMMAND ${PROGRAM} ${WORK} COMMAND_ERROR_IS_FATAL ANY)
foreach(name draco meshopt meshopt_khr)
  execute_process(COMMAND ${CMAKE_COMMAND} -E compare_files ${WORK}/${name}.glb ${SCENES}/${name}.glb
    COMMAND_ERROR_IS_FATAL ANY)
endforeach()
