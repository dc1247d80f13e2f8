#!/usr/bin/env python3
"""What a plugin built before would read wrongly: the binary interface of core/contract, and the tag that guards it.

    python3 tests/contract_layout.py [--write] OBJECT_FILE

Prints nothing and exits with 0 where the interface is that of tests/contract/layout.txt. Members stand there with their
offsets, virtual functions with their slots and arguments, enumerators with their values. A change needs another
RICOCHET_ABI_CONTRACT: plugins of the tag before would be loaded and called wrongly. `--write` stores an interface that
has a tag of its own.
"""
import difflib
import pathlib
import re
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
STORED = ROOT / "tests" / "contract" / "layout.txt"
ENTRY = re.compile(r" <(\d+)><[0-9a-f]+>: Abbrev Number: \d+ \(DW_TAG_(\w+)\)")
VALUE = re.compile(r"    <[0-9a-f]+>   DW_AT_(\w+) *: (?:\([a-z_0-9]+\) ?)?(?:\(offset: 0x[0-9a-f]+\): )?(.*)")
KINDS = {"class_type": "class", "structure_type": "struct", "enumeration_type": "enum"}


def tag():
    return int(re.search(r"#define RICOCHET_ABI_CONTRACT (\d+)", (ROOT / "core" / "contract" / "abi.hpp").read_text())[1])


def entries(text):
    """(depth, tag, attributes) of each entry of debug information."""
    now = None
    for line in text.splitlines():
        begins = ENTRY.match(line)
        if begins:
            if now:
                yield now
            now = (int(begins[1]), begins[2], {})
        elif now and (value := VALUE.match(line)):
            now[2][value[1]] = value[2].strip()
    if now:
        yield now


def described(text):
    """{"struct Stage": ["296 bytes", "+0 matrix", …]} of what namespace ricochet has."""
    found, path, scopes = {}, [], {}  # lines of the type that is open at each depth
    for depth, kind, values in entries(text):
        del path[depth - 1:]
        path += [""] * (depth - 1 - len(path)) + [values.get("name", "")]
        lines = scopes.get(depth - 1)
        scopes[depth] = None
        if kind in KINDS:
            # A declaration alone has no size.
            if len(path) > 1 and path[0] == "ricochet" and "name" in values and "byte_size" in values:
                scopes[depth] = found.setdefault(f"{KINDS[kind]} {'::'.join(path[1:])}", [])
                scopes[depth].append(f"{values['byte_size']} bytes")
        elif lines is None:
            continue
        elif kind == "enumerator":
            lines.append(f"{values['const_value']} {values['name']}")
        elif kind == "member" and "data_member_location" in values:
            lines.append(f"+{values['data_member_location']} {values['name']}")
        elif kind == "subprogram" and "vtable_elem_location" in values:
            slot = re.search(r"DW_OP_constu: (\d+)", values["vtable_elem_location"])[1]
            lines.append(f"@{slot} {values['linkage_name']}")
    return {name: list(dict.fromkeys(lines)) for name, lines in found.items() if "<" not in name}


def layout(object_file):
    read = subprocess.run(["readelf", "--debug-dump=info", "--wide", object_file], check=True, capture_output=True,
                          text=True).stdout
    found = described(read)
    text = "".join(f"{name}\n" + "".join(f"  {line}\n" for line in lines) for name, lines in sorted(found.items()))
    return subprocess.run(["c++filt"], input=text, check=True, capture_output=True, text=True).stdout


def main():
    write = sys.argv[1] == "--write"
    now = f"contract {tag()}\n" + layout(sys.argv[-1])
    stored = STORED.read_text() if STORED.exists() else ""
    if now == stored:
        return 0
    before, after = stored.splitlines(), now.splitlines()
    if before[:1] == after[:1]:
        print("\n".join(list(difflib.unified_diff(before, after, "stored", "now", lineterm="", n=1))[:60]))
        print(f"The binary interface changed under tag {tag()}: raise RICOCHET_ABI_CONTRACT, then store it with --write")
        return 1
    if not write:
        print("This tag has no stored interface: store it with --write")
        return 1
    STORED.write_text(now)
    return 0


sys.exit(main())
