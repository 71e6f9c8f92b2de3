#!/usr/bin/python3
"""Checks that includes point down. usage: check_layers.py [ROOT]

src/layers.txt gives the order of the modules, src/CMakeLists.txt what each one depends on. A module may include its own
headers, the public ones, and those of modules it depends on, all of which lie below it. The command sees the public headers
and its own files, the public headers see each other."""
import re
import sys
from pathlib import Path

INCLUDE = re.compile(r'^\s*#\s*include\s*([<"])([^>"]+)[>"]')
MODULE = re.compile(r"^ax_module\(\s*(\w+)([^)]*)\)", re.MULTILINE)


def read_order(root):
    lines = (root / "src/layers.txt").read_text().splitlines()
    return [line.strip() for line in lines if line.strip() and not line.startswith("#")]


def read_dependencies(root):
    dependencies = {}
    for name, rest in MODULE.findall((root / "src/CMakeLists.txt").read_text()):
        words, keyword, named = rest.split(), None, []
        for word in words:
            if word in ("DEPENDS", "LIBRARIES", "SOURCES"):
                keyword = word
            elif keyword == "DEPENDS":
                named.append(word)
        dependencies[name] = named
    return dependencies


def includes(folder):
    """Yields (place, quoted, included) for every #include below the folder."""
    for path in sorted(folder.rglob("*.[ch]")):
        for number, line in enumerate(path.read_text().splitlines(), 1):
            if match := INCLUDE.match(line):
                yield path, number, match[1] == '"', match[2]


def faults(root):
    order, dependencies = read_order(root), read_dependencies(root)
    rank = {name: place for place, name in enumerate(order)}  # 0 is the top
    for name, below in dependencies.items():
        if name not in rank:
            yield f"src/CMakeLists.txt: {name} has no place in src/layers.txt"
            continue
        for other in below:
            if other not in rank or rank[other] <= rank[name]:
                yield f"src/CMakeLists.txt: {name} depends on {other}, which does not lie below it in src/layers.txt"

    for folder in sorted(path for path in (root / "src").iterdir() if path.is_dir()):
        name = folder.name
        if name not in dependencies:
            yield f"src/{name}: no ax_module({name} ...) in src/CMakeLists.txt"
            continue
        for path, number, quoted, included in includes(folder):
            place, head = f"{path.relative_to(root)}:{number}", included.split("/")[0]
            if head == "ax" or head == name:
                continue
            if quoted and (head not in rank or "/" not in included):
                yield f'{place}: "{included}" names no module: write "module/header.h"'
            elif head in rank and head not in dependencies[name]:
                way = "up" if rank[head] < rank.get(name, len(order)) else "sideways"
                yield f'{place}: {name} includes "{included}", which points {way}: {head} is not among its DEPENDS'

    for place, public_only in (("cli", root / "cli"), ("include", root / "include")):
        for path, number, quoted, included in includes(public_only):
            head = included.split("/")[0]
            own = place == "cli" and ((root / "cli" / included).exists() or (path.parent / included).exists())
            if head != "ax" and not own and (quoted or (head in dependencies and "/" in included)):
                yield f'{path.relative_to(root)}:{number}: "{included}" is not public: only "ax/..." is seen from here'


def main():
    root = Path(sys.argv[1]) if len(sys.argv) > 1 else Path(__file__).resolve().parent.parent
    found = list(faults(root))
    print("\n".join(found) if found else "every include points down")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
