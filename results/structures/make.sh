#!/bin/sh
# make.sh REGATHER OUT: makes the rows of this folder again, in OUT/results; captures and walks are kept in OUT (30 GB).
# One name after another may follow: only those parts (capture trees steps octree family scenes).
# Rows and command lines name what lies beside them, so it runs in OUT.
set -eu
regather=$(realpath "$1")
mkdir -p "$2/results"
cd "$2"
shift 2
parts=${*:-capture trees steps octree family scenes}
cheap="naive direction-binned+hashed:tile=16 hilbert:tile=16 hilbert"

# walk CAPTURE SPEC: in CAPTURE-SPEC, with - for what folders should not have.
folder() { echo "$1-$2" | tr ':,=' '---'; }
walk() {
    to=$(folder "$1" "$2")
    [ -e "$to/trace.json" ] || "$regather" walk "$1/trace" --structure "$2" -o "$to" --force > /dev/null
}
# replay CSV CAPTURE SPEC ARGUMENT...: rows that are there already are kept.
replay() {
    csv=results/$1.csv from=$(folder "$2" "$3")
    walk "$2" "$3"
    shift 3
    [ -e "$csv" ] || "$regather" replay "$from" "$@" --csv "$csv" > /dev/null
    echo "$(date +%T) $csv"
}

for part in $parts; do
    case $part in
    capture) [ -e room/trace/trace.json ] || "$regather" capture room -o room --width 256 --height 256 --no-rays > /dev/null ;;
    # Every structure in every layout that it can have.
    trees)
        for spec in octree:leaf=8,found=1 midpoint-kd:leaf=8,bounds=1,found=1 median-kd:leaf=8,found=1 \
            median-kd:leaf=8,bounds=1,found=1 midpoint-kd:leaf=8,found=1 voxel-volume-kd:leaf=8,bounds=1,found=1 bvh:leaf=8,found=1; do
            replay "trees-$(echo "$spec" | sed 's/:leaf=8//; s/,found=1//; s/,bounds=1/-bounds/')" room "$spec" --order $cheap \
                --layout heap-20 depth-first-20 van-emde-boas-20 clusters-20 van-emde-boas-12+6 clusters-12+6
        done
        replay trees-left-balanced-kd room left-balanced-kd:found=1 --order $cheap \
            --layout heap-20 depth-first-20 van-emde-boas-20 clusters-20 heap-32 heap-16 van-emde-boas-14+6 clusters-14+6
        replay trees-grid room grid:cell=8,found=1 --order $cheap --layout heap-20 hilbert-20 heap-12+6 hilbert-12+6
        replay trees-left-balanced-stack-free room left-balanced-stack-free --order $cheap --layout heap-20
        replay trees-hashed-grid room hashed-grid:cell=8,found=1 --order $cheap --layout heap-20 heap-12+6
        ;;
    # From the paper's tree to one near its floor, a step a row: size of leaves, record, split, size of nodes, order, associativity.
    steps)
        for leaf in 2 4 8 16 32 64; do
            replay "steps-median-kd-$leaf" room median-kd:leaf=$leaf,found=1 --order naive direction-binned+hashed:tile=16 hilbert \
                --layout depth-first-20 van-emde-boas-20 van-emde-boas-12+6 --cache 128K:128:8,full
        done
        ;;
    octree)
        for leaf in 2 4 8 16 32; do
            replay "steps-octree-$leaf" room octree:leaf=$leaf,found=1 --order naive direction-binned+hashed:tile=16 hilbert \
                --layout depth-first-20 depth-first-12+6 van-emde-boas-12+6 clusters-12+6 van-emde-boas-12+6:node=16 hilbert-12+6 \
                --cache 128K:128:8,full
        done
        ;;
    # All LRU caches of 4 KB to 64 MB.
    family)
        caches=4K,8K,16K,32K,64K,128K,256K,512K,1M,2M,4M,8M,16M,32M,64M:128:8
        replay family-left-balanced-kd room left-balanced-kd:found=1 --order $cheap --layout heap-20 --cache $caches
        replay family-octree room octree:leaf=8,found=1 --order $cheap --layout heap-20 van-emde-boas-12+6 --cache $caches
        ;;
    # Gain over the paper's tree in scenes and frames of their paths.
    scenes)
        for view in room:- house:8 house:40 arena:8 arena:40 cornell:4 cornell:22 caustics:6 caustics:30 prism:6 prism:30; do
            scene=${view%:*} frame=${view#*:}
            at=$scene-$frame
            if [ "$frame" = - ]; then at=$scene-still; fi
            if ! [ -e "$at/trace/trace.json" ] && ! [ -e "$at/frame-$frame/trace/trace.json" ]; then
                if [ "$frame" = - ]; then
                    "$regather" capture "$scene" -o "$at" --width 80 --height 80 --no-rays > /dev/null
                else
                    "$regather" capture "$scene" -o "$at" --frames "$frame" --width 80 --height 80 --no-rays > /dev/null
                fi
            fi
            replay "scenes-$at-left-balanced-kd" "$at" left-balanced-kd:found=1 --order $cheap --layout heap-20 van-emde-boas-20
            replay "scenes-$at-median-kd" "$at" median-kd:leaf=8,found=1 --order $cheap --layout heap-20 van-emde-boas-12+6
            replay "scenes-$at-octree" "$at" octree:leaf=8,found=1 --order $cheap --layout heap-20 van-emde-boas-12+6
        done
        ;;
    esac
done
