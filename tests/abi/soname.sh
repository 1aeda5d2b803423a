#!/bin/sh
# usage: soname.sh READELF LIBRARY HEADER: the library's SONAME ends in the ABI version that the header gives.
set -eu
version=$(sed -n 's/^#define VOX_ABI_VERSION \([0-9]*\)$/\1/p' "$3")
found=$("$1" -d "$2" | sed -n 's/.*(SONAME).*\[\(.*\)\]/\1/p')
expected=$(basename "$2" | sed 's/\.so.*//').so.$version
if [ -z "$version" ] || [ "$found" != "$expected" ]; then
    echo "$2 is called '$found', expected '$expected'"
    exit 1
fi
