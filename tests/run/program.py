"""Runs the program `wisp` for tests, and compares folders of results."""
import os
import subprocess
import sys

import numpy as np

from wisp.results import Results

COLLAPSE = """\
dimension = 2
[grid]
lower = [0.0, 0.0]
upper = [4.0, 2.0]
cells = [16, 8]
[basis]
type = "{basis}"
[[body]]
name = "block"
shape = {{ type = "box", lower = [0.5, 0.25], upper = [2.0, 1.5] }}
sampling = {{ points_per_cell = {points} }}
[body.material]
type = "hencky"
density = 1000.0
young_modulus = 2e5
poisson_ratio = 0.3
[[boundary]]
name = "support"
normal = "{normal}"
at = {at}
directions = ["x", "y"]
[gravity]
acceleration = [0.0, -10.0]
factor = {factor}
{ghost}[[stage]]
{stage}
[output]
{output}
"""


def wisp(program, *arguments, **options):
    """The finished process; its words are shown where a test fails."""
    return subprocess.run([program, *arguments], text=True, capture_output=True, timeout=300, **options)


def expect(condition, message):
    if not condition:
        print(f"failed: {message}", file=sys.stderr)
        sys.exit(1)


def expect_success(process):
    expect(process.returncode == 0, f"{process.args}: status {process.returncode}\n{process.stdout}\n{process.stderr}")


def write_case(folder, name="case.toml", **keys):
    path = os.path.join(folder, name)
    values = {"basis": "linear", "points": 2, "factor": "1.0", "output": "frames = 2", "normal": "y",
              "at": 0.25}
    lumped = '"explicit"' in keys["stage"] and "consistent" not in keys["stage"]
    values["ghost"] = "" if lumped else "[stabilisation]\n"
    with open(path, "w", encoding="utf-8") as stream:
        stream.write(COLLAPSE.format(**(values | keys)))
    return path


def difference(one, other):
    """Greatest relative difference of the fields of the last states, points matched by their ids."""
    a, b = Results(one).points(), Results(other).points()
    expect(len(a["id"]) == len(b["id"]), f"{len(a['id'])} and {len(b['id'])} points")
    row_a, row_b = np.argsort(a["id"]), np.argsort(b["id"])
    worst = {}
    for name in ["positions"] + a.field_names():
        x, y = np.asarray(a[name], float)[row_a], np.asarray(b[name], float)[row_b]
        scale = np.max(np.abs(x), initial=0.0)
        worst[name] = np.max(np.abs(x - y), initial=0.0) / scale if scale > 0 else np.max(np.abs(y), initial=0.0)
    return worst


def same_files(one, other):
    """Names of results that are not alike to the last bit; checkpoints carry the date of their writing."""
    names = sorted(name for name in os.listdir(one) if not name.startswith("checkpoint"))
    different = []
    for name in names:
        pair = []
        for folder in (one, other):
            path = os.path.join(folder, name)
            pair.append(open(path, "rb").read() if os.path.exists(path) else None)
        if pair[0] != pair[1]:
            different.append(name)
    return names, different
