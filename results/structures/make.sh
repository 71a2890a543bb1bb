#!/bin/sh
# make.sh REGATHER OUT [PART...]: makes the rows of this folder again, in OUT/results; captures and walks are kept in OUT (20 GB). Parts:
# capture, trees (every structure), steps (of the octree: leaves, places, ways), scenes (and frames of their paths), family (all LRU
# caches), charts; all of them when none is named. It runs in OUT, so that the rows' provenance names what lies there.
set -eu
regather=$(realpath "$1")
mkdir -p "$2/results"
cd "$2"
shift 2
parts=${*:-capture trees steps scenes family charts}
orders="naive direction-binned+hashed:tile=16 hilbert:tile=16 hilbert"

# replay CSV CAPTURE SPEC ARGUMENT...: walks the capture in the structure, and replays; what is there already is kept.
replay() {
    csv=results/$1.csv
    from=$(echo "$2-$3" | tr ':,=' '---')
    [ -e "$from/trace.json" ] || "$regather" walk "$2/trace" --structure "$3" -o "$from" --force > /dev/null
    shift 3
    [ -e "$csv" ] || "$regather" replay "$from" "$@" --csv "$csv" > /dev/null
    echo "$(date +%T) $csv"
}

for part in $parts; do
    case $part in
    capture) [ -e room/trace/trace.json ] || "$regather" capture room -o room --width 256 --height 256 > /dev/null ;;
    trees)
        replay left-balanced-kd room left-balanced-kd:found=1 --order $orders --layout heap-20 van-emde-boas-20 van-emde-boas-14+6
        replay octree room octree:leaf=8,found=1 --order $orders \
            --layout heap-20 depth-first-20 van-emde-boas-20 clusters-20 van-emde-boas-12+6 clusters-12+6
        for structure in midpoint-kd:leaf=8,bounds=1 median-kd:leaf=8 bvh:leaf=8 voxel-volume-kd:leaf=8,bounds=1; do
            replay "${structure%%:*}" room "$structure,found=1" --order $orders --layout depth-first-20 van-emde-boas-12+6
        done
        replay grid room grid:cell=8,found=1 --order $orders --layout heap-20 heap-12+6
        replay left-balanced-stack-free room left-balanced-stack-free --order $orders --layout heap-20
        replay hashed-grid room hashed-grid:cell=8,found=1 --order $orders --layout heap-20
        ;;
    steps)
        for leaf in 2 4 16 32; do
            replay "octree-leaf-$leaf" room "octree:leaf=$leaf,found=1" --order naive direction-binned+hashed:tile=16 hilbert \
                --layout depth-first-20 van-emde-boas-12+6
        done
        replay octree-places room octree:leaf=8,found=1 --order naive direction-binned+hashed:tile=16 hilbert \
            --layout breadth-first-12+6 depth-first-12+6 hilbert-12+6 morton-12+6 van-emde-boas-12+6:node=4 van-emde-boas-12+6:node=64
        replay octree-ways room octree:leaf=8,found=1 --order naive direction-binned+hashed:tile=16 hilbert \
            --layout depth-first-20 van-emde-boas-12+6 --cache 128K:128:1,2,4,8,16,full
        replay left-balanced-kd-ways room left-balanced-kd:found=1 --order naive direction-binned+hashed:tile=16 hilbert \
            --layout heap-20 --cache 128K:128:1,2,4,8,16,full
        ;;
    scenes)
        for view in arena:8 house:40 cornell:22 caustics:6 prism:30 arena:40 house:8 cornell:4 caustics:30 prism:6; do
            scene=${view%:*} at=$(echo "$view" | tr : -)
            if ! [ -e "$at/trace/trace.json" ]; then
                "$regather" capture "$scene" -o "$at" --frames "${view#*:}" --width 80 --height 80 --no-rays --force > /dev/null
                mv "$at"/frame-*/trace "$at/trace"
            fi
            replay "$at-left-balanced-kd" "$at" left-balanced-kd:found=1 --order $orders --layout heap-20 van-emde-boas-14+6
            replay "$at-median-kd" "$at" median-kd:leaf=8,found=1 --order $orders --layout van-emde-boas-12+6
            replay "$at-octree" "$at" octree:leaf=8,found=1 --order $orders --layout depth-first-20 van-emde-boas-12+6
        done
        ;;
    family)
        caches=4K,8K,16K,32K,64K,128K,256K,512K,1M,2M,4M,8M,16M,32M,64M:128:8
        replay family-left-balanced-kd room left-balanced-kd:found=1 --order $orders --layout heap-20 --cache $caches
        replay family-octree room octree:leaf=8,found=1 --order $orders --layout depth-first-20 --cache $caches
        ;;
    charts)
        chart() {
            kind=$1
            shift
            (cd results && "$regather" chart "$@" -o ../charts --kind "$kind" --force) > /dev/null
            mv "charts/$kind.svg" results
        }
        chart traffic-by-layout left-balanced-kd.csv left-balanced-stack-free.csv median-kd.csv midpoint-kd.csv voxel-volume-kd.csv bvh.csv \
            grid.csv hashed-grid.csv octree.csv
        chart traffic-by-cache family-left-balanced-kd.csv family-octree.csv
        ;;
    *) echo "make.sh: unknown part $part" >&2; exit 2 ;;
    esac
done
