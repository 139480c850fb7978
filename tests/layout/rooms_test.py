#!/usr/bin/env python3
"""The structure of the sources: layers, rooms, sizes. Prints what breaks a rule; exits with 1 then.

    rooms_test.py [ROOT]

- A layer includes the layers below it and none above: app, render, sim, kernels.
- No two rooms include each other, directly or in a circle. A room is a folder with sources; the
  files that lie in `sim/` or `kernels/` themselves are a room too. The folders of `app/cli` and of
  `app/window` are parts of one room.
- No source has more than 600 lines."""
import pathlib
import re
import sys

LAYERS = ("kernels", "sim", "render", "app")
PARTS = {"app/cli/commands": "app/cli", "app/window/panels": "app/window",
         "app/suites/bench": "app/suites", "app/suites/report": "app/suites",
         "app/suites/stability": "app/suites", "app/suites/validation": "app/suites",
         "sim/cuda": "sim", "render/cuda": "render"}
MOST_LINES = 600


def sources(root):
    for layer in LAYERS:
        for path in sorted((root / layer).rglob("*")):
            if path.suffix in (".h", ".cpp", ".cu", ".cuh"):
                yield path.relative_to(root).as_posix(), path.read_text().splitlines()


def room_of(file):
    folder = file.rsplit("/", 1)[0]
    return PARTS.get(folder, folder)


def circles(arrows):
    """Strongly connected groups of more than one room, by walking from each room to itself."""
    def reached(start):
        seen, todo = set(), [start]
        while todo:
            for target in arrows.get(todo.pop(), {}):
                if target not in seen:
                    seen.add(target)
                    todo.append(target)
        return seen
    reach = {room: reached(room) for room in arrows}
    return sorted({tuple(sorted(r for r in reach[room] if room in reach.get(r, ()))) for room in arrows
                   if room in reach[room]})


def main():
    root = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else pathlib.Path(__file__).parents[2])
    faults, arrows, files = [], {}, 0
    for file, lines in sources(root):
        files += 1
        if len(lines) > MOST_LINES:
            faults.append(f"{file}: {len(lines)} lines, expected at most {MOST_LINES}")
        for number, line in enumerate(lines, 1):
            match = re.match(r'\s*#include "([^"]+)"', line)
            if not match or not match.group(1).startswith(tuple(layer + "/" for layer in LAYERS)):
                continue
            target = match.group(1)
            if LAYERS.index(target.split("/")[0]) > LAYERS.index(file.split("/")[0]):
                faults.append(f"{file}:{number}: includes {target} of a layer above")
            if room_of(target) != room_of(file):
                arrows.setdefault(room_of(file), {}).setdefault(room_of(target), f"{file}:{number}")
    for group in circles(arrows):
        for room in group:
            for target, place in arrows[room].items():
                if target in group:
                    faults.append(f"{place}: {room} includes {target}, which includes it in turn")

    print("\n".join(faults) or f"{files} files in {len(arrows)} rooms that include others: no circle")
    return 1 if faults or not files else 0


if __name__ == "__main__":
    sys.exit(main())
