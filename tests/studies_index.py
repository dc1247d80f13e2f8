#!/usr/bin/env python3
"""Writes the index of studies/README.md: each study with its question and the first sentence of what it found.

    python3 tests/studies_index.py           writes it, and the questions in studies/findings
    python3 tests/studies_index.py --check   exit code 1 where it would change something

A page of findings has a section for each study, "## NAME"; variants that ask the same stand together, "## NAME, -SUFFIX". What stands
above the first heading of the index is the writer's, and so is the order of its pages.
"""
import json
import pathlib
import re
import sys

from sentences import ends

studies = pathlib.Path(__file__).resolve().parent.parent / "studies"


def rows_of(page, text, questions):
    """The page with the questions of its studies, and its rows of the index. Takes what it names out of `questions`."""
    title, *sections = re.split(r"^## (.*)\n", text, flags=re.M)
    rows = []
    for heading, body in zip(sections[::2], sections[1::2]):
        first_name, *others = heading.split(", ")
        names = [first_name] + [first_name + suffix for suffix in others]
        asked = {questions.pop(name) for name in names}
        if len(asked) != 1:
            sys.exit(f"studies/findings/{page}.md: the studies of {heading} ask different questions")
        question = asked.pop()
        body = re.sub(r"^\n(\*.*\*\n\n)?", f"\n*{question}*\n\n", body)
        first = ends.split(re.sub(r"\s*<!--.*?-->", lambda mark: "" if mark[0].startswith("<!--=") else " ", body.split("\n\n")[1]))[0]
        anchor = re.sub(r"[^\w-]", "", heading.replace(" ", "-"))
        rows.append(f"| [{heading}](findings/{page}.md#{anchor}) | {question} | {' '.join(first.split())} |\n")
        title += f"## {heading}\n{body}"
    return title, rows


def main():
    questions = {path.stem: json.loads(path.read_text())["question"] for path in studies.glob("*.json")}
    readme = (studies / "README.md").read_text()
    now = {}
    index = readme.split("\n## ")[0].rstrip() + "\n"
    pages = re.findall(r"^## .*findings/(.*)\.md", readme, re.M) + sorted(path.stem for path in studies.glob("findings/*.md"))
    for page in dict.fromkeys(pages):
        path = studies / f"findings/{page}.md"
        now[path], rows = rows_of(page, path.read_text(), questions)
        if rows:
            index += f"\n## [{now[path].splitlines()[0][2:]}](findings/{page}.md)\n\n| study | question | what it found |\n|---|---|---|\n"
            index += "".join(rows)
    if questions:
        sys.exit("no page of studies/findings has a section of " + ", ".join(sorted(questions)))
    now[studies / "README.md"] = index
    changed = [path for path, text in now.items() if text != path.read_text()]
    for path in changed:
        print(path.relative_to(studies.parent), "changes" if "--check" in sys.argv else "written")
        if "--check" not in sys.argv:
            path.write_text(now[path])
    return "--check" in sys.argv and bool(changed)


if __name__ == "__main__":
    sys.exit(main())
