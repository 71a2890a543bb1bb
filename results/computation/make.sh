#!/bin/sh
# make.sh REGATHER OUT [PART...]: makes the rows and charts of this folder again, in OUT/results; captures and walks are kept in OUT (1 GB).
# Parts: capture (and walks of the rays), rows, charts; all of them when none is named. It runs in OUT, so that the rows' provenance names what
# lies there.
set -eu
regather=$(realpath "$1")
mkdir -p "$2/results"
cd "$2"
shift 2
parts=${*:-capture rows charts}
scenes="room house arena caustics cornell"
# A photon's distance: 3 subtractions, 3 multiplications, 2 additions. A node of 4 boxes: 4 x 6 planes, a subtraction and a multiplication each.
named=distance_flops=8,node_flops=48

# walks SCENE: the folders of its walked rays; kinds that the capture has none of have no folder.
walks() {
    for kind in eye shadow specular gather; do
        if [ -e "$1/$kind/trace.json" ]; then echo "$1/$kind"; fi
    done
}

for part in $parts; do
    case $part in
    capture)
        for scene in $scenes; do
            [ -e "$scene/trace/trace.json" ] || "$regather" capture "$scene" -o "$scene" --width 64 --height 64 > /dev/null
            for kind in eye shadow specular gather; do
                if [ -e "$scene/$kind/trace.json" ] || grep -q "\"${kind}_rays\": 0," "$scene/trace/trace.json"; then continue; fi
                "$regather" walk "$scene/trace" --rays "$kind" --structure bvh-4 -o "$scene/$kind" > /dev/null
            done
            echo "$(date +%T) $scene"
        done
        ;;
    rows)
        "$regather" computation --csv results/paper.csv --force > /dev/null
        for scene in $scenes; do
            "$regather" computation "$scene" $(walks "$scene") --csv "results/$scene.csv" --force > /dev/null
            "$regather" computation "$scene" $(walks "$scene") --set $named --csv "results/$scene-named.csv" --force > /dev/null
        done
        ;;
    charts)
        chart() {
            (cd results && "$regather" chart "$2.csv" -o ../charts --kind computation --force) > /dev/null
            mv charts/computation.svg "results/$1.svg"
        }
        chart computation-paper paper
        chart computation-room room
        chart computation-room-named room-named
        ;;
    *) echo "make.sh: unknown part $part" >&2; exit 2 ;;
    esac
done
