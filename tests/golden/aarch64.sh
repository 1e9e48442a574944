#!/usr/bin/env bash
# Cross-compiles the program and its modules for codecs and OpenEXR for AArch64 with the release options, runs them under
# emulation and compares the outputs of questions.txt and the samples of decoded images with those of x86-64, byte for byte.
#
# Needs Debian 12's g++-aarch64-linux-gnu and qemu-user, and the network once, to unpack AArch64 libraries into the folder.
# Installs nothing. Not part of ctest: it takes a quarter of an hour.
#
# usage: aarch64.sh FOLDER
set -euo pipefail
mkdir -p "$1"
folder=$(realpath "$1")
tests=$(realpath "$(dirname "${BASH_SOURCE[0]}")")
source=$(realpath "$tests/../..")
sysroot=$folder/sysroot

packages=(libpng16-16 libpng-dev libjpeg62-turbo libjpeg62-turbo-dev libwebp7 libwebp-dev zlib1g zlib1g-dev
          libzstd1 libzstd-dev libopenexr-3-1-30 libopenexr-dev libimath-3-1-29 libimath-dev
          libglm-dev nlohmann-json3-dev libcli11-dev libtinygltf-dev libtinygltf2d libstb0)
if [[ $(cat "$folder/unpacked" 2>/dev/null) != "${packages[*]}" ]]; then
  # Runs apt for another architecture, and keeps its state in the folder.
  state=$folder/apt
  mkdir -p "$state"/state/lists/partial "$state"/cache/archives/partial "$folder/packages" "$sysroot"
  : > "$state/status"
  apt=(-q -o APT::Architecture=arm64 -o APT::Architectures::=arm64 -o "Dir::State=$state/state"
       -o "Dir::State::status=$state/status" -o "Dir::Cache=$state/cache" -o APT::Sandbox::User=root)
  apt-get "${apt[@]}" update
  (cd "$folder/packages" && apt-get "${apt[@]}" download "${packages[@]}")
  for package in "$folder"/packages/*.deb; do dpkg -x "$package" "$sysroot"; done
  # Makes architecture-specific headers visible in a folder that the cross compiler searches.
  ln -sf aarch64-linux-gnu/jconfig.h "$sysroot/usr/include/jconfig.h"
  echo "${packages[*]}" > "$folder/unpacked"
fi

libraries=$sysroot/usr/lib/aarch64-linux-gnu
cat > "$folder/toolchain.cmake" <<END
set(CMAKE_SYSTEM_NAME Linux)
set(CMAKE_SYSTEM_PROCESSOR aarch64)
set(CMAKE_LIBRARY_ARCHITECTURE aarch64-linux-gnu)
set(CMAKE_CXX_COMPILER aarch64-linux-gnu-g++)
set(CMAKE_FIND_ROOT_PATH $sysroot /usr/aarch64-linux-gnu)
set(CMAKE_FIND_ROOT_PATH_MODE_PROGRAM NEVER)
set(CMAKE_FIND_ROOT_PATH_MODE_LIBRARY ONLY)
set(CMAKE_FIND_ROOT_PATH_MODE_INCLUDE ONLY)
set(CMAKE_FIND_ROOT_PATH_MODE_PACKAGE ONLY)
set(CMAKE_EXE_LINKER_FLAGS_INIT "-Wl,-rpath-link,$libraries:$sysroot/lib/aarch64-linux-gnu")
set(CMAKE_SHARED_LINKER_FLAGS_INIT "-Wl,-rpath-link,$libraries:$sysroot/lib/aarch64-linux-gnu")
set(CMAKE_MODULE_LINKER_FLAGS_INIT "-Wl,-rpath-link,$libraries:$sysroot/lib/aarch64-linux-gnu")
END
cmake -S "$source" -B "$folder/build" -G Ninja --toolchain "$folder/toolchain.cmake" -DCMAKE_BUILD_TYPE=Release \
  -DMICROTRACE_BUILD_TESTS=OFF -DMICROTRACE_BUILD_BENCHMARKS=OFF -DMICROTRACE_WITH_OPENIMAGEIO=OFF -DMICROTRACE_WITH_DRACO=OFF \
  -DMICROTRACE_WITH_HTTP=OFF -DMICROTRACE_WITH_MANUAL=OFF > "$folder/configure.log"
cmake --build "$folder/build" --target microtrace microtrace_codecs microtrace_openexr microtrace_meshopt

modules=$folder/build/src/lib/microtrace
# Writes a script that runs a program of the other architecture.
emulate() {
  cat > "$folder/$1" <<END
#!/bin/sh
exec qemu-aarch64 -L /usr/aarch64-linux-gnu -E "LD_LIBRARY_PATH=$libraries:$sysroot/lib/aarch64-linux-gnu" \\
  -E "MICROTRACE_MODULE_PATH=$modules" "$2" "\$@"
END
  chmod +x "$folder/$1"
}

emulate microtrace "$folder/build/src/cli/microtrace"
aarch64-linux-gnu-g++ -std=c++20 -O1 -I"$source/src" "$tests/decode_images.cpp" -o "$folder/decode_images.aarch64" -ldl
emulate decode_images "$folder/decode_images.aarch64"

failed=0
python3 -B "$tests/decoders_test.py" "$folder/decode_images" "$modules/microtrace_codecs.so" || failed=1
python3 -B "$tests/pinned_test.py" "$folder/microtrace" --threads 2 || failed=1
exit "$failed"
