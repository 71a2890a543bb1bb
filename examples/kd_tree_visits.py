# python3 kd_tree_visits.py FOLDER: what k-nearest searches visit in SciPy's kd-tree, as columns for `regather walk FOLDER`
# (docs/bringing_walks.md).
import os
import sys
import numpy as np
from scipy.spatial import cKDTree

rng = np.random.default_rng(1)
points, queries, k = rng.random((20_000, 3)), rng.random((32 * 32, 3)).astype("f4"), 10
tree = cKDTree(points, leafsize=8)
nodes, parent, child = [tree.tree], [0], []
for n, node in enumerate(nodes):                        # level by level; a leaf splits along axis -1
    child.append(len(nodes))
    nodes += [node.lesser, node.greater] * (node.split_dim >= 0)
    parent += [n, n] * (node.split_dim >= 0)

def search(point, nearest, n=0, away=0.0):              # the nearer side first, the other one if it can still help
    if away > nearest[-1]:
        return
    yield n
    d = point[nodes[n].split_dim] - nodes[n].split
    if nodes[n].split_dim < 0:
        nearest[:] = sorted([*nearest, *((points[nodes[n].indices] - point) ** 2).sum(axis=1)])[:k]
    else:
        yield from search(point, nearest, child[n] + int(d > 0))
        yield from search(point, nearest, child[n] + int(d <= 0), d * d)

visits = [list(search(point, [np.inf] * k)) for point in queries]
leaves = np.array([0 if node.split_dim >= 0 else node.end_idx - node.start_idx for node in nodes])
columns = {"visit_element": sum(visits, []), "query_visits": [len(visited) for visited in visits],
           "element_bytes": 72 + 24 * leaves, "element_region": np.where(leaves, 2, 3), "element_parent": parent}
os.makedirs(sys.argv[1], exist_ok=True)
np.save(f"{sys.argv[1]}/query_position.npy", queries)
for name, rows in columns.items():
    np.save(f"{sys.argv[1]}/{name}.npy", np.asarray(rows).astype("<u4"))
