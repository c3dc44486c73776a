"""What a run says and leaves behind: a summary, one line for each error, nothing after bad input.

usage: test_words.py WISP
"""
import os
import sys
import tempfile

from program import expect, expect_success, wisp, write_case

STAGE = 'type = "explicit"\nduration = 0.05\nsteps = 50'


def error_lines(process):
    return [line for line in process.stderr.splitlines() if line.strip()]


TRIANGLES = """$MeshFormat
2.2 0 8
$EndMeshFormat
$Nodes
4
1 0 0 0
2 4 0 0
3 4 2 0
4 0 2 0
$EndNodes
$Elements
2
1 2 2 0 1 1 2 3
2 2 2 0 1 1 {} {}
$EndElements
"""


def bad_geometry(program, folder):
    """Meshes, surfaces and walls that cannot be: one line, status 2, nothing written."""
    cases = {
        "overlap": ('type = "gmsh"\nfile = "mesh.msh"', TRIANGLES.format(2, 4), "overlap"),
        "inverted": ('type = "gmsh"\nfile = "mesh.msh"', TRIANGLES.format(4, 3), "inverted"),
        "short": ('type = "gmsh"\nfile = "mesh.msh"', TRIANGLES[:100], "cut short"),
    }
    lines = "lower = [0.0, 0.0]\nupper = [4.0, 2.0]\ncells = [16, 8]"
    good = open(write_case(folder, "geometry.toml", stage=STAGE), encoding="utf-8").read()
    good = good.replace('normal = "y"\nat = 0.25\ndirections = ["x", "y"]',
                        'type = "wall"\nshape = { type = "plane", point = [0.0, 0.25], normal = [0.0, 1.0] }')
    texts = {name: (good.replace(lines, grid), mesh, words) for name, (grid, mesh, words) in cases.items()}
    texts["behind"] = (good.replace("normal = [0.0, 1.0]", "normal = [0.0, -1.0]"), "", "lies wholly behind wall")
    texts["outside"] = (good.replace("point = [0.0, 0.25]", "point = [0.0, -9.0]"), "", "no part of wall")
    texts["line"] = (good.replace('type = "plane", point = [0.0, 0.25], normal = [0.0, 1.0]',
                                  'type = "polyline", vertices = [[0, 0], [1, 0]], solid = "inside"'), "", "closed line")
    for name, (text, mesh, words) in texts.items():
        path = os.path.join(folder, f"{name}.toml")
        for file, content in ((path, text), (os.path.join(folder, "mesh.msh"), mesh)):
            with open(file, "w", encoding="utf-8") as stream:
                stream.write(content)
        out = os.path.join(folder, name)
        bad = wisp(program, "run", path, "--out", out)
        lines_said = error_lines(bad)
        expect(bad.returncode == 2 and len(lines_said) == 1 and words in lines_said[0],
               f"{name}: {bad.returncode}: {bad.stderr}")
        expect(not os.path.exists(out), f"{name}: bad input left a folder")


def main(program):
    with tempfile.TemporaryDirectory() as folder:
        out = os.path.join(folder, "out")
        good = write_case(folder, stage=STAGE)
        run = wisp(program, "run", good, "--out", out)
        expect_success(run)
        for words in ("ns/point/step", "GB/s", f"wisp picture {out}", "points.pvd", "history.csv"):
            expect(words in run.stdout, f"no '{words}' in\n{run.stdout}")
        for file in ("case.toml", "scene.json", "points.pvd", "history.csv", "checkpoint.txt"):
            expect(os.path.exists(os.path.join(out, file)), f"no {file}")

        missing = os.path.join(folder, "missing")
        for ranks in ([], ["--ranks", "2"]):
            bad = wisp(program, "run", good, "--out", missing, "--set", "body[0].material.density=-1", *ranks)
            expect(bad.returncode == 2 and len(error_lines(bad)) == 1, f"{bad.returncode}: {bad.stderr}")
            expect(not os.path.exists(missing), "bad input left a folder")

        bad_geometry(program, folder)

        flies = write_case(folder, "flies.toml", stage=STAGE)
        for ranks in ([], ["--ranks", "2"]):
            stopped = wisp(program, "run", flies, "--out", os.path.join(folder, "flies"), "--set",
                           "body[0].velocity=[100.0, 0.0]", *ranks)
            expect(stopped.returncode == 1, f"status {stopped.returncode}: {stopped.stdout}")
            lines = error_lines(stopped)
            expect(len(lines) == 1 and "left the grid" in lines[0] and "step" in lines[0], stopped.stderr)

        unstable = wisp(program, "run", good, "--out", os.path.join(folder, "unstable"), "--set",
                        "stage[0].duration=50.0")
        expect(unstable.returncode == 1 and len(error_lines(unstable)) == 1, f"{unstable.returncode}: {unstable.stderr}")

        static = write_case(folder, "static.toml", basis="gimp", factor="[[0.0, 0.0], [1.0, 1.0]]",
                            stage='type = "quasi-static"\nduration = 1.0\nsteps = 10')
        halted = os.path.join(folder, "halted")
        diverged = wisp(program, "run", static, "--out", halted, "--set", "gravity.factor=[[0.0, 0.0], [0.5, 0.5], [1.0, 1e6]]")
        expect(diverged.returncode == 1, f"status {diverged.returncode}")
        lines = error_lines(diverged)
        expect(len(lines) == 1 and "step 6" in lines[0] and "did not converge" in lines[0], diverged.stderr)
        expect("step 5" in lines[0] and "wisp resume" in lines[0], f"no word of the last good state: {lines[0]}")
        again = wisp(program, "resume", halted)
        expect(again.returncode == 1 and "step 6" in again.stderr, again.stderr)

        nowhere = wisp(program, "resume", os.path.join(folder, "nowhere"))
        expect(nowhere.returncode == 2 and len(error_lines(nowhere)) == 1, nowhere.stderr)


if __name__ == "__main__":
    main(*sys.argv[1:])
