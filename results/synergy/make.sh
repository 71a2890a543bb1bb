#!/bin/sh
# make.sh REGATHER OUT [PART...]: makes the rows of this folder again, in OUT/results. Every scene is captured with four strategies of
# gather rays, with and without a cache of irradiance, and each capture replayed in six orders through eight caches, and so are the searches that
# choose directions. Parts: standing (256 x 256, 16 gather rays), frames (of the camera paths, 128 x 128), charts; all of them when none is named.
# A capture is removed when its rows are there; what is there already is not made again.
set -eu
here=$(realpath "$(dirname "$0")")
regather=$(realpath "$1")
mkdir -p "$2/results"
cd "$2"
shift 2
parts=${*:-standing frames charts}
orders="naive strata direction-binned:tile=16 direction-binned+hashed:tile=16 hilbert:tile=16 hilbert"
caches=4K,16K,64K,128K,512K,2M,8M,32M:128:8

# rows PART NAME SCENE ARGUMENT...: the scene in all eight ways.
rows() {
    part=$1 name=$2 scene=$3
    shift 3
    mkdir -p "$part"
    for sampling in cosine brdf incident combined; do
        for records in off bounded; do
            csv=$part/$name-$sampling-$records.csv
            [ -e "$csv" ] && continue
            cache=
            [ $records = off ] || cache="--irradiance-cache $records"
            "$regather" capture "$scene" -o "capture-$part" --sampling $sampling $cache --gather-rays 16 --no-rays --force "$@" > "$part/$name-$sampling-$records.txt"
            from=capture-$part
            [ -e "$from/trace" ] || from=$(echo capture-"$part"/frame-*)
            if [ -e "$from/guide-trace" ]; then
                "$regather" replay "$from/guide-trace" --order naive hilbert --layout heap-20 --cache "$caches" --csv "${csv%.csv}-guide.csv" --force > /dev/null
            fi
            "$regather" replay "$from/trace" --order $orders --layout heap-20 --cache "$caches" --csv "$csv" --force > /dev/null
            rm -rf "capture-$part"
            echo "$(date +%T) $csv"
        done
    done
}

for part in $parts; do
    case $part in
    standing)
        for scene in house arena caustics room meadow; do rows standing "$scene" "$scene" --width 256 --height 256; done
        python3 "$here/merge.py" standing results/standing.csv ;;
    frames)
        for view in arena:8 arena:40 house:8 house:40 caustics:6 caustics:30 meadow:6 meadow:30; do
            rows frames "$(echo "$view" | tr : -)" "${view%:*}" --frames "${view#*:}" --width 128 --height 128
        done
        python3 "$here/merge.py" frames results/frames.csv ;;
    charts)
        for scene in house arena; do
            { head -1 results/standing.csv; grep "^$scene," results/standing.csv | grep -v ' guide,'; } > "$scene.csv"
            "$regather" chart "$scene.csv" -o charts --kind traffic-by-technique --cache 128K:128:8 --force > /dev/null
            mv charts/traffic-by-technique.svg "results/traffic-$scene.svg"
        done ;;
    *) echo "make.sh: unknown part $part" >&2; exit 2 ;;
    esac
done
