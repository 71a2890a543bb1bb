#!/usr/bin/env python3
"""portable.py BINARY GOLDEN FOLDER MACHINE [--pin]: are the results the same bytes on MACHINE?

MACHINE is `native`, or a CPU model of qemu-x86_64: there the CPU has no AVX-512, and approximate instructions give other bits than
any real CPU's. BINARY renders, captures, orders and replays small scenes in FOLDER; checksums of
every column and picture, and every count, are compared with the file GOLDEN. Exit code 1 when one differs, 77 when there is no
qemu-x86_64. With --pin, GOLDEN is written instead.
"""
import csv
import hashlib
import json
import pathlib
import shutil
import subprocess
import sys

here = pathlib.Path(__file__).parent
# Glossy, mirror and glass, smooth normals, caustic maps, frames of a camera path; thousands of triangles in cornell; terrain
# and tufts in growth.
small = ["--width", "10", "--height", "10", "--photons", "3000", "--caustic-photons", "500", "--k", "20"]
gather = ["--gather-rays", "10", "--shadow-rays", "4"]
own = here.parent / "golden/portable_scene.json"
captures = {
    "portable": [own, *gather],
    "frames": [own, *gather, "--frames", "2,4", "--samples", "2"],
    "direct": [own, "--mode", "direct", "--filter", "gaussian"],
    "cornell": ["cornell", *gather],
    "growth": [here.parent / "golden/portable_growth.json", *gather],
}
orders = ["naive", "random", "tiled:tile=4", "direction-binned", "hilbert", "morton", "swizzle", "hashed", "direction-binned+hashed",
          "kd-leaf", "bvh-leaf"]
strata = ["strata:tile=4,strata=3", "strata:frame=world,order=morton", "strata+hashed:order=columns"]  # not of caustic queries
caches = ["4K:64:full", "8K:128:8", "16K:32:1"]


def digest(path):
    return hashlib.sha256(path.read_bytes()).hexdigest()[:16]


def counts(text):
    """A line for each row: every column but seconds."""
    for number, row in enumerate(csv.DictReader(text.splitlines())):
        kept = [f"{name}={value}" for name, value in row.items() if value and not name.endswith("_seconds")]
        yield number, " ".join(kept)


def measure(run, folder):
    """{name: checksum or counts} of all that is made."""
    found = {}
    for name, options in captures.items():
        run("capture", *options, "-o", folder / name, *small)
    run("reference", "box", "-o", folder / "reference", "--width", "12", "--height", "12", "--samples", "4")
    for picture in sorted([*folder.rglob("*.exr"), *folder.rglob("*.png")]):
        found[str(picture.relative_to(folder))] = digest(picture)
    for trace in sorted(folder.rglob("trace.json")):
        for column, facts in json.loads(trace.read_text())["columns"].items():
            found[f"{trace.parent.relative_to(folder)}/{column}"] = f"{facts['rows']} rows, xxh3_64 {facts['xxh3_64']}"
    replays = {
        "replay": ["replay", folder / "portable/trace", "--order", *orders, *strata, "--cache", *caches],
        "classes": ["replay", folder / "portable/trace", "--order", "hilbert", "--classes", "--buffers", "--cache", "8K:64:4"],
        "machine": ["replay", folder / "portable/trace", "--order", "naive", "hilbert", "--machine", "gpu-a100,paper-128k"],
        "caustic": ["replay", folder / "portable/caustic-trace", "--order", *orders, "--cache", *caches],
    }
    for name, command in replays.items():
        for number, row in counts(run(*command)):
            found[f"{name} row {number}"] = row
    return found


def main():
    pin = "--pin" in sys.argv
    binary, golden, folder, machine = (argument for argument in sys.argv[1:] if argument != "--pin")
    emulator = []
    if machine != "native":
        qemu = shutil.which("qemu-x86_64")
        if not qemu:
            print("SKIPPED: there is no qemu-x86_64 here (Debian package qemu-user)")
            return 77
        emulator = [qemu, "-cpu", machine]
    folder = pathlib.Path(folder) / machine
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)

    def run(*command):
        done = subprocess.run([*emulator, binary, *map(str, command)], capture_output=True, text=True)
        if done.returncode != 0:
            sys.exit(f"{machine}: {' '.join(map(str, command))}: exit code {done.returncode}\n{done.stderr}")
        return done.stdout

    found = measure(run, folder)
    golden = pathlib.Path(golden)
    if pin:
        golden.write_text(json.dumps(found, indent=1) + "\n")
        return 0
    expected = json.loads(golden.read_text())
    others = [name for name in sorted({*found, *expected}) if found.get(name) != expected.get(name)]
    for name in others:
        print(f"{machine}: {name}: found {found.get(name, 'nothing')}, expected {expected.get(name, 'nothing')}")
    print(f"{machine}: {len(found)} values, {len(others)} other than in {golden}")
    return 1 if others else 0


if __name__ == "__main__":
    sys.exit(main())
