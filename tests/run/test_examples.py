"""Runs an example and checks its results: states, history, a picture; the column also against the exact motion.

usage: test_examples.py WISP CASE.toml
"""
import os
import sys
import tempfile

import numpy as np

from program import expect, expect_success, wisp
from wisp.results import Results


def exact_sinking(height, length=50.0, modulus=10e3, density=80.0, gravity=10.0):
    """Displacement of a point of an elastic column under its weight. Hencky's law with nu = 0: the section at Y carries
    the weight above it, -E ln(s) / s = density gravity (length - Y), with the stretch s found by bisection."""
    places = np.linspace(0.0, height, 2001)
    load = density * gravity * (length - places) / modulus
    low, high = np.full_like(load, 1e-3), np.ones_like(load)
    for _ in range(80):
        middle = 0.5 * (low + high)
        too_short = -np.log(middle) / middle > load
        low, high = np.where(too_short, middle, low), np.where(too_short, high, middle)
    stretch = 0.5 * (low + high)
    return np.trapz(stretch - 1.0, places)


def check_column(results):
    history = results.history
    height = history["top position y [m]"][0]
    exact = exact_sinking(height)
    found = history["top displacement y [m]"][-1]
    expect(abs(found - exact) < 0.01 * abs(exact), f"the top sinks by {found} m, exactly by {exact} m")
    weight = 80.0 * 10.0 * 50.0 * 6.25
    expect(abs(history["reaction base y [N/m]"][-1] - weight) < 1e-5 * weight, "the base carries the weight")
    stress = results.points()["stress"][:, 1]
    start = results.points(0)["positions"][:, 1]
    wanted = -80.0 * 10.0 * (50.0 - start)
    order = np.argsort(results.points()["id"])
    expect(np.array_equal(results.points(0)["id"], np.sort(results.points()["id"])), "points keep their ids")
    error = np.mean(np.abs(stress[order] - wanted[np.argsort(results.points(0)["id"])])) / (80.0 * 10.0 * 50.0)
    expect(error < 0.05, f"stress differs by {error:.3f} of the greatest")


def check_arch(results):
    history = results.history
    weight = 1000.0 * 9.81 * np.sum(results.points(0)["initial_volume"])
    expect(abs(history["reaction feet y [N/m]"][-1] - weight) < 1e-6 * weight, "the feet carry the weight")
    expect(abs(history["reaction feet x [N/m]"][-1]) < 1e-3 * weight, "the thrusts of both feet balance")
    expect(-0.1 < history["crown displacement y [m]"][-1] < -0.001, "the crown sinks, by less than its thickness")
    expect(len(results.scene.cells) == 2011, "the picture shows the triangles")


def check_bar(results):
    history = results.history
    time, tip = history["time"], history["tip displacement x [m]"]
    place = history["tip position x [m]"][0]
    # u = rho g (2 L x - x^2) / E at t = 2 L / c, the greatest, with L = 1 m; the tracked point is a little inside.
    greatest = 100.0 * (2.0 * place - place**2) / 1e5
    expect(abs(np.max(tip) - greatest) < 0.01 * greatest, f"the tip goes to {np.max(tip)} m, exactly {greatest} m")
    expect(abs(time[np.argmax(tip)] - 0.2) < 0.01, f"at {time[np.argmax(tip)]} s, exactly 0.2 s")
    expect(abs(tip[-1]) < 0.02 * greatest, f"after a period it is at {tip[-1]} m")


def check_cylinder(results):
    history = results.history
    # Lame: u = A r + B/r with B = A b^2 (lambda + mu)/mu = 2.5 A b^2, a = 0.04 m, b = 0.1 m, u(a) = 1e-4 m
    push, a, b, mu = 1e-4, 0.04, 0.1, 1e9 / 2.6
    slope = push / (a + 2.5 * b * b / a)
    place = np.array([history["outer position x [m]"][0], history["outer position y [m]"][0]])
    radius = np.hypot(*place)
    exact = (slope * radius + 2.5 * slope * b * b / radius) * place / radius
    for k, axis in enumerate("xy"):
        found = history[f"outer displacement {axis} [m]"][-1]
        expect(abs(found - exact[k]) < 0.01 * exact[k], f"the outer face moves by {found} m, exactly by {exact[k]} m")
    force = 2.0 * mu * slope * (2.5 * b * b / a**2 - 2.5) * a
    for axis in "xy":
        found = history[f"reaction inner {axis} [N/m]"][-1]
        expect(abs(found - force) < 0.02 * force, f"the inner wall pushes with {found} N/m, exactly {force} N/m")


def enclosed(file, point, normal):
    """Volume that the triangles of an STL file enclose on the side of a plane that its normal points to: pyramids over
    what the plane leaves of each triangle, with their tips on the plane, so that the cut face has none."""
    with open(file, encoding="ascii") as stream:
        corners = [[float(x) for x in line.split()[1:]] for line in stream if line.split()[:1] == ["vertex"]]
    volume = 0.0
    for triangle in np.array(corners).reshape(-1, 3, 3) - point:
        heights = triangle @ normal
        left = []
        for k in range(3):
            a, b, height, next_height = triangle[k], triangle[(k + 1) % 3], heights[k], heights[(k + 1) % 3]
            if height >= 0:
                left.append(a)
            if height * next_height < 0:
                left.append(a + height / (height - next_height) * (b - a))
        for k in range(1, len(left) - 1):
            volume += np.dot(left[0], np.cross(left[k], left[k + 1])) / 6.0
    return volume


def check_filling(results):
    bowl = os.path.join(os.path.dirname(__file__), "../../examples/15-stl-wall/bowl.stl")
    exact = enclosed(bowl, np.array([0.5, 0.5, 0.5]), np.array([0.1, 0.0, -1.0]))
    volume = np.sum(results.points(0)["initial_volume"])
    expect(0.05 < exact < 0.134 and abs(volume - exact) < 1e-12, f"points fill {volume} m3, exactly {exact} m3")
    weight = 1000.0 * 9.81 * exact
    carried = results.history["reaction mould z [N]"][-1]
    expect(abs(carried - weight) < 1e-6 * weight, f"the mould carries {carried} N, the weight is {weight} N")
    # A column of that depth that nothing holds at its sides sinks by rho g H^2 / (2 M); the mould holds this one.
    column = 1000.0 * 9.81 * 0.28**2 / (2.0 * 20e3 * 0.7 / (1.3 * 0.4))
    sunk = -results.history["middle displacement z [m]"][-1]
    expect(0.0 < sunk < column, f"the middle sinks by {sunk} m, a column without the mould by {column} m")


def check_soil_column(results):
    history = results.history
    time, middle = history["time"], history["middle displacement y [m]"]
    # By small strains the middle sinks by 2 (3/8) rho g H^2 / E = 7.4 %, less a few percent as the column stiffens.
    expect(-0.074 < np.min(middle) < -0.06, f"the middle sinks to {np.min(middle)} m")
    period = time > 0.3
    back = time[period][np.argmax(middle[period][: np.searchsorted(time[period], 0.45)])]
    expect(0.36 < back < 0.4 and abs(np.interp(back, time, middle)) < 0.002, f"it is back after {back} s")
    rest = history["balance error [J/m]"] / np.max(history["external work [J/m]"])
    expect(np.max(np.abs(rest)) < 0.06, "the energy is kept within the first order of the scheme")
    whole = (time > 0) & (time <= 2.0 * back)
    mean = np.mean(history["reaction base y [N/m]"][whole])
    expect(abs(mean - 981.0) < 0.03 * 981.0, f"the base carries {mean} N/m in the mean")
    stress, height = results.points()["stress"][:, 1], results.points()["positions"][:, 1]
    rows = np.array([stress[np.abs(height - h) < 1e-3].mean() for h in np.unique(np.round(height, 3))])
    expect(np.max(np.abs(np.diff(rows, 2))) < 0.05 * np.ptp(rows), "the stress is smooth over the height")


def check_slope(results):
    history = results.history
    crest = history["crest displacement y [m]"]
    expect(-3.0 < crest[-1] < -1.2, f"the crest sinks by {-crest[-1]} m")
    expect(history["crest displacement x [m]"][-1] > 0.8, "and moves outwards")
    kinetic = history["kinetic energy [J/m]"]
    expect(kinetic[-1] < 0.4 * np.max(kinetic), "the slide slows down")
    lost = history["external work [J/m]"][-1]
    expect(abs(history["balance error [J/m]"][-1]) < 0.02 * lost, "the lost height is in the energies")
    expect(history["dissipation [J/m]"][-1] > 0.7 * lost, "most of it is dissipated")
    start, end = results.points(0)["positions"], results.points()["positions"]
    order, first = np.argsort(results.points()["id"]), np.argsort(results.points(0)["id"])
    rise = (end[order] - start[first])[:, 1]
    toe = (start[first][:, 0] > 26.0) & (start[first][:, 0] < 32.0) & (start[first][:, 1] > 2.5)
    expect(np.max(rise[toe]) > 0.5, "the ground before the toe heaves")
    far = start[first][:, 0] > 38.0
    expect(np.max(np.abs((end[order] - start[first])[far])) < 0.2, "and far away it rests")


def check_pile(results):
    force = -results.history["reaction head y [N/m]"]
    capacity = (2.0 + np.pi) * 1e4 * 0.5
    expect(np.all(np.diff(force) > -0.01 * capacity), "the force does not fall")
    expect(capacity < force[-1] < 1.7 * capacity, f"the pile bears {force[-1] / capacity} of the estimate")
    expect(abs(force[-1] - force[-6]) < 0.02 * force[-1], "the force levels off")
    expect(abs(force[2] - 2.0 * force[1]) < 0.02 * force[2], "after an elastic start")


def main(program, case):
    name = os.path.basename(os.path.dirname(case))
    with tempfile.TemporaryDirectory() as folder:
        out = os.path.join(folder, "results")
        expect_success(wisp(program, "check", case))
        expect_success(wisp(program, "run", case, "--out", out))
        results = Results(out)
        expect(len(results.times) >= 5, f"{len(results.times)} states")
        for values in results.history.values():
            expect(np.all(np.isfinite(values)), "the history holds numbers")
        expect(all(np.all(np.isfinite(values)) for values in results.points().values()), "so do the points")
        expect_success(wisp(program, "picture", out))
        expect(os.path.getsize(os.path.join(out, "picture.png")) > 1000, "a picture")
        if name == "01-compressed-column":
            check_column(results)
        if name == "09-soil-column":
            check_soil_column(results)
        if name == "16-slope-collapse":
            check_slope(results)
        if name == "17-pressed-pile":
            check_pile(results)
        if name == "07-gmsh-arch":
            check_arch(results)
        if name == "18-stl-body":
            check_filling(results)
        if name == "08-vibrating-bar":
            check_bar(results)
        if name == "19-walls-on-triangles":
            check_cylinder(results)


if __name__ == "__main__":
    main(*sys.argv[1:])
