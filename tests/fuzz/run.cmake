# This script fuzzes one format for some seconds. It fails by FATAL_ERROR.
#   BUILD    the build folder of the preset "fuzz"
#   FORMAT   one of formats.cmake
#   SECONDS  duration
#   SEED     seed of the mutations, 0 for a random one
cmake_minimum_required(VERSION 3.25)

set(program ${BUILD}/tests/fuzz/fuzz_${FORMAT})
set(work ${BUILD}/tests/fuzz/${FORMAT})
file(MAKE_DIRECTORY ${work}/corpus ${work}/findings)
# An allocation of more than 256 MiB is a finding, because files have only a few KiB. A run of more than a minute is one too:
# even busy machines take less. Entropic scheduling (-entropic) would take half of the time or more, because most inputs reach
# new counts of branches.
execute_process(
  COMMAND ${program} ${work}/corpus ${BUILD}/tests/fuzz/seeds/${FORMAT}
    -dict=${BUILD}/tests/fuzz/seeds/${FORMAT}.dict -artifact_prefix=${work}/findings/
    -seed=${SEED} -max_total_time=${SECONDS} -max_len=16384 -timeout=60 -rss_limit_mb=2048 -malloc_limit_mb=256
    -entropic=0 -print_final_stats=1 -verbosity=1
  RESULT_VARIABLE status OUTPUT_VARIABLE output ERROR_VARIABLE output)
if(NOT status EQUAL 0)
  message(FATAL_ERROR "${output}\n${program} ended with ${status}; its input is in ${work}/findings")
endif()
string(REGEX MATCHALL "stat::[^\n]*" statistics "${output}")
string(REPLACE ";" "\n" statistics "${statistics}")
message("${FORMAT}:\n${statistics}")
