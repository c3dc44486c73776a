"""The same case on one rank and on several: 50 explicit steps and 5 load steps agree to 1e-10, and a run that
goes on with another number of ranks does too.

usage: test_ranks.py WISP RANKS
"""
import os
import sys
import tempfile

import numpy as np

from program import difference, expect, expect_success, wisp, write_case
from wisp.results import Results

STAGES = {
    "explicit": 'type = "explicit"\nduration = 0.05\nsteps = 50\nmass = "consistent"',
    "lumped": 'type = "explicit"\nduration = 0.05\nsteps = 50\nvelocity_update = "apic"',
    "quasi-static": 'type = "quasi-static"\nduration = 1.0\nsteps = 5\ntolerance = 1e-9',
    "clamped on one side": 'type = "quasi-static"\nduration = 1.0\nsteps = 5\ntolerance = 1e-9',
}

WALLS = {
    "14-incline-with-friction": ("stage[0].duration=0.1", "output.checkpoint_every=40"),
    "10-inclined-block": ("output.checkpoint_every=2",),
}


def compare(what, one, other, ignored=()):
    for name, value in difference(one, other).items():
        expect(name in ignored or value <= 1e-10, f"{what}: {name} differs by {value:.2e}")


def main(program, ranks):
    with tempfile.TemporaryDirectory() as folder:
        for name, stage in STAGES.items():
            static = "quasi-static" in stage
            support = {"normal": "x", "at": 0.5} if name.startswith("clamped") else {}  # some ranks hold nothing
            weight = 0.2 if support else 1.0
            case = write_case(folder, f"{name}.toml", basis="linear" if name == "lumped" else "gimp", stage=stage,
                              factor=f"[[0.0, 0.0], [1.0, {weight}]]" if static else "1.0",
                              output=f"frames = 1\ncheckpoint_every = {2 if static else 25}", **support)
            one, many = os.path.join(folder, name + "-1"), os.path.join(folder, name + f"-{ranks}")
            expect_success(wisp(program, "run", case, "--out", one))
            run = wisp(program, "run", case, "--out", many, "--ranks", ranks)
            expect_success(run)
            compare(name, one, many)
            history = Results(many).history
            expect(len(history["step"]) == len(Results(one).history["step"]), f"{name}: rows of the history")
            # Go on from the middle with the results' own number of ranks, and with one.
            middle = os.path.join(many, "checkpoint.txt")
            with open(middle, encoding="utf-8") as stream:
                expect(len(stream.read().splitlines()) >= 3, "two sets of checkpoints are kept")
            end = max(f for f in os.listdir(many) if f.startswith("checkpoint-"))
            newest = end.split(".")[0]
            for file in os.listdir(many):
                if file.startswith(newest):
                    os.truncate(os.path.join(many, file), 64)
            expect_success(wisp(program, "resume", many, "--ranks", "1"))
            compare(name + ", resumed on one rank", one, many)
            for file in os.listdir(one):
                if file.startswith(newest):
                    os.truncate(os.path.join(one, file), 64)
            expect_success(wisp(program, "resume", one, "--ranks", ranks))
            compare(name + ", resumed on several ranks", one, many)
        # Two bodies fly towards each other: on a rank's edge lie functions that only its neighbour's points reach.
        ghosts = os.path.join(os.path.dirname(__file__), "../../examples/03-colliding-ghosts/case.toml")
        folders = [os.path.join(folder, "ghosts-" + number) for number in ("1", ranks)]
        for number, out in zip(("1", ranks), folders):
            expect_success(wisp(program, "run", ghosts, "--out", out, "--ranks", number, "--set", "stage[0].steps=50",
                                "--set", "stage[0].duration=0.175"))
        compare("flying bodies", *folders, ignored=("stress",))  # of free flight: rounding alone
        walls(program, ranks, folder)


def walls(program, ranks, folder):
    """Examples with walls: points, the reactions' history, and both again from a checkpoint in the middle."""
    for example, settings in WALLS.items():
        case = os.path.join(os.path.dirname(__file__), "../../examples", example, "case.toml")
        outs = [os.path.join(folder, f"{example}-{number}") for number in ("1", ranks)]
        for number, out in zip(("1", ranks), outs):
            more = [word for setting in settings for word in ("--set", setting)]
            expect_success(wisp(program, "run", case, "--out", out, "--ranks", number, *more))
        for resumed in (False, True):
            what = example + (", resumed" if resumed else "")
            compare(what, *outs)
            one, many = (Results(out).history for out in outs)
            expect(sorted(one) == sorted(many), f"{what}: columns of the history")
            for name in one:
                scale = max(np.max(np.abs(one[name])), 1e-300)
                gap = np.max(np.abs(np.asarray(one[name]) - np.asarray(many[name]))) / scale
                expect(not any(word in name for word in ("reaction", "moment", "work")) or gap <= 1e-8,
                       f"{what}: {name} of the history differs by {gap:.2e}")
            newest = max(f for f in os.listdir(outs[1]) if f.startswith("checkpoint-")).split(".")[0]
            for file in os.listdir(outs[1]):
                if file.startswith(newest):
                    os.truncate(os.path.join(outs[1], file), 64)
            expect_success(wisp(program, "resume", outs[1], "--ranks", ranks))


if __name__ == "__main__":
    main(*sys.argv[1:])
