"""Writes studies/own-assembled: K, M and dofs of a plane frame, three clamped columns under two spans (N, m, kg, s)."""
import math
import pathlib
import random

E, RHO, SIDE, WALL = 2.1e11, 7850.0, 0.04, 0.003  # square tube
AREA, INERTIA = SIDE**2 - (SIDE - 2 * WALL) ** 2, (SIDE**4 - (SIDE - 2 * WALL) ** 4) / 12
COLUMNS, HEIGHT, SPAN, PARTS = 3, 1.2, 1.5, 4
places, lines = {}, []  # node: (x, y); pairs of nodes


def line(start, end, names):
    """Nodes from start to end, and the elements between them; a name that is there stays one node."""
    for i, name in enumerate(names):
        s = i / (len(names) - 1)
        places[name] = (start[0] + s * (end[0] - start[0]), start[1] + s * (end[1] - start[1]))
    lines.extend(zip(names, names[1:]))


for c in range(COLUMNS):
    line((c * SPAN, 0), (c * SPAN, HEIGHT), [f"B{c}", f"C{c}a", f"C{c}b", f"T{c}"])
for c in range(COLUMNS - 1):
    inner = [f"S{c}{i}" for i in range(1, PARTS)]
    line((c * SPAN, HEIGHT), ((c + 1) * SPAN, HEIGHT), [f"T{c}", *inner, f"T{c + 1}"])

nodes = list(places)
random.Random(20261126).shuffle(nodes)  # as a mesher numbers them
dof = {(node, part): 3 * i + k for i, node in enumerate(nodes) for k, part in enumerate(("ux", "uy", "rz"))}
K, M = {}, {}
for a, b in lines:
    dx, dy = places[b][0] - places[a][0], places[b][1] - places[a][1]
    L = math.hypot(dx, dy)
    c, s = dx / L, dy / L
    k, m = E * INERTIA / L**3, RHO * AREA * L / 420
    ea, ma = E * AREA / L, RHO * AREA * L / 6
    bend = [[12, 6 * L, -12, 6 * L], [6 * L, 4 * L * L, -6 * L, 2 * L * L], [-12, -6 * L, 12, -6 * L],
            [6 * L, 2 * L * L, -6 * L, 4 * L * L]]
    mass = [[156, 22 * L, 54, -13 * L], [22 * L, 4 * L * L, 13 * L, -3 * L * L], [54, 13 * L, 156, -22 * L],
            [-13 * L, -3 * L * L, -22 * L, 4 * L * L]]
    # Rows of local displacements over (ux, uy, rz) of both ends: across, rotation, across, rotation; along, along.
    across = [[-s, c, 0, 0, 0, 0], [0, 0, 1, 0, 0, 0], [0, 0, 0, -s, c, 0], [0, 0, 0, 0, 0, 1]]
    along = [[c, s, 0, 0, 0, 0], [0, 0, 0, c, s, 0]]
    where = [dof[end, part] for end in (a, b) for part in ("ux", "uy", "rz")]
    for i in range(6):
        for j in range(6):
            at = where[i], where[j]
            K[at] = K.get(at, 0.0) + sum(k * bend[p][q] * across[p][i] * across[q][j] for p in range(4) for q in range(4)) \
                + sum((ea if p == q else -ea) * along[p][i] * along[q][j] for p in range(2) for q in range(2))
            M[at] = M.get(at, 0.0) + sum(m * mass[p][q] * across[p][i] * across[q][j] for p in range(4) for q in range(4)) \
                + sum((2 if p == q else 1) * ma * along[p][i] * along[q][j] for p in range(2) for q in range(2))

folder = pathlib.Path(__file__).resolve().parents[2] / "studies" / "own-assembled"
for name, matrix in (("K", K), ("M", M)):
    lower = sorted((i, j, v) for (i, j), v in matrix.items() if i >= j and abs(v) > 1e-9 * abs(max(matrix.values())))
    text = "".join(f"{i + 1} {j + 1} {v:.12g}\n" for i, j, v in lower)
    (folder / f"{name}.mtx").write_text(
        f"%%MatrixMarket matrix coordinate real symmetric\n{len(dof)} {len(dof)} {len(lower)}\n{text}")
rows = "".join(f"{number + 1},{node},{part},{places[node][0]:g},{places[node][1]:g},0,{'fixed' if node[0] == 'B' else ''}\n"
               for (node, part), number in dof.items())
(folder / "dofs.csv").write_text("dof,node,component,x,y,z,held\n" + rows)
