# python3 grid_visits.py FOLDER: what searches within 0.05 visit in a uniform grid, as columns for `regather walk FOLDER`
# (docs/bringing_walks.md). Elements: 20 x 20 x 20 cells, then the points, cell by cell.
import os
import sys
import numpy as np

rng = np.random.default_rng(1)
points, queries, side = rng.random((20_000, 3)), rng.random((32 * 32, 3)).astype("f4"), 20
cell_of = lambda place: np.clip((place * side).astype(int), 0, side - 1) @ [1, side, side * side]
points = points[np.argsort(cell_of(points), kind="stable")]
begin = side**3 + np.searchsorted(cell_of(points), np.arange(side**3 + 1))
around = np.stack(np.meshgrid(*[(-1, 0, 1)] * 3), -1).reshape(-1, 3) / side
visits = [[n for cell in np.unique(cell_of(query + around)) for n in (cell, *range(begin[cell], begin[cell + 1]))] for query in queries]
columns = {"visit_element": sum(visits, []), "query_visits": [len(visited) for visited in visits],
           "element_bytes": [8] * side**3 + [20] * len(points), "element_region": [5] * side**3 + [0] * len(points)}
os.makedirs(sys.argv[1], exist_ok=True)
np.save(f"{sys.argv[1]}/query_position.npy", queries)
for name, rows in columns.items():
    np.save(f"{sys.argv[1]}/{name}.npy", np.asarray(rows).astype("<u4"))
