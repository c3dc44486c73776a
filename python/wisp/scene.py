"""What stands around the points of a run: grid, walls, title.

``scene.json`` holds, all of them optional::

    {"title": "Elastic beam",
     "grid": {"coordinates": [[0.0, 0.5, 1.0], [0.0, 0.5]]},     lines of a structured grid, direction by direction
     "walls": [[[0.0, 0.0], [1.0, 0.0]]],                        polylines
     "moving walls": [{"lines": [[[0.0, 1.0], [1.0, 1.0]]],      polylines where the wall is at rest
                       "motion": {"velocity": [[[0.0], [0.0]], [[0.0, 1.0], [0.0, 2.0]]]}}]}

A motion has the keys of a case's ``motion``; a curve is a list of times and one of values. A wall at rest at X is at
centre + translation + rotation (X - centre).

A grid of triangles is ``{"points": [[x, y], ...], "cells": [[0, 1, 2], ...]}`` in place of its coordinates.
"""
import json
import os
from dataclasses import dataclass, field, replace

import numpy as np

from .errors import ResultsError


class Curve:
    """Linear between its times, constant before and after."""

    def __init__(self, content):
        self.times, self.values = (_numbers(part, 1) for part in content)
        if len(self.times) != len(self.values) or np.any(np.diff(self.times) <= 0):
            raise ValueError("a curve with as many values as increasing times")

    def __call__(self, t):
        return float(np.interp(t, self.times, self.values))

    def integral(self, t):
        """From 0 to t, exact."""
        low, high = min(0.0, t), max(0.0, t)
        at = np.concatenate([[low], self.times[(self.times > low) & (self.times < high)], [high]])
        value = np.interp(at, self.times, self.values)
        return float(np.sign(t) * np.sum(0.5 * (value[1:] + value[:-1]) * np.diff(at)))


class MovingWall:
    """Lines at rest and a rigid motion."""

    def __init__(self, content):
        motion = content.get("motion", {})
        self.lines = [_numbers(line, 2) for line in content["lines"]]
        self.dimension = self.lines[0].shape[1]
        self.displacement = [Curve(c) for c in motion.get("displacement", [])]
        self.velocity = [Curve(c) for c in motion.get("velocity", [])]
        self.rotation = Curve(motion["rotation"]) if "rotation" in motion else None
        self.angular_velocity = Curve(motion["angular_velocity"]) if "angular_velocity" in motion else None
        self.centre = _numbers(motion.get("centre", [0.0] * self.dimension), 1)
        self.axis = _numbers(motion.get("axis", [0.0, 0.0, 1.0]), 1)
        for curves in (self.displacement, self.velocity):
            if len(curves) not in (0, self.dimension):
                raise ValueError("a motion with a curve for each direction")
        if len(self.centre) != self.dimension or len(self.axis) != 3 or not np.linalg.norm(self.axis) > 0:
            raise ValueError("a motion with a centre and an axis")

    def _turn(self, t):
        """Rotation matrix about the axis (Rodrigues)."""
        angle = self.rotation(t) if self.rotation else self.angular_velocity.integral(t) if self.angular_velocity else 0.0
        x, y, z = self.axis / np.linalg.norm(self.axis)
        across = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
        turn = np.eye(3) + np.sin(angle) * across + (1.0 - np.cos(angle)) * across @ across
        return turn[:self.dimension, :self.dimension]

    def at(self, t):
        """The lines at a time."""
        shift = [c(t) for c in self.displacement] or [c.integral(t) for c in self.velocity] or [0.0] * self.dimension
        turn = self._turn(t)
        return [self.centre + shift + (line - self.centre) @ turn.T for line in self.lines]


@dataclass
class Scene:
    title: str = ""
    coordinates: list = field(default_factory=list)  # an array of line positions for each direction [m]
    nodes: np.ndarray = None  # (n, 2 or 3) [m]
    cells: list = field(default_factory=list)  # lists of rows of `nodes`
    walls: list = field(default_factory=list)  # arrays (n, 2 or 3) [m]
    moving: list = field(default_factory=list)  # MovingWall

    def at(self, t):
        """The same with all walls where they are at a time [s]."""
        return replace(self, walls=self.walls + [line for wall in self.moving for line in wall.at(t)])


def read_scene(path):
    """The scene in a file; an empty one if there is no file. ResultsError if it cannot be understood."""
    if not os.path.exists(path):
        return Scene()
    try:
        with open(path, encoding="utf-8") as stream:
            content = json.load(stream)
    except (OSError, ValueError) as error:
        raise ResultsError(f"cannot read {path}: {error}") from None
    if not isinstance(content, dict) or not isinstance(content.get("grid", {}), dict):
        raise ResultsError(f"{path}: expected an object with the keys title, grid, walls")
    grid = content.get("grid", {})
    scene = Scene(title=str(content.get("title", "")))
    try:
        scene.coordinates = [_numbers(line, 1) for line in grid.get("coordinates", [])]
        if scene.coordinates and len(scene.coordinates) not in (2, 3):
            raise ValueError("coordinates for 2 or 3 directions")
        if "cells" in grid:
            scene.nodes = _numbers(grid.get("points"), 2)
            scene.cells = [[int(i) for i in cell] for cell in grid["cells"]]
            if any(not 0 <= i < len(scene.nodes) for cell in scene.cells for i in cell):
                raise ValueError("cells that name points of the grid")
        scene.walls = [_numbers(wall, 2) for wall in content.get("walls", [])]
        scene.moving = [MovingWall(wall) for wall in content.get("moving walls", [])]
    except (AttributeError, IndexError, KeyError, TypeError, ValueError) as error:
        raise ResultsError(f"{path}: cannot understand the grid or a wall: expected {error}") from None
    return scene


def _numbers(values, depth):
    """An array of line positions (depth 1) or of places with 2 or 3 coordinates (depth 2)."""
    try:
        array = np.asarray(values, dtype=float)
    except (TypeError, ValueError):
        array = np.zeros(0)
    if array.ndim != depth or array.size == 0 or (depth == 2 and array.shape[1] not in (2, 3)):
        raise ValueError("a list of numbers" if depth == 1 else "a list of points with 2 or 3 coordinates")
    return array
