#!/usr/bin/env python3
"""Writes studies/own-imported: K and M (mm, t, s, N) of two tubes side by side, each pinned at both ends and in its
middle, bending in two planes, meshed coarsely and finely; and two seeded forces over time. Nodes of one place have one
name in both meshes, and dofs 1 and 2 are one place in both."""
import math
import pathlib
import random
import sys

LENGTH, E, RHO, D, WALL, PITCH = 1800.0, 2.0e5, 8.47e-9, 19.05, 1.09, 27.0
INNER = D - 2 * WALL
AREA, INERTIA = math.pi / 4 * (D**2 - INNER**2), math.pi / 64 * (D**4 - INNER**4)
FINEST = 24                                   # elements of a tube; node k stands at k L/24
PARTS = ("uy", "uz", "ry", "rz")
FIRST = [("A16", "uz"), ("A20", "uz")]        # dofs 1 and 2


def element(length):
    k, m, a = E * INERTIA / length**3, RHO * AREA * length / 420, length
    bend = [[12, 6 * a, -12, 6 * a], [6 * a, 4 * a * a, -6 * a, 2 * a * a], [-12, -6 * a, 12, -6 * a],
            [6 * a, 2 * a * a, -6 * a, 4 * a * a]]
    mass = [[156, 22 * a, 54, -13 * a], [22 * a, 4 * a * a, 13 * a, -3 * a * a], [54, 13 * a, 156, -22 * a],
            [-13 * a, -3 * a * a, -22 * a, 4 * a * a]]
    return [[k * x for x in row] for row in bend], [[m * x for x in row] for row in mass]


def mesh(folder, every):
    nodes = [(f"{tube}{k}", k * LENGTH / FINEST, row * PITCH) for row, tube in enumerate("AB")
             for k in range(0, FINEST + 1, every)]
    dofs = FIRST + [(name, part) for name, _, _ in nodes for part in PARTS if (name, part) not in FIRST]
    number = {dof: i for i, dof in enumerate(dofs)}
    K, M = {}, {}
    k, m = element(LENGTH / FINEST * every)
    for tube in "AB":
        for start in range(0, FINEST, every):
            ends = f"{tube}{start}", f"{tube}{start + every}"
            # uy' = rz, uz' = -ry.
            for across, turn, sign in (("uy", "rz", 1), ("uz", "ry", -1)):
                where = [(number[end, part], sign if part == turn else 1) for end in ends for part in (across, turn)]
                for i, (row, s) in enumerate(where):
                    for j, (column, t) in enumerate(where):
                        K[row, column] = K.get((row, column), 0.0) + s * t * k[i][j]
                        M[row, column] = M.get((row, column), 0.0) + s * t * m[i][j]
    folder.mkdir(parents=True, exist_ok=True)
    for name, matrix in (("K", K), ("M", M)):
        lower = sorted((i, j, v) for (i, j), v in matrix.items() if i >= j and v != 0)
        (folder / f"{name}.mtx").write_text(
            f"%%MatrixMarket matrix coordinate real symmetric\n{len(dofs)} {len(dofs)} {len(lower)}\n"
            + "".join(f"{i + 1} {j + 1} {v:.12g}\n" for i, j, v in lower))
    held = {f"{tube}{k}" for tube in "AB" for k in (0, FINEST // 2, FINEST)}
    places = {name: (x, y) for name, x, y in nodes}
    (folder / "dofs.csv").write_text("dof,node,component,x,y,z,held\n" + "".join(
        f"{i + 1},{name},{part},{places[name][0]:g},{places[name][1]:g},0,"
        f"{'fixed' if name in held and part in ('uy', 'uz') else ''}\n" for i, (name, part) in enumerate(dofs)))


here = pathlib.Path(__file__).resolve().parents[2] / "studies" / "own-imported"
target = pathlib.Path(sys.argv[1]) if len(sys.argv) > 1 else here
mesh(target / "coarse", 2)
mesh(target / "fine", 1)
draw = random.Random(20261126)
tones = [[(f, draw.uniform(0, 2 * math.pi)) for f in range(30, 130, 4)] for _ in range(2)]
rows = "t,Fy,Fz\n"
for i in range(501):
    t = i * 1e-3
    y, z = (2.0 * sum(math.sin(2 * math.pi * f * t + phase) for f, phase in one) for one in tones)
    rows += f"{t:.3f},{y:.6g},{z:.6g}\n"
(target / "f.csv").write_text(rows)
