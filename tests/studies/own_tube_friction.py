"""Writes studies/own-tube-friction: K, M and dofs of a tube, clamped at one end, in two planes (N, m, kg, s)."""
import pathlib

EI, RHO_S, LENGTH, PARTS = 90.0, 0.8, 1.2, 6  # N m², kg/m
L = LENGTH / PARTS
COMPONENTS = ("uy", "rz", "uz", "ry")
dof = {(node, part): 4 * node + k for node in range(PARTS + 1) for k, part in enumerate(COMPONENTS)}
bend = [[12, 6 * L, -12, 6 * L], [6 * L, 4 * L * L, -6 * L, 2 * L * L], [-12, -6 * L, 12, -6 * L],
        [6 * L, 2 * L * L, -6 * L, 4 * L * L]]
mass = [[156, 22 * L, 54, -13 * L], [22 * L, 4 * L * L, 13 * L, -3 * L * L], [54, 13 * L, 156, -22 * L],
        [-13 * L, -3 * L * L, -22 * L, 4 * L * L]]
K, M = {}, {}
for left in range(PARTS):
    # About y a slope duz/dx is a rotation of the other sign.
    for across, turn, sign in (("uy", "rz", 1), ("uz", "ry", -1)):
        where = [(dof[node, part], of) for node in (left, left + 1) for part, of in ((across, 1), (turn, sign))]
        for i, (row, a) in enumerate(where):
            for j, (column, b) in enumerate(where):
                K[row, column] = K.get((row, column), 0.0) + EI / L**3 * a * b * bend[i][j]
                M[row, column] = M.get((row, column), 0.0) + RHO_S * L / 420 * a * b * mass[i][j]

folder = pathlib.Path(__file__).resolve().parents[2] / "studies" / "own-tube-friction"
folder.mkdir(exist_ok=True)
for name, matrix in (("K", K), ("M", M)):
    lower = sorted((i, j, v) for (i, j), v in matrix.items() if i >= j and v != 0)
    text = "".join(f"{i + 1} {j + 1} {v:.15g}\n" for i, j, v in lower)
    (folder / f"{name}.mtx").write_text(
        f"%%MatrixMarket matrix coordinate real symmetric\n{len(dof)} {len(dof)} {len(lower)}\n{text}")
rows = "".join(f"{number + 1},N{node},{part},{node * L:g},0,0,{'fixed' if node == 0 else ''}\n"
               for (node, part), number in dof.items())
(folder / "dofs.csv").write_text("dof,node,component,x,y,z,held\n" + rows)
