#!/bin/sh
# tidy.sh SOURCE BUILD: clang-tidy with .clang-tidy over the folders whose mistakes no picture shows: what reads files, what is
# walked, ordered, counted. BUILD is a build by clang 14: its precompiled headers are read in place of the text.
set -eu
run-clang-tidy-14 -quiet -p "$2" "^$(realpath "$1")/(trace|spatial|meshes|reorder|cachesim|replay)/.*\.cpp$"
