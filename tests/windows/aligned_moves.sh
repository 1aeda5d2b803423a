#!/bin/sh
# usage: aligned_moves.sh OBJDUMP LIBRARY: no move of 32 or 64 bytes wants memory to be aligned, as gcc's stack on Windows is not
# (cmake/vox_target.cmake).
set -eu
listing=$("$1" -d --no-show-raw-insn "$2" | grep '%[yz]mm') || { echo "$2 has no AVX"; exit 1; }
aligned=$(printf '%s\n' "$listing" | grep -E 'vmov(ap[sd]|dqa(32|64)?) .*(%[yz]mm.*\(|\(.*%[yz]mm)' || true)
[ -z "$aligned" ] || { printf '%s\n' "$aligned"; exit 1; }
