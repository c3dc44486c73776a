"""Pictures of a run: ``python3 -m wisp.picture DIR``. Needs no display."""
import argparse
import os
import sys

import numpy as np
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

from . import curves, drawing, fields
from .errors import ResultsError
from .results import Results

_DPI = 160


class _Parser(argparse.ArgumentParser):
    def error(self, message):
        raise ResultsError(message)


def parse(argv):
    parser = _Parser(prog="wisp picture", description="Draws the points and the history of a run as PNG pictures.")
    parser.add_argument("folder", metavar="DIR", help="folder of results, or a .pvd file")
    parser.add_argument("--field", metavar="NAME", help="field that colours the points")
    parser.add_argument("--component", metavar="K",
                        help="number or name of a component, magnitude, von-mises or mean (default: magnitude of "
                        "vectors, von-mises of stresses)")
    when = parser.add_mutually_exclusive_group()
    when.add_argument("--time", type=float, metavar="T", help="the state nearest to this time [s]")
    when.add_argument("--last", action="store_true", help="the last state (the default)")
    parser.add_argument("--undeformed", action="store_true", help="points where they were at the start")
    parser.add_argument("--history", nargs="+", metavar="COLUMN", help="columns of the history to draw")
    parser.add_argument("--output", metavar="FILE", help="picture of the points (default: DIR/picture.png)")
    return parser.parse_args(argv)


def _new_figure(width, height):
    figure = Figure(figsize=(width, height), dpi=_DPI, facecolor="white")
    FigureCanvasAgg(figure)
    return figure


def _save(figure, path):
    """Under a temporary name first, like every result."""
    folder = os.path.dirname(path) or "."
    temporary = os.path.join(folder, f".{os.path.basename(path)}.part")
    try:
        os.makedirs(folder, exist_ok=True)
        figure.savefig(temporary, format="png", dpi=_DPI, bbox_inches="tight", pad_inches=0.15)
        os.replace(temporary, path)
    except OSError as error:
        raise ResultsError(f"cannot write {path}: {error.strerror}") from None


def _figure_size(extent, three):
    """Inches that leave little white around a body of this extent (width, height), colour bar included."""
    if three:
        return 8.0, 6.5
    ratio = np.clip(extent[1] / max(extent[0], 1e-30), 0.2, 2.5)
    return (9.0, max(9.0 * ratio * 0.82, 2.6)) if ratio < 0.8 else (6.4 / ratio + 2.2, 6.4)


def draw_points(results, options, path):
    state = -1 if options.time is None else results.nearest(options.time)
    points = results.points(state)
    if len(points["positions"]) == 0:
        raise ResultsError("the state holds no points")
    values, label, unit = fields.scalar(points, options.field, options.component)
    values, unit = fields.prefixed(values, unit)
    positions = drawing.reference_positions(points) if options.undeformed else points["positions"]
    dimension = points.dimension
    half = drawing.half_lengths(points, dimension, options.undeformed)
    figure = _new_figure(*_figure_size(np.ptp(positions, axis=0) + 2 * half.max(axis=0), dimension == 3))
    axes = figure.add_subplot()
    scene = results.scene.at(0.0 if options.undeformed else results.times[state])
    if dimension == 3:
        drawn = drawing.draw_3d(axes, positions, values, half, scene)
    else:
        drawn = drawing.draw_2d(axes, points, positions, values, half, scene, options.undeformed)
    bar = figure.colorbar(drawn, ax=axes, fraction=0.04, pad=0.02, shrink=0.9)
    bar.set_label(fields.label_with_unit(label, unit))
    bar.outline.set_visible(False)
    bar.formatter.set_powerlimits((-3, 4))
    bar.update_ticks()
    title = f"{label[:1].upper()}{label[1:]} at t = {results.times[state]:.6g} s"
    title += " (undeformed)" if options.undeformed else ""
    axes.set_title(f"{scene.title}\n{title}" if scene.title else title, fontsize=11)
    _save(figure, path)


def draw_history(results, wanted, path):
    history = results.history
    groups = curves.panels_of(curves.choose_columns(history, wanted), bool(wanted))
    if not groups or len(history["step"]) == 0:
        return False
    figure = _new_figure(7.5, 2.6 * len(groups) + 0.6)
    panels = figure.subplots(len(groups), 1, sharex=True, squeeze=False)[:, 0]
    for axes, group in zip(panels, groups):
        x_label = curves.draw_panel(axes, history, group)
    panels[-1].set_xlabel(x_label)
    figure.align_ylabels()
    figure.tight_layout()
    _save(figure, path)
    return True


def _paths(results, output):
    if output is None:
        return os.path.join(results.folder, "picture.png"), os.path.join(results.folder, "history.png")
    stem, ending = os.path.splitext(output)
    if ending.lower() not in ("", ".png"):
        raise ResultsError(f"pictures are PNG: expected a name that ends in .png, not {output}")
    return stem + ".png", stem + "-history.png"


def run(argv):
    options = parse(argv)
    results = Results(options.folder)
    points_path, history_path = _paths(results, options.output)
    written = []
    if len(results.times) or not results.has_history:
        draw_points(results, options, points_path)
        written.append(points_path)
    if results.has_history or options.history:
        if draw_history(results, options.history, history_path):
            written.append(history_path)
    if not written:
        raise ResultsError(f"{results.folder} holds no states and no rows of history")
    for path in written:
        print(path)


def main(argv=None):
    """Draws and prints the path of each picture. Returns the exit status: 2 and one line for bad input."""
    try:
        run(sys.argv[1:] if argv is None else argv)
        return 0
    except ResultsError as error:
        print(f"wisp picture: {error}", file=sys.stderr)
        return 2


if __name__ == "__main__":
    sys.exit(main())
