#!/usr/bin/python3
"""check_layers.py FOLDER: a room (folder of src/) includes only rooms of a lower layer and itself. The layers stand in
CMakeLists.txt, wisp_room(NAME LAYER ...). Prints one line per fault; exit status 1 if there is one."""
import pathlib
import re
import sys


def faults(root):
    rooms = {name: int(layer) for name, layer in
             re.findall(r"^wisp_room\((\w+)\s+(\d+)", (root / "CMakeLists.txt").read_text(encoding="utf-8"), re.M)}
    if not rooms:
        yield "CMakeLists.txt names no room"
    for file in sorted((root / "src").rglob("*")):
        if file.suffix not in (".h", ".cpp", ".cc"):
            continue
        place = file.relative_to(root)
        room = place.parts[1]
        if room not in rooms:
            yield f"{place}: {room} is no room of CMakeLists.txt"
            continue
        for number, line in enumerate(file.read_text(encoding="utf-8").splitlines(), 1):
            include = re.match(r'\s*#\s*include\s*"([^"]+)"', line)
            if not include:
                continue
            target = include.group(1).split("/")[0]
            if target not in rooms:
                yield f'{place}:{number}: includes "{include.group(1)}"; write "room/file.h"'
            elif target != room and rooms[target] >= rooms[room]:
                yield (f"{place}:{number}: {room} (layer {rooms[room]}) includes {include.group(1)} "
                       f"(layer {rooms[target]})")


if __name__ == "__main__":
    found = list(faults(pathlib.Path(sys.argv[1])))
    print(*found, f"{len(found)} includes against the order of the rooms", sep="\n")
    sys.exit(bool(found))
