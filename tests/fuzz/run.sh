#!/bin/sh
# run.sh FUZZER FOUND CORPUS: runs one fuzzer for FUZZ_SECONDS (default 3) over its checked-in corpus, which is only read. New
# inputs stay in FOUND.
set -eu
mkdir -p "$2"
exec "$1" -max_total_time="${FUZZ_SECONDS:-3}" -rss_limit_mb=1024 -malloc_limit_mb=256 -timeout=10 -max_len=16384 \
    -artifact_prefix="$2/" -print_final_stats=0 -verbosity=0 "$2" "$3"
