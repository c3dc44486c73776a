"""What stands around the points of a run: grid, walls, title.

``scene.json`` holds, all of them optional::

    {"title": "Elastic beam",
     "grid": {"coordinates": [[0.0, 0.5, 1.0], [0.0, 0.5]]},     lines of a structured grid, direction by direction
     "walls": [[[0.0, 0.0], [1.0, 0.0]]]}                        polylines

A grid of triangles is ``{"points": [[x, y], ...], "cells": [[0, 1, 2], ...]}`` in place of its coordinates.
"""
import json
import os
from dataclasses import dataclass, field

import numpy as np

from .errors import ResultsError


@dataclass
class Scene:
    title: str = ""
    coordinates: list = field(default_factory=list)  # an array of line positions for each direction [m]
    nodes: np.ndarray = None  # (n, 2 or 3) [m]
    cells: list = field(default_factory=list)  # lists of rows of `nodes`
    walls: list = field(default_factory=list)  # arrays (n, 2 or 3) [m]


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
    except (TypeError, ValueError) as error:
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
