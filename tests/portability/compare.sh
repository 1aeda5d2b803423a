#!/bin/sh
# compare.sh EXPECTED COMMAND...: the command prints what the file EXPECTED holds.
set -eu
expected=$1
shift
actual=$(mktemp)
trap 'rm -f "$actual"' EXIT
"$@" >"$actual"
if ! cmp -s "$expected" "$actual"; then
    echo "different hashes: $*" >&2
    diff "$expected" "$actual" >&2 || true
    exit 1
fi
echo "the same hashes: $*"
