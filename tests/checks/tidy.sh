#!/bin/sh
# tidy.sh SOURCE BUILD: clang-tidy with .clang-tidy over the folders whose mistakes no picture shows: what reads files, what is
# walked, ordered, counted. BUILD is a build by clang 14 with CMAKE_UNITY_BUILD: its units, most of whose time goes into headers,
# and its precompiled headers are what is looked at.
set -eu
build=$(realpath "$2")
units=
for folder in trace spatial meshes reorder cachesim replay; do
    of_folder=$(find "$build/CMakeFiles/regather_$folder.dir/Unity" -name '*_cxx.cxx')
    sources=$(find "$1/$folder" -name '*.cpp' | wc -l)
    looked_at=$(cat $of_folder | grep -c "^#include \".*/$folder/.*\.cpp\"")
    if [ "$looked_at" -ne "$sources" ]; then
        echo "$folder: $looked_at files in the units of $build, expected $sources" >&2
        exit 1
    fi
    units="$units $of_folder"
done
printf '%s\n' $units | xargs -P "$(nproc)" -n 1 clang-tidy-14 -quiet -p "$build"
