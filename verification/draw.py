"""Draws the data of a figure, FILE.csv, into FILE.png: curves over the first column, points coloured by the third, line
segments, or surfaces over the first two."""
import argparse
import csv
import os

import numpy as np
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.collections import LineCollection
from matplotlib.figure import Figure
from mpl_toolkits.mplot3d import Axes3D  # noqa: F401, makes the projection "3d" known


def read(path):
    with open(path, newline="", encoding="utf-8") as file:
        rows = list(csv.reader(file))
    titles, data = rows[0], np.array([[float(cell) for cell in row] for row in rows[1:]])
    if data.ndim != 2 or data.shape[1] != len(titles):
        raise SystemExit(f"{path}: {len(titles)} titles for rows of another length")
    return titles, data


def curves(figure, titles, data):
    axes = figure.add_subplot()
    x, columns = data[:, 0], data[:, 1:]
    positive = columns[np.isfinite(columns) & (columns > 0)]
    # Not for a few values near zero, where a curve begins or ends.
    if positive.size and np.nanmin(columns) > 0 and positive.max() > 1e3 * np.percentile(positive, 2):
        axes.set_yscale("log")
    if len(x) > 2 and x.min() > 0 and np.allclose(x[1:] / x[:-1], x[1] / x[0]):
        axes.set_xscale("log")  # a sequence of refinements
        axes.set_yscale("log")
    cut = far_off(columns) if axes.get_yscale() == "linear" else np.zeros(columns.shape[1], dtype=bool)
    for title, values, off in zip(titles[1:], columns.T, cut):
        known = np.isfinite(values)  # a curve may have fewer points than the others
        axes.plot(x[known], values[known], linewidth=1.2, label=title + (" (cut)" if off else ""))
    if cut.any():
        low, high = np.nanmin(columns[:, ~cut]), np.nanmax(columns[:, ~cut])
        axes.set_ylim(low - 0.5 * (high - low), high + 0.5 * (high - low))
    axes.set_xlabel(titles[0])
    if len(titles) == 2:
        axes.set_ylabel(titles[1])
    else:
        across = max(1, min(3, len(titles) - 1, 90 // max(len(title) for title in titles[1:])))
        axes.legend(frameon=False, fontsize=8, loc="upper center", bbox_to_anchor=(0.5, -0.14), ncol=across)
    axes.grid(True, color="#d9dee3", linewidth=0.6)


def far_off(columns):
    """Curves that would leave nothing to see of the others: unstable runs."""
    span = np.nanmax(columns, axis=0) - np.nanmin(columns, axis=0)
    return span > 20.0 * np.nanmedian(span) if len(span) > 2 else np.zeros(len(span), dtype=bool)


def points(figure, titles, data):
    panel = data[:, 3] if data.shape[1] > 3 else np.zeros(len(data))
    names = np.unique(panel)
    for k, name in enumerate(names):
        axes = figure.add_subplot(1, len(names), k + 1)
        chosen = data[panel == name]
        dots = axes.scatter(chosen[:, 0], chosen[:, 1], c=chosen[:, 2], s=3, linewidths=0)
        figure.colorbar(dots, ax=axes, orientation="horizontal", label=titles[2], pad=0.12)
        axes.set_aspect("equal")
        if len(names) > 1:
            axes.set_title(f"{titles[3]} {name:g}", fontsize=9)
    return len(names)


def segments(figure, titles, data):
    axes = figure.add_subplot()
    styles = {0: ("#30363d", 1.1, "grid"), 1: ("#9aa4ae", 0.6, "split"), 2: ("#c0392b", 0.9, "control triangles")}
    for kind, (color, width, label) in styles.items():
        chosen = data[data[:, 4] == kind]
        lines = chosen[:, :4].reshape(-1, 2, 2)
        axes.add_collection(LineCollection(lines, colors=color, linewidths=width, label=label))
    axes.autoscale()
    axes.set_aspect("equal")
    axes.legend(frameon=False, fontsize=8, loc="upper left", bbox_to_anchor=(1.0, 1.0))


def surface(figure, titles, data):
    panel = data[:, 3] if data.shape[1] > 3 else np.zeros(len(data))
    names = np.unique(panel)
    columns = min(len(names), 3 if len(names) == 3 else 2)
    rows = -(-len(names) // columns)
    for k, name in enumerate(names):
        axes = figure.add_subplot(rows, columns, k + 1, projection="3d")
        chosen = data[panel == name]
        axes.plot_trisurf(chosen[:, 0], chosen[:, 1], chosen[:, 2], cmap="viridis", linewidth=0)
        if len(names) > 1:
            axes.set_title(f"{titles[3]} {name:g}", fontsize=9)
        axes.tick_params(labelsize=7)
    return columns, rows


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("file")
    parser.add_argument("--title", default="")
    parser.add_argument("--points", action="store_true")
    parser.add_argument("--segments", action="store_true")
    parser.add_argument("--surface", action="store_true")
    given = parser.parse_args()
    titles, data = read(given.file)
    figure = Figure(figsize=(7.0, 4.2))
    FigureCanvasAgg(figure)
    if given.points:
        figure.set_size_inches(3.6 * points(figure, titles, data), 4.4)
    elif given.segments:
        figure.set_size_inches(6.0, 4.8)
        segments(figure, titles, data)
    elif given.surface:
        columns, rows = surface(figure, titles, data)
        figure.set_size_inches(3.6 * columns, 3.4 * rows + 0.4)
    else:
        curves(figure, titles, data)
    figure.suptitle(given.title, fontsize=10)
    figure.tight_layout()
    picture = os.path.splitext(given.file)[0] + ".png"
    figure.savefig(picture + ".part", format="png", dpi=140)
    os.replace(picture + ".part", picture)


if __name__ == "__main__":
    main()
