#!/usr/bin/env python3
"""Studies that ship, made small and changed at random so that many still march.

    python3 tests/mutated_studies.py build/release/bin/ricochet 2000 [SEED]

Numbers are scaled, up to 300 decades, or become the ends of what a double, or a text, can say; methods become others of
their role; keys go. An ask that the smaller study cannot answer goes too, and the study is tried again. What a study
made is drawn again by `report`. The law: no signal, no hang, no internal error, no control character; exit code 2 with
a place in the study, or 0 or 3 with a report whose tables have no cell that is not a number. Exit code 1 where it does
not hold. The last line counts how the studies ended: those of 0 and 3 marched.
"""
import csv
import json
import pathlib
import random
import re
import shutil
import subprocess
import sys
import tempfile

from damaged_stores import ran

STUDIES = pathlib.Path(__file__).resolve().parent.parent / "studies"
FACTORS = [0.1, 0.5, 0.9, 1.1, 2, 10] * 3 + [0, -1, 1e3, 1e-3, 1e6, 1e-6, 1e12, 1e-12, 1e100, 1e-100, 1e300, 1e-300]
# As they stand in the text, and a list of more numbers than a study may have cases.
EXTREMES = ["1e308", "-1e308", "-0.0", "-0", "5e-324", "8e-312", "2.3e-308", "1e400", "1e-400", "NaN", "-Infinity",
            '"NaN"', '"inf"', "9223372036854775807", "18446744073709551616", "null", "[]", "[[1]]", "{}", "LIST"]
FORM = ("elements", "samples", "transient", "keep", "steps_per_period", "repeats", "compare", "observe", "outputs", "modes")
ENDS = {"work-precision": {"repeats": 1, "samples": 20}, "convergence": {"samples": 20}}


def few(dice, value, most=2):
    """One or two of a list, in its order."""
    if not isinstance(value, list) or len(value) <= most:
        return value
    return [value[i] for i in sorted(dice.sample(range(len(value)), dice.randint(1, most)))]


def smaller(dice, study):
    """A study of a few cases, of some hundred steps each."""
    for role, methods in study["methods"].items():
        study["methods"][role] = [
            {key: few(dice, value, 1) for key, value in one.items()} if isinstance(one, dict) else one
            for one in few(dice, methods if isinstance(methods, list) else [methods])]
    if "mesh" in study:
        mesh = study["mesh"]
        if "elements" in mesh:
            mesh["elements"] = dice.choice([2, 3, 5, [2, 4]])
        for key in mesh:
            mesh[key] = few(dice, mesh[key], 1)
    for key in ("step", "steps", "steps_per_period"):
        study[key] = few(dice, study[key], 3) if key in study else None
        if study[key] is None:
            del study[key]
    numbers = study.get("step")
    numbers = numbers if isinstance(numbers, list) else [numbers]
    if "duration" in study and all(isinstance(one, (int, float)) for one in numbers):
        study["duration"] = max(numbers) * dice.choice([3, 20, 100])
        study.pop("window", None)
        study.pop("horizon", None)
    if "steps_per_period" in study:
        study["steps_per_period"] = dice.choice([16, 40, 100])
    if "transient" in study:
        study["transient"] = {"periods": dice.randint(1, 6), "at_most": dice.randint(6, 12)}
    if "keep" in study:
        study["keep"] = dice.choice([16, 20])
    if "parameter" in study and "values" in study["parameter"]:
        study["parameter"]["values"] = few(dice, study["parameter"]["values"], 2)
    if "parameter" in study and "count" in study["parameter"]:
        study["parameter"]["count"] = dice.randint(2, 4)
    for axis in study.get("axes", {}).values() if isinstance(study.get("axes"), dict) else study.get("axes", []):
        if isinstance(axis, dict) and "count" in axis:
            axis["count"] = dice.randint(2, 4)
    if dice.random() < 0.5:
        study.pop("refine", None)
    for key in ("exclude", "compare"):
        study.pop(key, None)
    study.update({key: value for key, value in ENDS.get(study["kind"], {}).items() if key in study})
    study["budget"] = 1
    return study


def leaves(value, at=()):
    if isinstance(value, dict):
        for key, one in value.items():
            if key not in ("name", "question", "//", "kind", "budget"):
                yield from leaves(one, at + (key,))
    elif isinstance(value, list):
        for i, one in enumerate(value):
            yield from leaves(one, at + (i,))
    else:
        yield at, value


def put(study, at, value):
    for key in at[:-1]:
        study = study[key]
    study[at[-1]] = value


def scaled(dice, number):
    value = number * dice.choice(FACTORS)
    if isinstance(number, int) and abs(value) < 1e6:
        return int(value)
    return value if abs(value) < float("inf") else number


def extreme(dice):
    """A mark that written() puts such a text in the place of."""
    return f"<{dice.choice(EXTREMES)}>"


def written(study):
    numbers = "[" + ", ".join(str(1 + i / 4096) for i in range(200001)) + "]"
    text = json.dumps(study, indent=1)
    for one in EXTREMES:
        text = text.replace(json.dumps(f"<{one}>"), numbers if one == "LIST" else one)
    return text


def mutated(dice, study, methods):
    for role in study["methods"]:
        if dice.random() < 0.4:
            study["methods"][role] = [dice.choice(methods[role])]
    for _ in range(dice.choice([0, 1, 1, 2, 3])):
        at, value = dice.choice(list(leaves(study)))
        if any(key in FORM for key in at) and dice.random() < 0.9:
            continue
        if isinstance(value, bool):
            put(study, at, not value)
        elif isinstance(value, (int, float)):
            put(study, at, extreme(dice) if dice.random() < 0.2 else scaled(dice, value))
        elif isinstance(value, str) and dice.random() < 0.3:
            number = re.search(r"[0-9]+(?:\.[0-9]+)?(?:e-?[0-9]+)?", value)
            if number and at[0] == "scene":
                put(study, at, value.replace(number.group(), f"{float(number.group()) * dice.choice(FACTORS):g}", 1))
    if dice.random() < 0.1:
        at, _ = dice.choice(list(leaves(study)))
        inside = study
        for key in at[:-1]:
            inside = inside[key]
        if isinstance(inside, dict):
            del inside[at[-1]]
    return study


def without(study, said):
    """The study without what a refusal points at, where that is an ask or a measure; else nothing."""
    place = re.search(r"at /(ask|observe)(?:/(\d+))?", said)
    if not place or place.group(1) not in study:
        return None
    key, number = place.group(1), place.group(2)
    kept = study[key]
    if isinstance(kept, list) and number and int(number) < len(kept):
        kept = kept[:int(number)] + kept[int(number) + 1:]
        return {**study, key: kept} if kept else {k: v for k, v in study.items() if k != key}
    return {k: v for k, v in study.items() if k != key}


def wrong_cells(folder):
    """Cells of tables that are no numbers, though no word of Ricochet."""
    for path in sorted(folder.rglob("*.csv")):
        with open(path, newline="", encoding="utf-8") as table:
            for row in csv.reader(table):
                for cell in row:
                    if re.fullmatch(r"[-+]?(nan|inf)", cell.strip()):
                        return f"{path.name}: {','.join(row)[:200]}"
    return ""


def main():
    program, count = str(pathlib.Path(sys.argv[1]).resolve()), int(sys.argv[2])
    seed = int(sys.argv[3]) if len(sys.argv) > 3 else 1
    shipped = sorted(STUDIES.glob("*.json"))
    methods = {}  # of each role, as studies name them with their parameters
    for path in shipped:
        for role, given in json.loads(path.read_text())["methods"].items():
            for one in given if isinstance(given, list) else [given]:
                one = {key: few(random.Random(1), value, 1) for key, value in one.items()} if isinstance(one, dict) else one
                if one not in methods.setdefault(role, []):
                    methods[role].append(one)
    faults, codes = [], {}
    with tempfile.TemporaryDirectory() as scratch:
        place = pathlib.Path(scratch)
        for entry in STUDIES.iterdir():
            if entry.is_dir():
                shutil.copytree(entry, place / entry.name)
        for number in range(count):
            dice = random.Random(seed * 1000003 + number)
            path = dice.choice(shipped)
            study = mutated(dice, smaller(dice, json.loads(path.read_text())), methods)
            file, out = place / "study.json", place / "out"
            way = dice.choice([[], [], ["--inline"]])
            while study:
                file.write_text(written(study))
                shutil.rmtree(out, ignore_errors=True)
                try:
                    code, said = ran(program, "run", str(file), "--out", str(out), *way)
                except subprocess.TimeoutExpired:
                    code, said = "hangs", ""
                study = without(study, said) if code == 2 else None
            codes[code] = codes.get(code, 0) + 1
            why = ""
            if code not in (0, 2, 3):
                why = f"exit code {code}: {said[-600:]}"
            elif "internal error" in said or "Sanitizer" in said or "runtime error" in said:
                why = said[-600:]
            elif any(sign in said for sign in "\x1b\x07\x00"):
                why = "a control character"
            elif code == 2 and not re.search(r"study\.json:\d+|at /", said):
                why = f"no place: {said[:300]}"
            elif code != 2:
                why = wrong_cells(out) if (out / "report.html").exists() else "no report"
                again, told = ran(program, "report", str(out))
                if not why and again not in (0, 3):
                    why = f"report: exit code {again}: {told[-600:]}"
            if why:
                kept = pathlib.Path(tempfile.gettempdir()) / f"mutated-{seed}-{number}.json"
                shutil.copy(file, kept)
                faults.append(f"{number} ({path.name}, kept as {kept}): {why}")
                print(faults[-1], flush=True)
    print(f"{count} studies: " + ", ".join(f"exit code {code}: {n}" for code, n in sorted(codes.items(), key=str)))
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
