#!/bin/sh
# Checks that every source is formatted by clang-format 14, which ./test installs.
cd "$1" && PATH=$PWD/build/python-venv/bin:$PATH && find include src tests bench python \( -name '*.hpp' -o -name '*.cpp' \) -print0 |
  xargs -0 clang-format --dry-run --Werror
