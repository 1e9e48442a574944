#!/usr/bin/env bash
# Cross-builds the program for AArch64, runs it under emulation and compares its pictures with this machine's, byte for byte.
# Needs Debian's g++-aarch64-linux-gnu and qemu-user. Not part of ctest: it takes some minutes.
#
# usage: aarch64.sh PROGRAM BUILD_FOLDER
set -euo pipefail
program=$(realpath "$1")
mkdir -p "$2"
folder=$(realpath "$2")
source=$(realpath "$(dirname "${BASH_SOURCE[0]}")/../..")

# The libraries are headers, or become so; /usr/include itself belongs to this machine's C library.
mkdir -p "$folder/include" "$folder/objects"
for name in glm nlohmann CLI tiny_gltf.h; do ln -sfn "/usr/include/$name" "$folder/include/$name"; done
cat > "$folder/tinygltf.cpp" <<'END'
#define TINYGLTF_IMPLEMENTATION
#define TINYGLTF_NO_INCLUDE_JSON
#include <nlohmann/json.hpp>
#include <tiny_gltf.h>
END

compile() {
  aarch64-linux-gnu-g++ -std=c++20 -O2 -ffp-contract=off -c "$1" -o "$2" -I"$source/include" -I"$source/src" \
    -isystem "$folder/include" -DMICROTRACE_VERSION='"aarch64"' -DMICROTRACE_MODULES_FROM_PROGRAM='""' \
    -DMICROTRACE_INSTALLED_MODULES='""' -DMICROTRACE_BUILT_MODULES='""' \
    -DTINYGLTF_NO_STB_IMAGE -DTINYGLTF_NO_STB_IMAGE_WRITE
}
export -f compile
export source folder
cd "$source/src"
find . -name '*.cpp' ! -path './modules/*' ! -name 'avx*' -printf '%P\n' | while read -r file; do
  echo "$source/src/$file $folder/objects/$(echo "$file" | tr '/' '_').o"
done > "$folder/units"
echo "$folder/tinygltf.cpp $folder/objects/tinygltf.o" >> "$folder/units"
xargs -P "$(nproc)" -L 1 bash -c 'compile "$0" "$1"' < "$folder/units"
aarch64-linux-gnu-g++ -static "$folder"/objects/*.o -o "$folder/microtrace"

cd "$source/scenes"
failed=0
export MICROTRACE_MODULE_PATH=/nowhere  # the emulated program has no modules: textures are white in both
for scene in *.json degenerate/*.json gltf/*.glb; do
  options=(-q)
  [[ $scene == *.glb ]] && options+=(--spp 2)  # with light, which emulation makes slow
  native=$("$program" "${options[@]}" "$scene" -o - | sha256sum)
  emulated=$(qemu-aarch64 "$folder/microtrace" "${options[@]}" "$scene" -o - | sha256sum)
  if [[ $native == "$emulated" ]]; then
    echo "same bytes: $scene"
  else
    echo "DIFFERENT:  $scene"
    failed=1
  fi
done
exit "$failed"
