#!/usr/bin/python3
"""visits.py SOURCE BINARY FOLDER: runs examples/kd_tree_visits.py and examples/grid_visits.py, and what docs/bringing_walks.md does with
their columns.

The visits must lead to the neighbours that SciPy's own search finds, or to all points within the radius, and the traces must have them all. By Debian's Python, which has
Debian's NumPy and SciPy; exit code 77 without them.
"""
import json
import os
import re
import runpy
import shutil
import subprocess
import sys

try:
    import numpy as np
    import scipy.spatial  # noqa: F401
except ImportError as error:
    print(f"SKIPPED: {error}")
    sys.exit(77)

source, binary, folder = (os.path.abspath(word) for word in sys.argv[1:])
shutil.rmtree(folder, ignore_errors=True)
os.makedirs(folder)
os.chdir(folder)
sys.argv = ["kd_tree_visits.py", "visits"]
example = runpy.run_path(f"{source}/examples/kd_tree_visits.py")

distances, neighbours = example["tree"].query(example["queries"], example["k"])
for visited, found in zip(example["visits"], neighbours):
    seen = set()
    for node in (example["nodes"][n] for n in visited):
        if node.split_dim < 0:
            seen.update(node.indices)
    assert seen.issuperset(found), "a neighbour that SciPy finds lies in no visited leaf"

sys.argv = ["grid_visits.py", "cells"]
grid = runpy.run_path(f"{source}/examples/grid_visits.py")
cells = grid["side"] ** 3
for visited, point in zip(grid["visits"], grid["queries"]):
    near = np.flatnonzero(((grid["points"] - point) ** 2).sum(axis=1) <= 0.05**2)
    assert set(visited).issuperset(cells + near), "a point within the radius lies in no visited cell"
    assert sum(n < cells for n in visited) in (8, 12, 18, 27), "cells about one: 27, fewer at faces"

page = open(f"{source}/docs/bringing_walks.md", encoding="utf-8").read()
commands = re.findall(r"^    (regather .*)$", page, re.MULTILINE)
assert len(commands) >= 3, commands
environment = dict(os.environ, PATH=os.path.dirname(binary) + ":" + os.environ["PATH"])
printed = ""
for command in commands:
    done = subprocess.run(["bash", "-c", command], env=environment, capture_output=True, text=True)
    assert done.returncode == 0 and not done.stderr, f"{command}: {done.returncode}\n{done.stderr}"
    printed += done.stdout
for folder, brought in (("walked", example), ("cells-walked", grid)):
    trace = json.load(open(f"{folder}/trace.json", encoding="utf-8"))
    assert trace["visited_nodes"] == sum(map(len, brought["visits"])), trace["visited_nodes"]
    assert trace["structure"] == "visits" and trace["queries"] == len(brought["queries"])
# What the page shows of the commands' output is what they print.
shown = re.search(r"```text\n(.*?)```", page, re.DOTALL).group(1)
for line in filter(None, map(str.strip, shown.splitlines())):
    assert " ".join(line.split()) in " ".join(printed.split()), f"not printed: {line}\n{printed}"
print("ok")
