#!/bin/sh
# run.sh PROGRAM CORPUS FOLDER: fuzzes from the committed inputs of CORPUS for REGATHER_FUZZ_SECONDS, with other inputs each time;
# for 3 s with the same inputs each time where that is not set, as CI does. New inputs that reach new code, and an input that ends
# in a crash, a hang, or too much memory, go to FOLDER; the path of the latter is printed.
set -eu
mkdir -p "$3/found"
seed=1
if [ -n "${REGATHER_FUZZ_SECONDS:-}" ]; then seed=0; fi  # libFuzzer's own choice
exec "$1" -seed="$seed" -max_total_time="${REGATHER_FUZZ_SECONDS:-2}" -timeout=10 -rss_limit_mb=1500 -max_len=65536 \
    -verbosity=0 -artifact_prefix="$3/" "$3/found" "$2"
