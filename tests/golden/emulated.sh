#!/usr/bin/env bash
# Cross-compiles the program for another processor with the release options, runs it under emulation, and compares the
# outputs of questions.txt with those of x86-64, byte for byte. For AArch64, also the modules for codecs and OpenEXR, and the
# samples of decoded images. Debian 12 has no libraries for RISC-V, so there the program is built without modules.
#
# Needs Debian 12's g++-aarch64-linux-gnu or g++-riscv64-linux-gnu, qemu-user, and the network once, to unpack libraries into
# the folder. Installs nothing. Not part of ctest: it takes a quarter of an hour.
#
# usage: emulated.sh aarch64|riscv64 FOLDER
set -euo pipefail
processor=$1
mkdir -p "$2"
folder=$(realpath "$2")
tests=$(realpath "$(dirname "${BASH_SOURCE[0]}")")
source=$(realpath "$tests/../..")
sysroot=$folder/sysroot

triplet=$processor-linux-gnu
packages=(libglm-dev nlohmann-json3-dev libcli11-dev libtinygltf-dev libtinygltf2d libstb0)
modules=()
case $processor in
  aarch64)
    architecture=arm64
    modules=(microtrace_codecs microtrace_openexr microtrace_meshopt)
    packages+=(libpng16-16 libpng-dev libjpeg62-turbo libjpeg62-turbo-dev libwebp7 libwebp-dev zlib1g zlib1g-dev
               libzstd1 libzstd-dev libopenexr-3-1-30 libopenexr-dev libimath-3-1-29 libimath-dev) ;;
  riscv64) architecture=arm64 ;; # only headers are used
  *) sed -n 's/^# usage/usage/p' "$0" >&2; exit 2 ;;
esac
if [[ $(cat "$folder/unpacked" 2>/dev/null) != "${packages[*]}" ]]; then
  # Runs apt for another architecture, and keeps its state in the folder.
  state=$folder/apt
  mkdir -p "$state"/state/lists/partial "$state"/cache/archives/partial "$folder/packages" "$sysroot"
  : > "$state/status"
  apt=(-q -o APT::Architecture=$architecture -o APT::Architectures::=$architecture -o "Dir::State=$state/state"
       -o "Dir::State::status=$state/status" -o "Dir::Cache=$state/cache" -o APT::Sandbox::User=root)
  apt-get "${apt[@]}" update
  (cd "$folder/packages" && apt-get "${apt[@]}" download "${packages[@]}")
  for package in "$folder"/packages/*.deb; do dpkg -x "$package" "$sysroot"; done
  # Makes architecture-specific headers visible in a folder that the cross compiler searches.
  ln -sf aarch64-linux-gnu/jconfig.h "$sysroot/usr/include/jconfig.h"
  echo "${packages[*]}" > "$folder/unpacked"
fi

libraries=$sysroot/usr/lib/$triplet
cat > "$folder/toolchain.cmake" <<END
set(CMAKE_SYSTEM_NAME Linux)
set(CMAKE_SYSTEM_PROCESSOR $processor)
set(CMAKE_LIBRARY_ARCHITECTURE aarch64-linux-gnu)
set(CMAKE_CXX_COMPILER $triplet-g++)
set(CMAKE_FIND_ROOT_PATH $sysroot /usr/$triplet)
set(CMAKE_FIND_ROOT_PATH_MODE_PROGRAM NEVER)
set(CMAKE_FIND_ROOT_PATH_MODE_LIBRARY ONLY)
set(CMAKE_FIND_ROOT_PATH_MODE_INCLUDE ONLY)
set(CMAKE_FIND_ROOT_PATH_MODE_PACKAGE ONLY)
set(CMAKE_EXE_LINKER_FLAGS_INIT "-Wl,-rpath-link,$libraries:$sysroot/lib/$triplet")
set(CMAKE_SHARED_LINKER_FLAGS_INIT "-Wl,-rpath-link,$libraries:$sysroot/lib/$triplet")
set(CMAKE_MODULE_LINKER_FLAGS_INIT "-Wl,-rpath-link,$libraries:$sysroot/lib/$triplet")
END
cmake -S "$source" -B "$folder/build" -G Ninja --toolchain "$folder/toolchain.cmake" -DCMAKE_BUILD_TYPE=Release \
  -DMICROTRACE_BUILD_TESTS=OFF -DMICROTRACE_BUILD_BENCHMARKS=OFF -DMICROTRACE_WITH_OPENIMAGEIO=OFF -DMICROTRACE_WITH_DRACO=OFF \
  -DMICROTRACE_WITH_HTTP=OFF -DMICROTRACE_WITH_MANUAL=OFF -DTinyGLTF_DIR="$sysroot/usr/lib/aarch64-linux-gnu/cmake/TinyGLTF" $([[ ${#modules[@]} -gt 0 ]] ||
  echo -DMICROTRACE_WITH_OPENEXR=OFF -DMICROTRACE_WITH_CODECS=OFF) > "$folder/configure.log"
cmake --build "$folder/build" --target microtrace "${modules[@]}"

module_folder=$folder/build/src/lib/microtrace
# Writes a script that runs a program of the other architecture.
emulate() {
  cat > "$folder/$1" <<END
#!/bin/sh
exec qemu-$processor -L /usr/$triplet -E "LD_LIBRARY_PATH=$libraries:$sysroot/lib/$triplet" \\
  -E "MICROTRACE_MODULE_PATH=$module_folder" "$2" "\$@"
END
  chmod +x "$folder/$1"
}

emulate microtrace "$folder/build/src/cli/microtrace"
if [[ ${#modules[@]} -eq 0 ]]; then
  exec python3 -B "$tests/pinned_test.py" "$folder/microtrace" --threads 2 --without-modules
fi
"$triplet-g++" -std=c++20 -O1 -I"$source/src" "$tests/decode_images.cpp" -o "$folder/decode_images.$processor" -ldl
emulate decode_images "$folder/decode_images.$processor"

failed=0
python3 -B "$tests/decoders_test.py" "$folder/decode_images" "$module_folder/microtrace_codecs.so" || failed=1
python3 -B "$tests/pinned_test.py" "$folder/microtrace" --threads 2 || failed=1
exit "$failed"
