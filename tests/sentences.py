#!/usr/bin/env python3
"""Sentences of the Markdown pages: number, median and longest in words, and words that pages avoid.

    python3 tests/sentences.py           prints every page
    python3 tests/sentences.py 25        prints each sentence of more than 25 words as well
    python3 tests/sentences.py --check   exit code 1 where a page in `limits` is longer than it may be

Tables, code, headings and comments are left out. Code within a line counts as one word.
"""
import pathlib
import re
import statistics
import sys

# page: most lines, most words of the median sentence
limits = {"core/README.md": (120, 18), "core/glossary.md": (80, 18), "runners/README.md": (290, 18),
          "runners/operations.md": (120, 18), ".github/CONTRIBUTING.md": (60, 18), "studies/README.md": (140, 18)}
limits_of_folders = {"core/numerics": (80, 18), "studies/findings": (300, 18)}
avoided = re.compile(r"\b(seats?|crews?|pioneers?|rooms?|houses?|guests?|strangers?|parcels?|company|a march|marches)\b", re.I)
starts_item = re.compile(r"^\s*([*-]|\d+\.) ")
ends = re.compile(r"(?<=[.!?])[*)”\"]*\s+(?=[^a-z]|[a-z]\b)")


def sentences(text):
    text = re.sub(r"<!--.*?-->|```.*?```", "", text, flags=re.S)
    text = re.sub(r"`[^`]*`", "Code", re.sub(r"!?\[([^\]]*)\]\([^)]*\)", r"\1", text))
    paragraphs, goes_on = [], False
    for line in text.splitlines():
        if not line.strip() or line.startswith(("#", "|", "    ", "[")):
            goes_on = False
        elif goes_on and not starts_item.match(line):
            paragraphs[-1] += " " + line.strip()
        else:
            paragraphs.append(starts_item.sub("", line, count=1))
            goes_on = True
    return [s for p in paragraphs for s in ends.split(p) if words(s)]


def words(sentence):
    return sum(bool(re.search(r"\w", word)) for word in sentence.split())


def main():
    root = pathlib.Path(__file__).resolve().parent.parent
    longest = next((int(a) for a in sys.argv[1:] if a.isdigit()), None)
    wrong = False
    for path in sorted(root.rglob("*.md")):
        page = path.relative_to(root).as_posix()
        if page.startswith(("build", "results")) or "node_modules" in page:
            continue
        text = path.read_text()
        found = sentences(text)
        lengths = [words(s) for s in found] or [0]
        lines, median = text.count("\n"), statistics.median(lengths)
        private = sorted({m.group(0).lower() for m in avoided.finditer(re.sub(r"`[^`]*`", "", text))})
        print(f"{page:36} {lines:4} lines {len(found):4} sentences, median {median:4.1f}, longest {max(lengths):3}", *private)
        for sentence in found:
            if longest and words(sentence) > longest:
                print(f"    {words(sentence)}: {sentence}")
        limit = limits.get(page, limits_of_folders.get(page.rpartition("/")[0]))
        if limit and (lines > limit[0] or median > limit[1]):
            wrong = True
            print(f"    at most {limit[0]} lines and a median of {limit[1]} words")
    return wrong and "--check" in sys.argv


if __name__ == "__main__":
    sys.exit(main())
