# The one place for compiler flags. Every target of the project links microtrace_flags.
add_library(microtrace_flags INTERFACE)
target_compile_features(microtrace_flags INTERFACE cxx_std_20)
target_compile_options(microtrace_flags INTERFACE
  -Wall -Wextra -Wpedantic -Wshadow -Wconversion
  # a*b+c must round twice on every machine. Fused operations would make the bits depend on compiler and instruction set.
  -ffp-contract=off
  # Neither option changes a result. Without them square roots branch, and conditions can't become selections.
  -fno-math-errno -fno-trapping-math)
if(CMAKE_CXX_COMPILER_ID STREQUAL GNU AND CMAKE_CXX_COMPILER_VERSION VERSION_LESS 13)
  # GCC bug 105651: a false alarm on "text" + std::string.
  target_compile_options(microtrace_flags INTERFACE -Wno-restrict)
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
