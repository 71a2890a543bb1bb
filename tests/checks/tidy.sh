#!/bin/sh
# tidy.sh SOURCE BUILD: clang-tidy with .clang-tidy over the folders whose mistakes no picture shows: what reads files, what is
# walked, ordered, counted. BUILD is a build by clang 14: its precompiled headers are read in place of the text.
# tidy.sh SOURCE BUILD GROUP: over the files that GROUP includes.
# Most of the time goes into the headers. So seven files are looked at as one; where they do not compile as one (two give a name of
# their own to different things), or anything is found, half of them at a time, down to single ones.
set -eu
source=$(realpath "$1")
build=$(realpath "$2")
look() { clang-tidy-14 -quiet -p "$build" --extra-arg=-Wno-shadow "$1"; }

if [ $# -eq 3 ]; then
    files=$(cut -d'"' -f2 "$3")
    count=$(echo "$files" | wc -l)
    if [ "$count" -eq 1 ]; then look "$files"; exit; fi
    if look "$3" > "$3.log" 2>&1; then exit 0; fi
    failed=0
    head -n $((count / 2)) "$3" > "${3%.cpp}-a.cpp"
    tail -n +$((count / 2 + 1)) "$3" > "${3%.cpp}-b.cpp"
    for half in a b; do "$0" "$source" "$build" "${3%.cpp}-$half.cpp" || failed=1; done
    exit $failed
fi

groups=$build/tidy
rm -rf "$groups"
for folder in trace spatial meshes reorder cachesim replay; do
    mkdir -p "$groups/$folder"
    find "$source/$folder" -name '*.cpp' | sort | awk -v into="$groups/$folder" '
        { file[NR - 1] = $0 }
        END {
            count = int((NR + 6) / 7)
            for (i = 0; i < NR; ++i) print "#include \"" file[i] "\"" > (into "/" i % count ".cpp")
        }'
done
find "$groups" -name '*.cpp' | sort | xargs -P "$(nproc)" -n 1 "$0" "$source" "$build"
