"""The same case on one rank and on several: 50 explicit steps and 5 load steps agree to 1e-10, and a run that
goes on with another number of ranks does too.

usage: test_ranks.py WISP RANKS
"""
import os
import sys
import tempfile

from program import difference, expect, expect_success, wisp, write_case
from wisp.results import Results

STAGES = {
    "explicit": 'type = "explicit"\nduration = 0.05\nsteps = 50\nmass = "consistent"',
    "lumped": 'type = "explicit"\nduration = 0.05\nsteps = 50\nvelocity_update = "apic"',
    "quasi-static": 'type = "quasi-static"\nduration = 1.0\nsteps = 5\ntolerance = 1e-9',
    "clamped on one side": 'type = "quasi-static"\nduration = 1.0\nsteps = 5\ntolerance = 1e-9',
}


def compare(what, one, other):
    for name, value in difference(one, other).items():
        expect(value <= 1e-10, f"{what}: {name} differs by {value:.2e}")


def main(program, ranks):
    with tempfile.TemporaryDirectory() as folder:
        for name, stage in STAGES.items():
            static = "quasi-static" in stage
            support = {"normal": "x", "at": 0.5} if name.startswith("clamped") else {}  # some ranks hold nothing
            case = write_case(folder, f"{name}.toml", basis="linear" if name == "lumped" else "gimp", stage=stage,
                              factor="[[0.0, 0.0], [1.0, 1.0]]" if static else "1.0",
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


if __name__ == "__main__":
    main(*sys.argv[1:])
