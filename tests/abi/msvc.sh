#!/bin/sh
# usage: msvc.sh CLANG INCLUDE: the C headers pass clang in its disguise as MSVC, as C and as C++, for users and for those who
# build the DLL. No SDK is needed: they include <stddef.h> and <stdint.h> alone.
set -eu
clang=$1 include=$2
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
for header in vox vox_query vox_cell_size vox_surface vox_io vox_sim; do
    echo "#include <vox/$header.h>" >"$scratch/$header.c"
    for language in /TC /TP; do
        for macro in VOX_USER VOX_BUILD VOX_STATIC; do
            "$clang" --driver-mode=cl --target=x86_64-pc-windows-msvc -Xclang -ffreestanding -Xclang -pedantic-errors /Zs /W4 /WX "$language" \
                "/D$macro" "/I$include" "$scratch/$header.c"
        done
    done
done
