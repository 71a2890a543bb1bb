#!/bin/sh
# make.sh REGATHER OUT [PART...]: makes the rows of this folder again (but box.csv, of the built-in ladders: docs/converge.md), in OUT/results.
# Parts: references, techniques (four seeds), strategies (twelve seeds, photons held), charts; all of them when none is named. Seconds are
# of this machine: nothing else should run beside `techniques`. What is there already is not measured again.
set -eu
here=$(realpath "$(dirname "$0")")
regather=$(realpath "$1")
ladders=$(realpath "$here/../../scenes/experiments")
mkdir -p "$2/results"
cd "$2"
shift 2
parts=${*:-references techniques strategies charts}
scenes="cornell room house arena caustics prism meadow apartment"

# Of Debian's sweethome3d (make scenes-packages).
[ -e apartment/scene.json ] ||
    "$regather" import sweethome3d /usr/share/sweethome3d/sweethome3d.jar --home 2BedroomApartment -o apartment > /dev/null
file_of() { [ "$1" = apartment ] && echo apartment/scene.json || echo "$1"; }

# ladder NAME SEEDS SCENE...: the scenes on that ladder.
ladder() {
    name=$1 seeds=$2
    shift 2
    cp "$ladders/$name-ladder.csv" .
    for scene in "$@"; do
        "$regather" converge "$(file_of "$scene")" -o "$name/$scene" --reference "reference/$scene" --ladder "$name-ladder.csv" \
            --seeds "$seeds" --seconds 10000 > "$name-$scene.txt"
        for kind in csv json; do sed "s/\"converge.csv\"/\"$name-$scene.csv\"/" "$name/$scene/converge.$kind" > "results/$name-$scene.$kind"; done
        echo "$(date +%T) $name $scene"
    done
}

for part in $parts; do
    case $part in
    references)
        for scene in $scenes keyhole; do
            "$regather" reference "$(file_of $scene)" -o "reference/$scene" --width 64 --height 64 --seconds 100 > /dev/null
        done ;;
    techniques) ladder techniques 4 $scenes ;;
    strategies) ladder strategies 12 arena caustics keyhole cornell room ;;
    charts)
        for scene in $scenes; do
            "$regather" chart "results/techniques-$scene.csv" -o charts --kind error-by-time --force > /dev/null
            mv charts/error-by-time.svg "results/techniques-$scene.svg"
        done
        "$regather" chart results/techniques-*.csv -o charts --kind time-to-error --force > /dev/null
        mv charts/time-to-error.svg results ;;
    *) echo "make.sh: unknown part $part" >&2; exit 2 ;;
    esac
done
