#!/bin/sh
# Every source is as clang-format 14 writes it.
cd "$1" && find include src tests bench \( -name '*.hpp' -o -name '*.cpp' \) -print0 |
  xargs -0 clang-format --dry-run --Werror
