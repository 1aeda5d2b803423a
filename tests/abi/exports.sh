#!/bin/sh
# usage: exports.sh NM LIBRARY HEADER: every exported symbol is declared in the header, and the reverse. Of a DLL it is objdump
# that lists them.
set -eu
case $2 in
*.dll) exported=$("$1" -p "$2" | sed -n '/Ordinal.Name Pointer/,/^$/ s/^\t\[.*\] *//p' | sed 's/.* //' | sort) ;;
*) exported=$("$1" -D --defined-only "$2" | awk '$2 ~ /[A-Z]/ && $2 != "A" {print $3}' | sort) ;;
esac
declared=$(sed -nE 's/^VOX_(API|EXPERIMENTAL) .*[ *](vox_[a-z0-9_]+)\(.*/\2/p' "$3" | sort)
[ -n "$declared" ]
if [ "$exported" != "$declared" ]; then
    echo "exported by $2 (left) and declared in $3 (right) differ:"
    printf '%s\n' "$exported" >exported.txt
    printf '%s\n' "$declared" | diff exported.txt - || true
    exit 1
fi
