#!/bin/sh
# run.sh FUZZER CORPUS: runs one fuzzer for FUZZ_SECONDS (default 3) over its checked-in corpus. New inputs stay in a
# folder beside the fuzzer; the corpus itself is only read.
set -eu
found="$1.found"
mkdir -p "$found"
exec "$1" -max_total_time="${FUZZ_SECONDS:-3}" -rss_limit_mb=1024 -malloc_limit_mb=256 -timeout=10 -max_len=16384 \
    -artifact_prefix="$found/" -print_final_stats=0 -verbosity=0 "$found" "$2"
