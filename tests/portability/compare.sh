#!/bin/sh
# compare.sh EXPECTED COMMAND...: the command prints what the file EXPECTED holds; on Windows with carriage returns.
set -eu
expected=$1
shift
actual=$(mktemp)
trap 'rm -f "$actual"' EXIT
"$@" >"$actual"
if ! tr -d '\r' <"$actual" | cmp -s "$expected" -; then
    echo "different hashes: $*" >&2
    diff --strip-trailing-cr "$expected" "$actual" >&2 || true
    exit 1
fi
echo "the same hashes: $*"
