"""Tests of the package `wisp`: reading equals what the engine's writers were given, pictures show what they must."""
import contextlib
import io
import json
import os
import sys
import tempfile
import unittest
import warnings

import numpy as np
from matplotlib.image import imread

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import sample_results

from wisp import Results, ResultsError, fields, read_history, read_vtu
from wisp import curves, drawing, picture
from wisp.scene import read_scene

SAMPLES = ""


def expected(name, array):
    with open(os.path.join(SAMPLES, "expected", f"{name}.{array}.bin"), "rb") as stream:
        return stream.read()


def pixels(path):
    """Pixels (rows, columns, 3) as bytes."""
    return (imread(path)[:, :, :3] * 255 + 0.5).astype(int)


class InFolder(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = folder.name

    def draw(self, *options):
        """(exit status, lines on stdout, lines on stderr) of `wisp picture FOLDER options`."""
        out, err = io.StringIO(), io.StringIO()
        with contextlib.redirect_stdout(out), contextlib.redirect_stderr(err), warnings.catch_warnings():
            warnings.simplefilter("error")
            status = picture.main([self.folder, *options])
        return status, out.getvalue().splitlines(), err.getvalue().splitlines()

    def refused(self, *options):
        status, out, err = self.draw(*options)
        self.assertEqual((status, out, len(err)), (2, [], 1), err)
        return err[0]


class ReadsTheEnginesFiles(unittest.TestCase):
    arrays = ["displacement", "stress", "volume", "id", 'a < b & "c"']

    def compare(self, name, count):
        points = read_vtu(os.path.join(SAMPLES, name))
        self.assertEqual(points.field_names(), self.arrays)
        self.assertEqual(points["positions"].shape, (count, 3))
        self.assertEqual(points["positions"].tobytes(), expected(name, "Points"))
        for array in self.arrays:
            self.assertEqual(points[array].tobytes(), expected(name, array), array)
        return points

    def test_every_bit(self):
        for name, count in (("empty.vtu", 0), ("one.vtu", 1), ("block.vtu", 131072), ("many.vtu", 150001),
                            ("points-000010.vtu", 400), ("points-000030.pvtu", 400)):
            with self.subTest(name):
                self.compare(name, count)

    def test_units_names_and_time(self):
        points = self.compare("points-000010.vtu", 400)
        self.assertEqual((points.units["stress"], points.units["id"]), ("Pa", ""))
        self.assertEqual(points.component_names["stress"], ["xx", "yy", "zz", "xy"])
        self.assertEqual(points.globals["TimeValue"].tolist(), [0.1])
        self.assertEqual(points.dimension, 2)

    def test_results(self):
        results = Results(SAMPLES)
        self.assertEqual(results.times.tolist(), [0.0, 0.1, 0.2, 0.3])
        self.assertEqual(results.nearest(0.16), 2)
        self.assertEqual(results.points(1)["positions"].tobytes(), expected("points-000010.vtu", "Points"))
        self.assertEqual(len(results.points(-1)["id"]), 400)
        with self.assertRaises(ResultsError):
            results.points(4)
        self.assertEqual(Results(os.path.join(SAMPLES, "points.pvd")).times.tolist(), results.times.tolist())

    def test_history(self):
        history = Results(SAMPLES).history
        self.assertEqual(list(history), ["step", "time", "kinetic energy [J]", "strain energy [J]", "iterations"])
        time = np.array([0.01 * i for i in range(31)])
        self.assertEqual(history["time"].tobytes(), time.tobytes())
        self.assertEqual(history["strain energy [J]"].tobytes(), (1.0 / 3.0 - 0.1 * time).tobytes())
        self.assertEqual(history["step"].dtype, np.int64)


class Refuses(InFolder):
    def test_truncated_and_damaged_files(self):
        source = os.path.join(SAMPLES, "points-000010.vtu")
        with open(source, "rb") as stream:
            whole = stream.read()
        path = os.path.join(self.folder, "a.vtu")
        random = np.random.default_rng(3)
        for length in random.integers(0, len(whole) - 20, 60):
            with open(path, "wb") as stream:
                stream.write(whole[:length])
            with self.assertRaises(ResultsError):
                read_vtu(path)
        start = whole.index(b"_", whole.index(b"<AppendedData")) + 1
        for at in random.integers(start, start + 400, 40):
            changed = bytearray(whole)
            changed[at] ^= 0xFF
            with open(path, "wb") as stream:
                stream.write(changed)
            with contextlib.suppress(ResultsError):  # a flipped block size is not read; anything else is an error
                self.assertEqual(read_vtu(path)["displacement"].tobytes(),
                                 expected("points-000010.vtu", "displacement"))

    def test_history(self):
        path = os.path.join(self.folder, "history.csv")
        with open(path, "w", encoding="utf-8") as stream:
            stream.write("step,time,a\n0,0.0,1\n1,0.5,2\n2,1.0")
        self.assertEqual(read_history(path)["a"].tolist(), [1.0, 2.0])
        with open(path, "w", encoding="utf-8") as stream:
            stream.write("step,time,a\n0,0.0,1\n1,0.5\n")
        with self.assertRaisesRegex(ResultsError, "history.csv:3: expected 3 numbers"):
            read_history(path)

    def test_missing(self):
        with self.assertRaisesRegex(ResultsError, "no folder"):
            Results(os.path.join(self.folder, "none"))
        with self.assertRaisesRegex(ResultsError, "no states"):
            Results(self.folder).points()
        sample_results.write_series(self.folder, [(0.0, "gone.vtu")])
        with self.assertRaisesRegex(ResultsError, "cannot read .*gone.vtu"):
            Results(self.folder).points()


class Fields(unittest.TestCase):
    def test_von_mises(self):
        uniaxial = np.array([[-3.0, 0, 0, 0]])
        shear = np.array([[1.0, 1, 1, 0, 2, 0]])
        self.assertAlmostEqual(fields.von_mises(uniaxial)[0], 3.0)
        self.assertAlmostEqual(fields.von_mises(shear)[0], 2.0 * np.sqrt(3.0))

    def test_components(self):
        points = read_vtu(os.path.join(SAMPLES, "points-000010.vtu"))
        points["stress"] = np.arange(1600.0).reshape(400, 4)
        for component, column in (("xy", 3), ("3", 3), ("zz", 2)):
            self.assertEqual(fields.scalar(points, "stress", component)[0].tolist(), points["stress"][:, column].tolist())
        self.assertEqual(fields.scalar(points, "stress", "mean")[0][0], 1.0)
        values, label, unit = fields.scalar(points)
        self.assertEqual((label, unit), ("|displacement|", "m"))
        np.testing.assert_allclose(values, 0.1)
        self.assertEqual(fields.scalar(points, "stress")[1], "von Mises stress")
        for name, component in ("stress", "yx"), ("stress", "4"), ("volume", "1"), ("displacement", "mean"):
            with self.assertRaises(ResultsError):
                fields.scalar(points, name, component)

    def test_prefix(self):
        values, unit = fields.prefixed(np.array([25e3, -1.0]), "Pa")
        self.assertEqual((values[0], unit), (25.0, "kPa"))
        self.assertEqual(fields.prefixed(np.array([25e3]), "m^3")[1], "m^3")
        self.assertEqual(fields.prefixed(np.zeros(2), "Pa")[1], "Pa")

    def test_colours(self):
        self.assertEqual(drawing.colours_for(np.array([-1.0, 3.0]))[1].vmin, -3.0)
        self.assertEqual(drawing.colours_for(np.array([1.0, np.nan, 3.0]))[1].vmin, 1.0)
        uniform = drawing.colours_for(7.0 + np.array([0.0, 1e-15]))[1]
        self.assertAlmostEqual(uniform.vmin, 3.5)
        self.assertAlmostEqual(uniform.vmax, 10.5)

    def test_panels(self):
        history = {"step": [], "time": [], "a [J]": [], "b [J]": [], "u [m]": [], "n": [], "k": [], "f [N]": []}
        chosen = curves.choose_columns(history, None)
        self.assertEqual(curves.panels_of(chosen, False), [["a [J]", "b [J]"], ["u [m]"], ["n"], ["k"]])
        self.assertEqual(curves.choose_columns(history, ["u", "a [J]"]), ["u [m]", "a [J]"])
        run = {"step": [0, 1], "time": [0.0, 1.0], "stage": [1, 2], "dt [s]": [0.0, 0.1], "kinetic energy [J]": [0.0, 0.0],
               "tip position x [m]": [1.0, 2.0], "tip displacement x [m]": [0.0, 1.0], "residual": [0.0, 1e-9]}
        self.assertEqual(curves.choose_columns(run, None), ["tip displacement x [m]"])
        self.assertEqual(curves.choose_columns(run, ["stage", "kinetic energy"]), ["stage", "kinetic energy [J]"])
        with self.assertRaisesRegex(ResultsError, r"no column uu; did you mean u\?"):
            curves.choose_columns(history, ["uu"])


class MovingWalls(InFolder):
    def wall(self, motion, line=((1.0, 0.0), (2.0, 0.0))):
        with open(os.path.join(self.folder, "scene.json"), "w", encoding="utf-8") as stream:
            json.dump({"walls": [[[5.0, 5.0], [6.0, 5.0]]], "moving walls": [{"lines": [line], "motion": motion}]}, stream)
        return read_scene(os.path.join(self.folder, "scene.json"))

    def test_displacement_and_velocity(self):
        scene = self.wall({"displacement": [[[0.0], [0.5]], [[0.0, 2.0], [0.0, 4.0]]]})
        for time, y in ((0.0, 0.0), (1.0, 2.0), (9.0, 4.0)):
            still, moved = scene.at(time).walls
            np.testing.assert_array_equal(still, [[5.0, 5.0], [6.0, 5.0]])
            np.testing.assert_allclose(moved, [[1.5, y], [2.5, y]])
        # A velocity that rises over 2 s: t^2, then on at 4 m/s.
        scene = self.wall({"velocity": [[[0.0], [0.0]], [[0.0, 2.0], [0.0, 4.0]]]})
        for time, y in ((1.0, 1.0), (2.0, 4.0), (3.0, 8.0)):
            np.testing.assert_allclose(scene.at(time).walls[1][:, 1], [y, y])

    def test_rotation_about_a_centre_that_moves(self):
        scene = self.wall({"angular_velocity": [[0.0], [np.pi]], "centre": [1.0, 0.0], "velocity": [[[0.0], [2.0]], [[0.0], [0.0]]]})
        np.testing.assert_allclose(scene.at(0.5).walls[1], [[2.0, 0.0], [2.0, 1.0]], atol=1e-15)
        scene = self.wall({"rotation": [[0.0, 1.0], [0.0, np.pi / 2]], "axis": [0.0, 0.0, 2.0]}, ((1.0, 0.0, 3.0), (0.0, 1.0, 3.0)))
        np.testing.assert_allclose(scene.at(1.0).walls[1], [[0.0, 1.0, 3.0], [-1.0, 0.0, 3.0]], atol=1e-15)

    def test_a_picture_shows_the_wall_at_its_time(self):
        sample_results.beam(self.folder)
        self.wall({"velocity": [[[0.0], [0.0]], [[0.0], [-1.5]]]}, ((0.0, 0.6), (4.0, 0.6)))
        places = []
        for time in ("0", "1"):
            status, out, _ = self.draw("--time", time, "--output", os.path.join(self.folder, f"at{time}"))
            self.assertEqual(status, 0)
            image = pixels(out[0])
            dark = np.count_nonzero(image[:, :int(0.75 * image.shape[1])].max(axis=2) < 90, axis=1)
            places.append(np.argmax(dark) / len(dark))  # the row of the longest dark line
        self.assertGreater(abs(places[1] - places[0]), 0.02)

    def test_refused(self):
        sample_results.beam(self.folder)
        for motion in ({"velocity": [[[0.0], [1.0]]]}, {"displacement": [[[0.0, 0.0], [1.0, 2.0]]] * 2}, {"centre": [0.0]}, 3):
            with self.assertRaises(ResultsError):
                self.wall(motion)


class Pictures(InFolder):
    def test_beam(self):
        sample_results.beam(self.folder)
        status, out, _ = self.draw("--field", "stress", "--component", "xx")
        self.assertEqual(status, 0)
        self.assertEqual(out, [os.path.join(self.folder, name) for name in ("picture.png", "history.png")])
        image = pixels(out[0])
        # Tension below is red, compression above blue (the arc bends down, colours diverge about zero).
        red = np.argwhere((image[:, :, 0] > image[:, :, 2] + 80))
        blue = np.argwhere((image[:, :, 2] > image[:, :, 0] + 80))
        left = image.shape[1] * 0.75  # without the colour bar
        self.assertGreater(red[red[:, 1] < left][:, 0].mean(), blue[blue[:, 1] < left][:, 0].mean())
        self.assertFalse([name for name in os.listdir(self.folder) if name.endswith(".part")])

    def test_undeformed_is_straight(self):
        sample_results.beam(self.folder)
        os.remove(os.path.join(self.folder, "scene.json"))
        heights = {}
        for option in ("--last", "--undeformed"):
            status, out, _ = self.draw(option, "--field", "id", "--output", os.path.join(self.folder, option[2:]))
            self.assertEqual(status, 0)
            image = pixels(out[0])
            coloured = np.ptp(image, axis=2)[:, :int(0.8 * image.shape[1])] > 60
            rows, columns = np.nonzero(coloured)
            heights[option] = np.ptp(rows) / np.ptp(columns)
        self.assertGreater(heights["--last"], 0.6)
        self.assertAlmostEqual(heights["--undeformed"], 0.5 / 4, delta=0.02)

    def test_points_are_as_large_as_their_domains(self):
        half = np.array([[0.1, 0.3], [0.2, 0.1]])
        sample_results.write_vtu(os.path.join(self.folder, "p.vtu"), np.array([[0.0, 0, 0], [1, 0, 0]]),
                                 {"id": (np.array([0, 1]), ""), "half_lengths": (half, "m")})
        sample_results.write_series(self.folder, [(0.0, "p.vtu")])
        self.assertEqual(self.draw("--field", "id")[0], 0)
        image = pixels(os.path.join(self.folder, "picture.png"))
        yellow = np.all(np.abs(image - np.array([253, 231, 37])) < 12, axis=2)[:, :int(0.85 * image.shape[1])]
        purple = np.all(np.abs(image - np.array([68, 1, 84])) < 12, axis=2)[:, :int(0.85 * image.shape[1])]
        for mask, (width, height) in (purple, half[0]), (yellow, half[1]):
            rows, columns = np.nonzero(mask)
            self.assertAlmostEqual(np.ptp(columns) / np.ptp(rows), width / height, delta=0.04 * width / height)

    def test_three_dimensions(self):
        sample_results.bar(self.folder)
        status, out, _ = self.draw("--field", "stress", "--component", "zz", "--output", os.path.join(self.folder, "b.png"))
        self.assertEqual((status, out), (0, [os.path.join(self.folder, "b.png")]))
        image = pixels(out[0])[:, :int(0.72 * pixels(out[0]).shape[1])]
        yellow = np.argwhere((image[:, :, 0] > 200) & (image[:, :, 2] < 80))
        purple = np.argwhere((image[:, :, 2] > image[:, :, 1] + 25) & (image[:, :, 0] < 90))
        self.assertLess(yellow[:, 0].mean(), purple[:, 0].mean(), "the greatest stress is at the top of the bar")

    def test_many_points_and_no_numbers(self):
        count = drawing._BOX_LIMIT[2] + 1
        positions = np.column_stack([np.random.default_rng(1).random((count, 2)), np.zeros(count)])
        sample_results.write_vtu(os.path.join(self.folder, "p.vtu"), positions, {"x": (np.full(count, np.nan), "Pa")},
                                 block=1 << 20)
        sample_results.write_series(self.folder, [(0.0, "p.vtu")])
        self.assertEqual(self.draw()[0], 0)

    def test_only_history(self):
        sample_results.write_history(self.folder, ["energy [J]"], [[0, 0.0, 1.0], [1, 0.1, 2.0]])
        self.assertEqual(self.draw(), (0, [os.path.join(self.folder, "history.png")], []))

    def test_chosen_time_and_columns(self):
        sample_results.beam(self.folder)
        self.assertEqual(self.draw("--time", "0.26", "--history", "tip deflection", "iterations")[0], 0)

    def test_messages(self):
        self.assertIn("no states", self.refused())
        sample_results.beam(self.folder)
        self.assertIn("did you mean stress", self.refused("--field", "sress"))
        self.assertIn("expected 0 to 3 or xx", self.refused("--field", "stress", "--component", "9"))
        self.assertIn("no column total; did you mean", self.refused("--history", "total"))
        self.assertIn("ends in .png", self.refused("--output", "a.jpg"))
        self.assertIn("invalid float", self.refused("--time", "soon"))
        self.assertIn("unrecognized", self.refused("--colour", "red"))
        self.assertIn("not allowed with", self.refused("--time", "1", "--last"))
        for scene in ("{", "[]", json.dumps({"walls": [[1, 2]]}), json.dumps({"grid": {"coordinates": [[0]]}}),
                      json.dumps({"grid": {"cells": [[0]]}})):
            with open(os.path.join(self.folder, "scene.json"), "w", encoding="utf-8") as stream:
                stream.write(scene)
            self.assertIn("scene.json", self.refused())
        out, err = io.StringIO(), io.StringIO()
        with contextlib.redirect_stdout(out), contextlib.redirect_stderr(err):
            self.assertEqual(picture.main([]), 2)
        self.assertEqual(len(err.getvalue().splitlines()), 1)


if __name__ == "__main__":
    SAMPLES = sys.argv.pop(1)
    unittest.main()
