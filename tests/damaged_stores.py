#!/usr/bin/env python3
"""Damaged stores through `report` and `run`.

    python3 tests/damaged_stores.py build/release/bin/ricochet 200 [SEED]

Each store is a copy of a small one with flipped bits, pages that are lost, its end cut off, or rows that somebody
changed. The law: no signal, no hang, no internal error, no file outside the folder; where the exit code is 0, the
tables are those of the whole store; else what is damaged is named. Exit code 1 where it does not hold.
"""
import pathlib
import random
import shutil
import sqlite3
import subprocess
import sys
import tempfile

STUDY = """{"name": "whole", "question": "What does a beam lose at its stops?", "kind": "trajectory",
 "scene": {"structure": {"type": "beam", "length": 1.5, "young": 2e11, "density": 8000,
                         "section": {"type": "tube", "outer_diameter": 0.01, "wall": 0.0005}},
           "stops": {"lower": -0.1, "upper": 0.1, "at": "tip"},
           "initial": {"displacement": "0.04*x^2", "velocity": "-2*x"}},
 "mesh": {"elements": 4}, "methods": {"mass": ["consistent", "singular"], "contact": "signorini",
 "time": "newmark-dumont-paoli"}, "step": [2e-3, 1e-3], "duration": 0.2, "snapshots": 10, "samples": 20}"""
LIMIT = 120  # s, of a command that takes a tenth of one
EVIL = ["../../ESCAPED", 'c"><img src=x onerror="document.title=1">', "x\x1b[2J", "", "c0123456789", "é" * 40]


def ran(program, *words):
    done = subprocess.run([program, *words], capture_output=True, timeout=LIMIT)
    said = (done.stdout + done.stderr).decode("utf-8", "replace")
    return done.returncode, said


def tables(folder):
    return {str(path.relative_to(folder)): path.read_bytes() for path in sorted(folder.rglob("*.csv"))}


def flip(path, dice, count):
    content = bytearray(path.read_bytes())
    for _ in range(count):
        content[dice.randrange(100, len(content))] ^= 1 << dice.randrange(8)
    path.write_bytes(content)
    return f"{count} flipped bits"


def lose_page(path, dice, count):
    content = bytearray(path.read_bytes())
    size = int.from_bytes(content[16:18], "big")
    for _ in range(count):
        at = size * dice.randrange(1, len(content) // size)
        content[at:at + size] = dice.randbytes(size) if dice.random() < 0.5 else bytes(size)
    path.write_bytes(content)
    return f"{count} lost pages"


def cut(path, dice):
    content = path.read_bytes()
    path.write_bytes(content[:dice.randrange(len(content))])
    return "the end cut off"


def tamper(path, dice):
    base = sqlite3.connect(path)
    base.execute("pragma foreign_keys=off")
    rows = [r[0] for r in base.execute("select name from sqlite_master where type='table'")]
    table = dice.choice([name for name in rows if base.execute(f"select count(*) from {name}").fetchone()[0]])
    described = base.execute(f"pragma table_info({table})").fetchall()
    column, kind = dice.choice([r[1:3] for r in described])
    # Tables of rows lie in their key.
    key = [r[1] for r in described if r[5]] or ["rowid"]
    row = base.execute(f"select {', '.join(key)} from {table} order by random() limit 1").fetchone()
    that = " and ".join(f"{one} is ?" for one in key)
    value = {"TEXT": dice.choice(EVIL + ['[1, {"a": [null]}]', "done", '"text"']),
             "INTEGER": dice.choice([-1, 0, 7, 2**31, 2**62]),
             "REAL": dice.choice([5e-324, -0.0, 1e308, 0.1, "text"]),
             "BLOB": dice.choice([b"", b"x", bytes(8), dice.randbytes(160)])}[kind]
    what = f"{table}.{column} = {value!r}"
    try:
        if dice.random() < 0.15:
            base.execute(f"delete from {table} where {that}", row)
            what = f"a row of {table} deleted"
        else:
            base.execute(f"update {table} set {column} = ? where {that}", (value, *row))
    except sqlite3.Error:
        what = "nothing"
    base.commit()
    base.close()
    return what


def damage(path, dice):
    kind = dice.randrange(8)
    if kind < 2:
        return flip(path, dice, 1)
    if kind == 2:
        return flip(path, dice, dice.randrange(2, 50))
    if kind == 3:
        return lose_page(path, dice, dice.randrange(1, 4))
    if kind == 4:
        return cut(path, dice)
    return tamper(path, dice)


def main():
    program, count = str(pathlib.Path(sys.argv[1]).resolve()), int(sys.argv[2])
    seed = int(sys.argv[3]) if len(sys.argv) > 3 else 1
    faults, codes = [], {}
    with tempfile.TemporaryDirectory() as scratch:
        place = pathlib.Path(scratch)
        (place / "study.json").write_text(STUDY)
        code, said = ran(program, "run", str(place / "study.json"), "--out", str(place / "whole"), "--inline")
        assert code == 0, said
        ran(program, "report", str(place / "whole"))
        whole = tables(place / "whole")
        for number in range(count):
            dice = random.Random(seed * 1000003 + number)
            inside = place / "inside"
            copy = inside / "copy"
            shutil.rmtree(inside, ignore_errors=True)
            shutil.copytree(place / "whole", copy)
            what = damage(copy / "results.sqlite", dice)

            def fault(which, said):
                faults.append(f"{number} ({what}), {which}: {said[:600]}")

            for words in (["report", str(copy)], ["run", str(place / "study.json"), "--out", str(copy), "--inline"]):
                try:
                    code, said = ran(program, *words)
                except subprocess.TimeoutExpired:
                    fault(words[0], "hangs")
                    continue
                codes[words[0], code] = codes.get((words[0], code), 0) + 1
                if code not in (0, 2, 3, 5) or "internal error" in said:
                    fault(words[0], f"exit code {code}: {said}")
                if code != 0 and not said.strip():
                    fault(words[0], f"exit code {code} without a word")
                if any(sign in said for sign in "\x1b\x07\x00"):
                    fault(words[0], "a control character")
                if [one for one in inside.iterdir() if one != copy] or (place / "ESCAPED.csv").exists():
                    fault(words[0], "a file outside the folder")
                if code == 0 and words[0] == "report" and tables(copy) != whole:
                    differ = [name for name in whole if tables(copy).get(name) != whole[name]]
                    fault(words[0], f"other tables in silence: {differ}")
                if code == 0 and words[0] == "run":
                    _, compared = ran(program, "compare", str(place / "whole"), str(copy))
                    if "equal to the last bit" not in compared:
                        fault(words[0], compared)
    print("\n".join(faults))
    print(f"{count} damaged stores, {len(faults)} faults;",
          ", ".join(f"{command} {code}: {n}" for (command, code), n in sorted(codes.items())))
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
