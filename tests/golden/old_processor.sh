#!/bin/sh
# Runs a program, $MICROTRACE_EMULATED, under the emulation of a processor of 2008, which has neither AVX nor FMA.
exec qemu-x86_64 -cpu Nehalem "$MICROTRACE_EMULATED" "$@"
