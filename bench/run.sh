#!/bin/sh
# run.sh BUILD_DIR: every benchmark, with repetitions; the figures of bench/README.md come from here.
set -eu
for name in bench_family bench_guides bench_keys bench_knn bench_lru bench_photons bench_ray_walks bench_rays bench_replay bench_sort bench_walks; do
    "$1/$name" --benchmark_repetitions="${REPETITIONS:-3}" --benchmark_report_aggregates_only=true
done
