#!/usr/bin/env python3
"""Writes studies/own-modal: 32 modes of a tube between pins, its shapes at three loose plates and at the force, the
residual flexibility of the plates and its mass. All of it is exact: sin(kπx/L) has the mass ρA L/2."""
import math
import pathlib
import sys

L, E, RHO, D, WALL, RATIO, COUNT = 3.0, 2.0e11, 8470.0, 0.01905, 0.00109, 0.01, 32
AREA = math.pi / 4 * (D**2 - (D - 2 * WALL) ** 2)
EI = E * math.pi / 64 * (D**4 - (D - 2 * WALL) ** 4)
MASS = RHO * AREA * L / 2
PLATES = {"plate1": 0.75, "plate2": 1.5, "plate3": 2.25}
POINTS = {**PLATES, "force": 1.2}


def omega(k):
    return (k * math.pi / L) ** 2 * math.sqrt(EI / (RHO * AREA))


def beyond(a, b, power):
    """Σ over the modes that are left out of φ_k(a) φ_k(b) / (m ω_k^power)."""
    return math.fsum(math.sin(k * math.pi * a / L) * math.sin(k * math.pi * b / L) / (MASS * omega(k) ** power)
                     for k in range(COUNT + 1, 20001))


def inverse(A):
    n = len(A)
    rows = [list(A[i]) + [float(i == j) for j in range(n)] for i in range(n)]
    for i in range(n):
        pivot = rows[i][i]
        rows[i] = [x / pivot for x in rows[i]]
        for j in range(n):
            if j != i:
                factor = rows[j][i]
                rows[j] = [x - factor * y for x, y in zip(rows[j], rows[i])]
    return [row[n:] for row in rows]


def product(A, B):
    return [[math.fsum(a * b for a, b in zip(row, column)) for column in zip(*B)] for row in A]


def square(table):
    names = list(PLATES)
    return "point," + ",".join(names) + "\n" + "".join(
        f"{name}," + ",".join(f"{(table[i][j] + table[j][i]) / 2:.12e}" for j in range(len(names))) + "\n"
        for i, name in enumerate(names))


places = list(PLATES.values())
R = [[beyond(a, b, 2) for b in places] for a in places]
weighed = [[beyond(a, b, 4) for b in places] for a in places]
heavy = product(product(inverse(R), weighed), inverse(R))
here = pathlib.Path(__file__).resolve().parents[2] / "studies" / "own-modal"
folder = pathlib.Path(sys.argv[1]) if len(sys.argv) > 1 else here
folder.mkdir(parents=True, exist_ok=True)
(folder / "modes.csv").write_text("mode,frequency,mass,damping\n" + "".join(
    f"{k},{omega(k) / (2 * math.pi):.12g},{MASS:.12g},{RATIO}\n" for k in range(1, COUNT + 1)))
(folder / "shapes.csv").write_text("point," + ",".join(str(k) for k in range(1, COUNT + 1)) + "\n" + "".join(
    f"{name}," + ",".join(f"{round(math.sin(k * math.pi * x / L), 12) + 0.0:.12g}" for k in range(1, COUNT + 1)) + "\n"
    for name, x in POINTS.items()))
(folder / "residual.csv").write_text(square(R))
(folder / "residual_mass.csv").write_text(square(heavy))
