#!/bin/sh
# usage: exports.sh NM LIBRARY HEADER...: every exported symbol is declared in a header, and the reverse. Of a DLL it is objdump
# that lists them.
set -eu
nm=$1 library=$2
shift 2
case $library in
*.dll) exported=$("$nm" -p "$library" | sed -n '/Ordinal.Name Pointer/,/^$/ s/^\t\[.*\] *//p' | sed 's/.* //' | sort) ;;
*) exported=$("$nm" -D --defined-only "$library" | awk '$2 ~ /[A-Z]/ && $2 != "A" {print $3}' | sort) ;;
esac
declared=$(sed -nE 's/^VOX_(API|EXPERIMENTAL) .*[ *](vox_[a-z0-9_]+)\(.*/\2/p' "$@" | sort)
[ -n "$declared" ]
if [ "$exported" != "$declared" ]; then
    echo "exported by $library (left) and declared in $* (right) differ:"
    printf '%s\n' "$exported" >exported.txt
    printf '%s\n' "$declared" | diff exported.txt - || true
    exit 1
fi
