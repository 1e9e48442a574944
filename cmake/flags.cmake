# Compiler flags are set only here. Every target of the project links microtrace_flags.
if((CMAKE_CXX_COMPILER_ID STREQUAL GNU AND CMAKE_CXX_COMPILER_VERSION VERSION_LESS 12)
   OR (CMAKE_CXX_COMPILER_ID STREQUAL Clang AND CMAKE_CXX_COMPILER_VERSION VERSION_LESS 14))
  message(FATAL_ERROR "microtrace needs GCC 12 or Clang 14 or later, and this is ${CMAKE_CXX_COMPILER_ID} "
                      "${CMAKE_CXX_COMPILER_VERSION}: choose another compiler, as by -DCMAKE_CXX_COMPILER=g++-12")
endif()
add_library(microtrace_flags INTERFACE)
target_compile_features(microtrace_flags INTERFACE cxx_std_20)
if(PROJECT_IS_TOP_LEVEL)
  target_compile_options(microtrace_flags INTERFACE -Wall -Wextra -Wpedantic -Wshadow -Wconversion)
endif()
target_compile_options(microtrace_flags INTERFACE
  # A project that contains this one may have enabled these.
  -fno-fast-math -fno-finite-math-only -fno-associative-math -fno-reciprocal-math -fsigned-zeros -fno-lto
  # a*b+c must round twice on every machine. Fused multiply-adds would make results depend on the compiler and the
  # instruction set.
  -ffp-contract=off
  # These options don't change results. Without them, compilers must add branches to square roots
  # and can't vectorize conditional expressions.
  -fno-math-errno -fno-trapping-math)
if(CMAKE_CXX_COMPILER_ID STREQUAL GNU)
  # With this optimization, which -O2 includes too, GCC 12.2 for AArch64 writes old values over members that a short loop
  # has stored: packets of rays miss triangles, because set_beams() computes wrong beams.
  target_compile_options(microtrace_flags INTERFACE -fno-predictive-commoning)
  # With this optimization, GCC 12.2 omits the rounding of double(float(x)) where it converts two numbers at a time
  # (tests/unit/math/conversions_test.cpp).
  target_compile_options(microtrace_flags INTERFACE -fno-tree-slp-vectorize)
  # Objcopy can't make unique symbols local (src/CMakeLists.txt).
  target_compile_options(microtrace_flags INTERFACE -fno-gnu-unique)
endif()
if(CMAKE_CXX_COMPILER_ID STREQUAL GNU AND CMAKE_CXX_COMPILER_VERSION VERSION_LESS 13)
  # Disables GCC's false warnings on "text" + std::string (GCC bug 105651), and on the members that a std::variant doesn't
  # hold.
  target_compile_options(microtrace_flags INTERFACE -Wno-restrict -Wno-maybe-uninitialized)
elseif(CMAKE_CXX_COMPILER_ID STREQUAL GNU)
  # Disables false warnings on references into an object that a function got with a temporary std::string_view.
  target_compile_options(microtrace_flags INTERFACE -Wno-dangling-reference)
endif()
# For code that runs once, such as that which reads the command line: less than half the size.
add_library(microtrace_small_code INTERFACE)
target_compile_options(microtrace_small_code INTERFACE $<$<CONFIG:Release>:-Os>)
if(NOT CMAKE_SYSTEM_PROCESSOR MATCHES "x86_64|AMD64")
  set(MICROTRACE_WITH_AVX OFF)
endif()
if(MICROTRACE_WITH_AVX)
  target_compile_definitions(microtrace_flags INTERFACE MICROTRACE_WITH_AVX)
endif()
if(MICROTRACE_FUZZ)
  target_compile_options(microtrace_flags INTERFACE -fsanitize=fuzzer-no-link)
  target_link_options(microtrace_flags INTERFACE -fsanitize=fuzzer-no-link)
endif()
if(MICROTRACE_SANITIZE STREQUAL address)
  set(MICROTRACE_SANITIZE_FLAGS -fsanitize=address,undefined)
elseif(MICROTRACE_SANITIZE STREQUAL thread)
  set(MICROTRACE_SANITIZE_FLAGS -fsanitize=thread)
elseif(MICROTRACE_SANITIZE)
  message(FATAL_ERROR "MICROTRACE_SANITIZE is ${MICROTRACE_SANITIZE}, not address or thread")
endif()
if(MICROTRACE_SANITIZE)
  target_compile_options(microtrace_flags INTERFACE
    ${MICROTRACE_SANITIZE_FLAGS} -fno-sanitize-recover=all -fno-omit-frame-pointer)
  target_link_options(microtrace_flags INTERFACE ${MICROTRACE_SANITIZE_FLAGS})
endif()
