#!/usr/bin/env python3
"""Writes DIR/index.html: a card for each folder of results in DIR, with its question, first sentence and first figure.

Reads study.json, verdicts.csv, cases.csv and the beginning of report.html of each; runs nothing. The page needs no
network. Its style is that of the reports.
"""
import csv
import html
import json
import pathlib
import re
import sys
import urllib.parse

FIGURE = re.compile(r'<svg class="ask-figure.*?</svg>', re.S)
SKETCH = re.compile(r'<svg class="sketch.*?</svg>', re.S)
STYLE = re.compile(r"<style>\n(.*?)</style>", re.S)
SIZE = re.compile(r'viewBox="0 0 ([\d.]+) ([\d.]+)"')
TALL = 330  # of a figure that is 400 wide
HEAD = 1_500_000  # characters of a report: its style, sketch and answers

LOCAL = """
.find { display: flex; flex-wrap: wrap; gap: .5rem 1rem; margin: .8rem 0; font-size: .92rem; }
.find label { display: flex; gap: .4rem; align-items: center; }
.find input, .find select { font: inherit; padding: .25rem .4rem; max-width: 100%; color: var(--ink); background: var(--paper); border: 1px solid var(--line); }
.cards { display: grid; grid-template-columns: repeat(auto-fill, minmax(min(100%, 360px), 1fr)); gap: 1rem; padding: 0; list-style: none; max-width: none; }
.cards > li { border: 1px solid var(--rule); padding: .8rem 1rem; min-width: 0; overflow-wrap: anywhere; }
.cards > li[hidden] { display: none; }
.cards h2 { border: 0; margin: 0 0 .3rem; padding: 0; font-size: 1.06rem; }
.cards p { margin: .3rem 0; }
.thumbnail { height: 210px; margin: .5rem 0; }
.thumbnail svg { display: block; width: 100%; max-width: 100%; height: 100%; }
"""

SCRIPT = """"use strict";
const cards = [...document.querySelectorAll(".cards > li")], fields = [...document.querySelectorAll(".find [name]")];
const shown = document.getElementById("shown");
function find() {
  const asked = Object.fromEntries(fields.map((field) => [field.name, field.value.trim()]).filter(([, value]) => value));
  let count = 0;
  for (const card of cards) {
    const fits = Object.entries(asked).every(([name, value]) => name === "words"
      ? value.toLowerCase().split(/\\s+/).every((word) => card.textContent.toLowerCase().includes(word) || card.dataset.method.includes(word))
      : card.dataset[name].split(" ").includes(value));
    card.hidden = !fits;
    count += fits;
  }
  shown.textContent = `${count} of ${cards.length}`;
  const said = new URLSearchParams(asked).toString();
  if (said !== location.hash.slice(1)) history.replaceState(null, "", said ? "#" + said : location.pathname);
}
function read() {
  const asked = new URLSearchParams(location.hash.slice(1));
  for (const field of fields) field.value = asked.get(field.name) ?? "";
  find();
}
for (const field of fields) field.addEventListener("input", find);
addEventListener("hashchange", read);
read();
"""


def names_in(value):
    """The names that a role's choices have."""
    for one in value if isinstance(value, list) else [value]:
        if isinstance(one, dict):
            yield from names_in(one.get("name", []))
        else:
            yield str(one)


def structures_in(study):
    structure = study.get("scene", {}).get("structure", {})
    kinds = structure.get("type", []) if isinstance(structure, dict) else [one.get("type", "") for one in structure]
    return sorted(set(names_in(kinds)))


def first_sentence(folder):
    """What answers the first ask; of a study that asks nothing, how many cases ended as what."""
    path = folder / "verdicts.csv"
    if path.exists():
        with path.open(newline="", encoding="utf-8") as rows:
            for row in csv.DictReader(rows):
                if row["sentence"]:
                    return row["sentence"]
    counts = {}
    with (folder / "cases.csv").open(newline="", encoding="utf-8") as rows:
        for row in csv.DictReader(rows):
            counts[row["status"]] = counts.get(row["status"], 0) + 1
    return "Cases: " + ", ".join(f"{count} {status}" for status, count in counts.items()) + "."


def card(folder):
    study = json.loads((folder / "study.json").read_text(encoding="utf-8"))
    with (folder / "report.html").open(encoding="utf-8") as page:
        report = page.read(HEAD)
    answer = report.find('<section id="answer"')
    figure, sketch = FIGURE.search(report, max(answer, 0)), SKETCH.search(report)
    # A tall figure is no thumbnail: the scene stands for it.
    if figure and sketch and float(SIZE.search(figure.group(0)).group(2)) > TALL:
        figure = None
    figure = figure or sketch
    picture = figure.group(0) if figure else ""
    # It is a picture here: what it links and names belongs to the report.
    picture = re.sub(r' id="[^"]*"', "", picture)
    methods = sorted({name for value in study.get("methods", {}).values() for name in names_in(value)})
    name = study.get("name", folder.name)
    link = urllib.parse.quote(folder.name) + "/report.html"
    say = html.escape
    style = STYLE.search(report)
    return style.group(1) if style else "", {
        "kind": [study.get("kind", "")], "structure": structures_in(study), "method": methods}, f"""<li data-kind="{say(study.get('kind', ''))}" data-structure="{say(' '.join(structures_in(study)))}" data-method="{say(' '.join(methods))}">
<h2><a href="{say(link)}">{say(name)}</a></h2>
<p class="kind">{say(study.get('kind', ''))} · {say(', '.join(structures_in(study)))}</p>
<p>{say(study.get('question', ''))}</p>
<div class="thumbnail" aria-hidden="true">{picture}</div>
<p><strong>{say(first_sentence(folder))}</strong></p>
</li>
"""


def main():
    if len(sys.argv) != 2 or not pathlib.Path(sys.argv[1]).is_dir():
        sys.exit("gallery: expected a folder that holds folders of results")
    root = pathlib.Path(sys.argv[1])
    folders = [one for one in sorted(root.iterdir()) if (one / "report.html").exists() and (one / "study.json").exists()]
    if not folders:
        print(f"gallery: {root} holds no folder of results", file=sys.stderr)
        sys.exit(3)
    made = [card(folder) for folder in folders]
    selects = ""
    for field in ("kind", "structure", "method"):
        values = sorted({value for _, facts, _ in made for value in facts[field] if value})
        selects += f'<label>{field} <select name="{field}"><option value="">all</option>' + "".join(
            f"<option>{html.escape(value)}</option>" for value in values) + "</select></label>\n"
    page = f"""<!DOCTYPE html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta http-equiv="Content-Security-Policy" content="default-src 'none'; script-src 'unsafe-inline'; style-src 'unsafe-inline'; img-src data:; base-uri 'none'; form-action 'none'">
<meta name="viewport" content="width=device-width, initial-scale=1">
<link rel="icon" href="data:,">
<title>Studies · Ricochet</title>
<style>
{made[0][0]}{LOCAL}</style>
</head>
<body>
<header>
<p class="kind">Ricochet</p>
<h1>Is this what the beam does, or what the numerical method does?</h1>
<div class="find">
<label>words <input name="words" type="search"></label>
{selects}<span id="shown" role="status">{len(made)} of {len(made)}</span>
</div>
</header>
<main>
<ul class="cards">
{"".join(text for _, _, text in made)}</ul>
</main>
<footer><p>Written by Ricochet. This file needs no network, and forbids it.</p></footer>
<script>{SCRIPT}</script>
</body>
</html>
"""
    temporary = root / "index.html.new"
    temporary.write_text(page, encoding="utf-8")
    temporary.replace(root / "index.html")
    print(f"gallery: {len(made)} {'study' if len(made) == 1 else 'studies'}: {root / 'index.html'}")


if __name__ == "__main__":
    main()
