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
    if node.split_dim >= 0:
        nodes += [node.lesser, node.greater]
        parent += [n, n]

def search(point):                                      # the nearer side first, the other one if it can still help
    visited, nearest, waiting = [], [], [(0.0, 0)]
    while waiting:
        away, n = waiting.pop()
        if len(nearest) == k and away > nearest[-1]:
            continue
        visited.append(n)
        if nodes[n].split_dim < 0:
            nearest = sorted(nearest + list(((points[nodes[n].indices] - point) ** 2).sum(axis=1)))[:k]
        else:
            d = point[nodes[n].split_dim] - nodes[n].split
            waiting += [(d * d, child[n] + int(d <= 0)), (0.0, child[n] + int(d > 0))]
    return visited

visits = [search(point) for point in queries]
is_leaf = np.array([node.split_dim < 0 for node in nodes])
columns = {"visit_element": np.concatenate(visits), "query_visits": [len(visited) for visited in visits],
           "element_bytes": 72 + is_leaf * [24 * (node.end_idx - node.start_idx) for node in nodes],
           "element_region": np.where(is_leaf, 2, 3), "element_parent": parent}
os.makedirs(sys.argv[1], exist_ok=True)
for name, rows in columns.items():
    np.save(f"{sys.argv[1]}/{name}.npy", np.asarray(rows).astype("<u4"))
np.save(f"{sys.argv[1]}/query_position.npy", queries)
