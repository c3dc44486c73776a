#!/usr/bin/python3
"""Checks the house rules that a compiler does not: no include against the order of the layers, no file that has grown
too long, no type name that says nothing. Prints one line, file:line: message, per offence; exit status 1 if any.

Usage: check_layers.py ROOT           checks the tree at ROOT
       check_layers.py --self-test    proves on small trees that each offence is found and that a good tree passes
"""
import pathlib
import re
import sys
import tempfile

SUFFIXES = {".h", ".cpp", ".cc"}
MOST_LINES = 600
VERIFICATION_LAYER = 9
BANNED = ("Manager", "Handler", "Helper", "Utils", "Data", "Info", "Base")

ROOM = re.compile(r"^\s*wisp_room\(\s*(\w+)\s+(\d+)", re.MULTILINE)
INCLUDE = re.compile(r'^\s*#\s*include\s*[<"](\w+)/[^">]+[">]')
QUOTED = re.compile(r'^\s*#\s*include\s*"([^"]*)"')
TYPE = re.compile(r"^\s*(?:template\s*<.*>\s*)?(?:class|struct|enum(?:\s+class)?|union)\s+(?:\[\[\w+\]\]\s*)?(\w+)")
ALIAS = re.compile(r"^\s*using\s+(\w+)\s*=")


def read_layers(root):
    """Layer number of each room, from the one place that states them."""
    layers = {name: int(layer) for name, layer in ROOM.findall((root / "CMakeLists.txt").read_text())}
    if not layers:
        raise SystemExit(f"{root}/CMakeLists.txt: no wisp_room(name layer ...) found")
    layers["verification"] = VERIFICATION_LAYER
    return layers


def sources(folder):
    return sorted(p for p in folder.rglob("*") if p.suffix in SUFFIXES and p.is_file()) if folder.is_dir() else []


def code_lines(path):
    """Numbered lines without block and line comments, so that an example in a comment is no offence."""
    inside = False
    for number, line in enumerate(path.read_text().splitlines(), 1):
        code = ""
        while line:
            mark = line.find("*/" if inside else "/*")
            slashes = -1 if inside else line.find("//")
            if slashes >= 0 and (mark < 0 or slashes < mark):
                code, line = code + line[:slashes], ""
            elif mark < 0:
                code, line = code + ("" if inside else line), ""
            else:
                code, line, inside = code + ("" if inside else line[:mark]), line[mark + 2:], not inside
        yield number, code


def check(root):
    """All offences of the tree, as lines of text."""
    layers = read_layers(root)
    offences = []
    rooms = sorted(p for p in (root / "src").iterdir() if p.is_dir())
    for room in rooms:
        if room.name not in layers and sources(room):
            offences.append(f"src/{room.name}:1: this folder has no wisp_room(...) line in CMakeLists.txt")
    places = [(path, room.name) for room in rooms if room.name in layers for path in sources(room)]
    places += [(path, "verification") for path in sources(root / "verification")]
    for path, room in places:
        for number, code in code_lines(path):
            found = INCLUDE.match(code)
            if found and found[1] in layers and found[1] != room and layers[found[1]] >= layers[room]:
                offences.append(f"{path.relative_to(root)}:{number}: {room} (layer {layers[room]}) must not include "
                                f"{found[1]} (layer {layers[found[1]]})")
            quoted = QUOTED.match(code)
            if quoted and quoted[1].split("/")[0] not in layers:
                offences.append(f'{path.relative_to(root)}:{number}: includes "{quoted[1]}"; write "room/file.h"')
    everything = [path for folder in ("src", "verification", "tests", "benchmarks") for path in sources(root / folder)]
    for path in everything:
        count = len(path.read_text().splitlines())
        if count > MOST_LINES:
            offences.append(f"{path.relative_to(root)}:{MOST_LINES + 1}: {count} lines, more than {MOST_LINES}: "
                            "split it by idea")
        for number, code in code_lines(path):
            found = TYPE.match(code) or ALIAS.match(code)
            if found and found[1].endswith(BANNED):
                offences.append(f"{path.relative_to(root)}:{number}: the name {found[1]} says nothing: "
                                f"no type ends in {', '.join(BANNED)}")
    return offences


GOOD = {
    "CMakeLists.txt": "wisp_room(core 0)\nwisp_room(grid   2 ROOMS core)\nwisp_room(linear 2)\nwisp_room(io 7)\n",
    "src/core/error.h": "struct Error {};\n",
    "src/grid/grid.h": '#include "core/error.h"\n#include "grid/cell.h"\n#include <sys/stat.h>\n// class GridManager\n',
    "src/grid/cell.h": '/* an example:\n#include "io/vtu.h"\n*/\nclass Database {};  // struct CellInfo\n',
    "src/io/vtu.h": '#include "grid/grid.h"\nstruct Baseline {};\n' + "\n" * (MOST_LINES - 2),
    "verification/paper/table.cpp": '#include "io/vtu.h"\n#include "verification/rows.h"\n',
}
# Each change of the good tree must give exactly this offence.
BAD = {
    "a higher room": ("src/grid/grid.h", '#include "core/error.h"\n\n  # include "io/vtu.h"\n', "src/grid/grid.h:3: grid"),
    "a room of the same layer": ("src/grid/cell.h", '#include "linear/matrix.h"\n', "src/grid/cell.h:1: grid"),
    "verification in a room": ("src/io/vtu.h", '#include "verification/rows.h"\n', "src/io/vtu.h:1: io (layer 7)"),
    "angle brackets": ("src/core/error.h", "/* why */ #include <grid/grid.h>\n", "src/core/error.h:1: core"),
    "after a comment": ("src/core/error.h", '/* one\n*/\n#include "io/vtu.h"\n', "src/core/error.h:3: core"),
    "no room named": ("src/core/error.h", '#include "describe.h"\n', 'src/core/error.h:1: includes "describe.h"'),
    "a path upwards": ("src/grid/grid.h", '#include "../io/vtu.h"\n', 'src/grid/grid.h:1: includes "../io'),
    "a folder without a layer": ("src/misc/misc.h", "struct Anything {};\n", "src/misc:1: this folder has no wisp_room"),
    "a long file": ("src/io/vtu.h", "\n" * (MOST_LINES + 1), f"src/io/vtu.h:{MOST_LINES + 1}: {MOST_LINES + 1} lines"),
    "a long test": ("tests/io/vtu_test.cpp", "\n" * 700, "tests/io/vtu_test.cpp:601: 700 lines"),
    "an empty name": ("src/io/vtu.h", "\ntemplate <int dim> class PointManager {\n", "src/io/vtu.h:2: the name PointM"),
    "an empty enum": ("src/io/vtu.h", "enum class CellInfo { a };\n", "src/io/vtu.h:1: the name CellInfo"),
    "an empty alias": ("src/io/vtu.h", "using GridData = int;\n", "src/io/vtu.h:1: the name GridData"),
    "an empty base": ("src/io/vtu.h", "struct MaterialBase;\n", "src/io/vtu.h:1: the name MaterialBase"),
}


def offences_of(tree):
    with tempfile.TemporaryDirectory() as folder:
        root = pathlib.Path(folder)
        for name, text in tree.items():
            (root / name).parent.mkdir(parents=True, exist_ok=True)
            (root / name).write_text(text)
        return check(root)


def self_test():
    wrong = [f"good tree: unexpected {line}" for line in offences_of(GOOD)]
    for title, (name, text, expected) in BAD.items():
        found = offences_of({**GOOD, name: text})
        if len(found) != 1 or not found[0].startswith(expected):
            wrong.append(f"{title}: expected one offence '{expected}...', found {found}")
    return wrong


def main():
    if len(sys.argv) != 2:
        raise SystemExit(__doc__)
    lines = self_test() if sys.argv[1] == "--self-test" else check(pathlib.Path(sys.argv[1]).resolve())
    print("\n".join(lines), end="\n" if lines else "")
    return 1 if lines else 0


if __name__ == "__main__":
    sys.exit(main())
