#!/bin/sh
# make.sh REGATHER OUT [PART...]: makes the rows and charts of this folder again, in OUT/results; the capture and the walks are kept in OUT (2 GB).
# Parts: capture, kinds (of rays), keys (bits of them), tiles, nodes (their formats), stack, treelets, frame, charts; all of them when none is named.
# It runs in OUT, so that the rows' provenance names what lies there. About ten minutes on two cores.
set -eu
regather=$(realpath "$1")
mkdir -p "$2/results"
cd "$2"
shift 2
parts=${*:-capture kinds keys tiles nodes stack treelets frame charts}
sizes=16K,32K,64K,128K,256K,512K,1M:128:8

# walk KIND SPEC: the rays of that kind through the structure, in a folder whose name is printed; what is there already is kept.
walk() {
    to=$(echo "$1-$2" | tr ':,=' '---')
    [ -e "$to/trace.json" ] || "$regather" walk room/trace --rays "$1" --structure "$2" -o "$to" --force > /dev/null
    echo "$to"
}
# replay CSV KIND SPEC ARGUMENT...
replay() {
    csv=results/$1.csv
    from=$(walk "$2" "$3")
    shift 3
    [ -e "$csv" ] || "$regather" replay "$from" "$@" --csv "$csv" > /dev/null
    echo "$(date +%T) $csv"
}
# frame CSV ORDERS ARGUMENT...: eye, shadow, specular, gather rays and photons; ORDERS are one, or five.
frame() {
    csv=results/$1.csv
    orders=$2
    shift 2
    [ -e "$csv" ] || "$regather" frame "$(walk eye bvh-4)" "$(walk shadow bvh-4)" "$(walk specular bvh-4)" "$(walk gather bvh-4)" room/trace \
        --order $orders "$@" --csv "$csv" > /dev/null
    echo "$(date +%T) $csv"
}

for part in $parts; do
    case $part in
    capture) [ -e room/trace/trace.json ] || "$regather" capture room -o room --width 128 --height 128 > /dev/null ;;
    kinds)
        for kind in eye shadow specular gather; do
            replay "$kind" "$kind" bvh-4 --order naive random tiled direction-binned hilbert morton hashed bvh-leaf origin-direction origin-end \
                origin-guess --cache $sizes
        done
        ;;
    keys)
        orders=naive
        for bits in 1 2 3 4 6 8; do
            for order in hilbert origin-direction origin-end origin-guess; do orders="$orders $order:bits=$bits"; done
        done
        replay key-bits gather bvh-4 --order $orders --cache 32K,128K:128:8
        ;;
    tiles)
        replay tiles gather bvh-4 --order naive direction-binned direction-binned:tile=32 origin-direction:tile=16 origin-direction:tile=32 \
            origin-guess:tile=8 origin-guess:tile=16 origin-guess:tile=32 origin-end:tile=16 origin-end:tile=32 --cache $sizes
        ;;
    nodes)
        for structure in bvh-2 bvh-2:quantised=1 bvh-4 bvh-4:quantised=1 bvh-8 bvh-8:quantised=1 ray-bvh; do
            replay "gather-$(echo "$structure" | sed 's/:quantised=1/-quantised/')" gather "$structure" \
                --order naive direction-binned hilbert origin-direction origin-end --cache $sizes
        done
        ;;
    stack)
        for width in 2 8; do
            for entries in 0 4 8; do
                replay "stack-bvh-$width-$entries" gather "bvh-$width:stack=$entries" --order naive hilbert --cache 16K,128K:128:8
            done
        done
        ;;
    treelets)
        replay treelets gather bvh-4:stack=4 --order naive --cache 16K,32K,64K,128K,512K:128:8 \
            --treelets 4K,8K,16K,32K,64K --queue 1024,4096,13107,65536,262144,1048576
        replay tiles-stack gather bvh-4:stack=4 --order direction-binned direction-binned:tile=32 origin-direction:tile=16 \
            origin-guess:tile=8 origin-guess:tile=16 origin-guess --buffers --cache 16K,32K,64K,128K,512K:128:8
        replay treelets-orders gather bvh-4:stack=4 --order random direction-binned origin-direction origin-guess --buffers \
            --cache 32K,128K:128:8 --treelets 16K --queue 13107,262144
        replay treelets-quantised gather bvh-4:quantised=1,stack=4 --order naive direction-binned --cache 16K,32K,64K,128K:128:8 \
            --treelets 8K,16K,32K --queue 13107,262144
        replay treelets-machines gather bvh-4:stack=4 --order naive --machine paper-128k,cpu-sapphire-rapids,gpu-a100 \
            --treelets 32K --queue 13107,262144
        ;;
    frame)
        frame frame naive --unit pixel tile=16 frame --machine paper-128k,cpu-sapphire-rapids,gpu-a100
        frame frame-sorted "naive naive naive origin-guess:tile=16 hilbert:tile=16" --unit tile=16 --machine paper-128k,cpu-sapphire-rapids,gpu-a100
        frame frame-binned "naive naive naive direction-binned direction-binned" --unit tile=16 --machine paper-128k,cpu-sapphire-rapids,gpu-a100
        frame frame-caches naive --unit pixel --cache 16K,32K,64K,128K,256K,512K,1M,2M,4M:128:8
        ;;
    charts)
        chart() {
            kind=$1
            shift
            "$regather" chart "$@" -o charts --kind "$kind" --force > /dev/null
            mv "charts/$kind.svg" results
        }
        chart traffic-by-cache results/gather.csv
        chart traffic-by-layout results/gather-*.csv --cache 32K:128:8
        chart best-under-budget results/treelets.csv results/tiles-stack.csv
        chart frame-traffic results/frame.csv
        ;;
    *) echo "make.sh: unknown part $part" >&2; exit 2 ;;
    esac
done
