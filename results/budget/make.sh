#!/bin/sh
# make.sh REGATHER OUT: makes the rows and the chart of this folder again, in OUT/results: the orders that a chip with 64 KB, 256 KB and 1 MB of
# state can hold, at full scale through 128 KB; the chart has Figure 4's rows, too. The capture is kept in OUT (3 GB). It runs in OUT, so that the rows' provenance names what lies there.
set -eu
regather=$(realpath "$1") here=$(realpath "$(dirname "$0")")
mkdir -p "$2/results"
cd "$2"
[ -e room/trace/trace.json ] || "$regather" capture room -o room --no-rays > /dev/null

# replay STATE[-NAME] ORDER...: what is there already is kept.
replay() {
    csv=results/$1.csv state=${1%%-*}
    shift
    [ -e "$csv" ] || "$regather" replay room/trace --order "$@" --cache 128K:128:8 --buffers --onchip "$state" --csv "$csv" > /dev/null
    echo "$(date +%T) $csv"
}

replay 64K strata:tile=16 strata:tile=16,strata=16,frame=world hilbert:tile=4 strata+hashed:tile=16,buckets=32,capacity=56 \
    strata+hashed:tile=16,buckets=64,capacity=28
replay 256K hilbert:tile=8 hilbert:tile=9 strata+hashed:tile=16,buckets=128,capacity=60 strata+hashed:tile=16,buckets=256,capacity=28 \
    direction-binned+hashed:tile=16,buckets=128,capacity=60 strata+hashed:tile=16,strata=16,frame=world,buckets=128,capacity=60
replay 1M hilbert:tile=16 hilbert:tile=19 strata+hashed:tile=16,buckets=512,capacity=56 strata+hashed:tile=16,buckets=256,capacity=120 \
    strata+hashed:tile=32,buckets=512,capacity=56 direction-binned+hashed:tile=16,buckets=512,capacity=56 \
    strata+hashed:tile=16,strata=16,frame=world,buckets=512,capacity=56
replay 64K-fine-bins strata:tile=16,strata=32,frame=world strata:tile=16,strata=64,frame=world
replay 256K-fine-bins strata:tile=32,strata=32,frame=world strata:tile=32,strata=64,frame=world \
    strata+hashed:tile=16,strata=32,frame=world,buckets=96,capacity=60
replay 1M-fine-bins strata+hashed:tile=32,strata=32,frame=world,buckets=400,capacity=60 strata+hashed:tile=32,strata=32,buckets=512,capacity=56
"$regather" chart "$here/../figure4/rows.csv" results/*.csv -o charts --kind best-under-budget --force > /dev/null
mv charts/best-under-budget.svg results
