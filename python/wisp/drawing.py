"""Draws points, grid and walls of one state on Matplotlib axes, in 2D and in 3D."""
import numpy as np
from matplotlib.collections import LineCollection, PolyCollection
from matplotlib.colors import Normalize

from .errors import ResultsError

_BOX_LIMIT = {2: 60000, 3: 40000}  # more points than this become plain markers: boxes would take minutes
_GRID_LINES = 400  # more lines than this would cover the picture
_GRID_STYLE = {"colors": "#9aa5b1", "linewidths": 0.5, "alpha": 0.6}
_WALL_STYLE = {"colors": "#2b3440", "linewidths": 2.0}


def reference_positions(points):
    """Where the points were before they moved (n, 3)."""
    if "initial_position" in points:
        return _three_columns(points["initial_position"])
    if "displacement" in points:
        return points["positions"] - _three_columns(points["displacement"])
    raise ResultsError("the undeformed state needs the field displacement or initial_position")


def _three_columns(values):
    values = np.asarray(values, dtype=float).reshape(len(values), -1)
    return np.pad(values, ((0, 0), (0, 3 - values.shape[1])))


def half_lengths(points, dimension, undeformed=False):
    """Half the extents of each point (n, 3) [m]: its domain, else the square or cube of its volume."""
    names = ["half_lengths", "volume"]
    if undeformed:
        names = ["initial_half_lengths", "initial_volume"] + names
    count = len(points["positions"])
    for name in names:
        if name not in points:
            continue
        if "half" in name:
            return np.abs(_three_columns(points[name]))
        return np.repeat(0.5 * np.abs(points[name])[:, None]**(1.0 / dimension), 3, axis=1)
    extent = np.ptp(points["positions"][:, :dimension], axis=0) if count else np.ones(dimension)
    side = np.prod(np.maximum(extent, 1e-30))**(1.0 / dimension) / max(count, 1)**(1.0 / dimension)
    return np.full((count, 3), 0.5 * side)


def _corners_2d(points, half, undeformed):
    """Corners (n, 4, 2) of each point about its position: its domain as F has sheared and turned it, where the points
    carry `deformation_gradient` (row by row, 2 x 2 or 3 x 3), else a rectangle of its half-lengths."""
    signs = np.array([[-1, -1], [1, -1], [1, 1], [-1, 1]]) * 0.94  # a gap, so that points can be told apart
    gradient = points.get("deformation_gradient")
    if undeformed or gradient is None or np.ndim(gradient) != 2 or gradient.shape[1] not in (4, 9):
        return signs[None] * half[:, None, :]
    size = 2 if gradient.shape[1] == 4 else 3
    gradient = gradient.reshape(-1, size, size)[:, :2, :2]
    if "initial_half_lengths" in points or "initial_volume" in points:
        half = half_lengths(points, 2, True)[:, :2]
    else:
        half = half / np.sqrt(np.abs(np.linalg.det(gradient)))[:, None]
    return np.einsum("nij,ncj->nci", gradient, signs[None] * half[:, None, :])


def colours_for(values):
    """(colour map's name, Normalize): diverging about zero if the sign changes."""
    finite = values[np.isfinite(values)]
    if finite.size == 0:
        return "viridis", Normalize(0.0, 1.0)
    least, most = float(finite.min()), float(finite.max())
    if least < 0.0 < most:
        bound = max(-least, most)
        return "RdBu_r", Normalize(-bound, bound)
    if most - least <= 1e-12 * max(abs(least), abs(most)):  # a uniform field: rounding is no pattern
        margin = 0.5 * abs(most) or 1.0
        return "viridis", Normalize(least - margin, most + margin)
    return "viridis", Normalize(least, most)


def _limits(corners, margin=0.06):
    low, high = corners.min(axis=0), corners.max(axis=0)
    pad = margin * max(float(np.max(high - low)), 1e-12)
    return low - pad, high + pad


def _marker_size(axes, side, low, high):
    """Area in square points of markers with `side` in the units of the axes."""
    box = axes.get_position()
    width, height = axes.figure.get_size_inches()
    scale = min(72.0 * width * box.width / (high[0] - low[0]), 72.0 * height * box.height / (high[1] - low[1]))
    return np.clip(side * scale, 0.4, None)**2


def _walls(scene, dimension):
    return [wall[:, :dimension] for wall in scene.walls if wall.shape[1] >= dimension]


def _grid_segments(scene, low, high):
    """The grid's lines within the view, as segments; none where they would be too dense."""
    if scene.cells:
        return [scene.nodes[cell + cell[:1], :2] for cell in scene.cells]
    if len(scene.coordinates) < 2:
        return []
    x, y = scene.coordinates[:2]
    inside = [c[(c >= l) & (c <= h)] for c, l, h in zip((x, y), low, high)]
    if sum(len(c) for c in inside) > _GRID_LINES:
        return []
    (left, right), (bottom, top) = (np.clip((c.min(), c.max()), l, h) for c, l, h in zip((x, y), low, high))
    return [[(c, bottom), (c, top)] for c in inside[0]] + [[(left, c), (right, c)] for c in inside[1]]


def draw_2d(axes, points, positions, values, half, scene, undeformed=False):
    """Each point is drawn as large as its domain. Returns what the colour bar needs."""
    positions, half = positions[:, :2], half[:, :2]
    walls = _walls(scene, 2)
    low, high = _limits(np.concatenate([positions - half, positions + half] + walls))
    axes.set_xlim(low[0], high[0])
    axes.set_ylim(low[1], high[1])
    axes.set_aspect("equal")
    axes.add_collection(LineCollection(_grid_segments(scene, low, high), zorder=1, **_GRID_STYLE))
    axes.add_collection(LineCollection(walls, zorder=4, capstyle="round", **_WALL_STYLE))
    cmap, norm = colours_for(values)
    if len(positions) <= _BOX_LIMIT[2]:
        drawn = PolyCollection(positions[:, None, :] + _corners_2d(points, half, undeformed), array=values, cmap=cmap,
                               norm=norm, edgecolors="none", zorder=2)
        axes.add_collection(drawn)
    else:
        drawn = axes.scatter(positions[:, 0], positions[:, 1], _marker_size(axes, 2.0 * half.min(axis=1), low, high),
                             marker="s", linewidths=0, zorder=2)
        drawn.set(array=values, cmap=cmap, norm=norm)
    axes.set_xlabel("x [m]")
    axes.set_ylabel("y [m]")
    return drawn


def _view(azimuth, elevation):
    """Rows: right, up and towards the eye, in the coordinates of the space; z points up."""
    a, e = np.radians(azimuth), np.radians(elevation)
    towards = np.array([np.cos(e) * np.cos(a), np.cos(e) * np.sin(a), np.sin(e)])
    right = np.array([-np.sin(a), np.cos(a), 0.0])
    return np.array([right, np.cross(towards, right), towards])


def _visible_faces(towards):
    """Corners (3, 4, 3) of the three faces of the cube [-1, 1]^3 that the eye sees, and how light each is."""
    faces, light = [], []
    for direction, brightness in zip(range(3), (0.86, 0.72, 1.0)):
        a, b = (direction + 1) % 3, (direction + 2) % 3
        face = np.zeros((4, 3))
        face[:, direction] = np.sign(towards[direction])
        face[:, a], face[:, b] = [-1, 1, 1, -1], [-1, -1, 1, 1]
        faces.append(face)
        light.append(brightness)
    return np.array(faces), np.array(light)


def _box_edges(low, high, view):
    """The edges of a box on paper, those behind the body and those before it."""
    corners = np.array([[x, y, z] for x in (0, 1) for y in (0, 1) for z in (0, 1)])
    eye = (view[2] > 0).astype(int)
    behind, before = [], []
    for i, a in enumerate(corners):
        for b in corners[i + 1:]:
            if np.sum(a != b) != 1:
                continue
            segment = (low + np.array([a, b]) * (high - low)) @ view[:2].T
            hides = any(a[d] == b[d] == eye[d] for d in range(3))
            (before if hides else behind).append(segment)
    return behind, before


def draw_3d(axes, positions, values, half, scene, azimuth=-55.0, elevation=24.0):
    """An orthographic view from the side and above; each point is a small shaded box, far ones first."""
    view = _view(azimuth, elevation)
    order = np.argsort(positions @ view[2], kind="stable")
    positions, values, half = positions[order], values[order], half[order]
    grid = scene.coordinates
    low, high = _limits(np.concatenate([positions - half, positions + half]), 0.0)
    if len(grid) == 3:
        low, high = np.array([min(c) for c in grid]), np.array([max(c) for c in grid])
    behind, before = _box_edges(low, high, view)
    walls = [wall @ view[:2].T for wall in _walls(scene, 3)]
    paper_low, paper_high = _limits(np.concatenate(behind + before + walls), 0.08)
    axes.set_xlim(paper_low[0], paper_high[0])
    axes.set_ylim(paper_low[1], paper_high[1])
    axes.set_aspect("equal")
    axes.axis("off")
    axes.add_collection(LineCollection(behind, zorder=1, **_GRID_STYLE))
    axes.add_collection(LineCollection(walls, zorder=4, **_WALL_STYLE))
    cmap, norm = colours_for(values)
    if len(positions) <= _BOX_LIMIT[3]:
        faces, light = _visible_faces(view[2])
        outlines = (positions[:, None, None, :] + 0.97 * faces[None] * half[:, None, None, :]) @ view[:2].T
        drawn = PolyCollection([], array=values, cmap=cmap, norm=norm)
        colours = np.repeat(drawn.to_rgba(values)[:, None, :], 3, axis=1)
        colours[:, :, :3] *= light[None, :, None]
        colours = colours.reshape(-1, 4)
        axes.add_collection(PolyCollection(outlines.reshape(-1, 4, 2), facecolors=colours, edgecolors=colours,
                                           linewidths=0.2, zorder=2))
    else:
        paper = positions @ view[:2].T
        drawn = axes.scatter(paper[:, 0], paper[:, 1], _marker_size(axes, 2.2 * half.min(axis=1), paper_low, paper_high),
                             marker="o", linewidths=0, zorder=2)
        drawn.set(array=values, cmap=cmap, norm=norm)
    _triad(axes, view)
    return drawn


def _triad(axes, view):
    """The directions of x, y and z in the lower left corner."""
    width, height = axes.figure.get_size_inches()
    box = axes.get_position()
    length = 0.4  # inches
    origin = np.array([0.09, 0.09])
    for direction, name in enumerate("xyz"):
        tip = origin + length * view[:2, direction] / np.array([width * box.width, height * box.height])
        axes.annotate("", tip, origin, xycoords="axes fraction", textcoords="axes fraction",
                      arrowprops={"arrowstyle": "-|>", "color": "#2b3440", "lw": 1.0, "shrinkA": 0, "shrinkB": 0})
        beyond = origin + 1.3 * (tip - origin)
        axes.text(*beyond, name, transform=axes.transAxes, ha="center", va="center", fontsize=9, color="#2b3440")
