"""Draws outline.csv, the ghost of the verification cases.

The outline of the paper's ghost is not printed, so this one is our own: a rounded head, straight sides, a wavy hem, two
eyes and a mouth (holes). It is 0.4 m wide and 0.4 m high, in [0, 0.4]^2, and its area is 0.10736 m^2, the area that follows
from the paper's initial energies. Rounded lower corners let two ghosts meet about as late as the paper's, and no part
is so thin that a cell holds it alone. The depth of the hem is found by bisection. Run it from any folder to write the file again: python3 outline.py [--picture ghost.png]
"""

import sys
from pathlib import Path

import numpy as np

WIDTH = 0.4  # m, also the height
AREA = 0.10736  # m^2
EYE = dict(x=0.080, y=0.250, rx=0.033, ry=0.055)  # half-distance from the middle, height, half-axes in m
MOUTH = dict(y=0.160, rx=0.036, ry=0.046)
LOBES = 5  # of the hem
CORNER = 0.07  # m, radius of the lower corners, on which the hem lies


def ellipse(cx, cy, rx, ry, n):
    """n vertices, counter-clockwise."""
    t = 2.0 * np.pi * np.arange(n) / n
    return np.column_stack([cx + rx * np.cos(t), cy + ry * np.sin(t)])


def body(depth):
    """Counter-clockwise from the lower left corner: hem, right side, head, left side (the closing edge)."""
    x = 0.5 * WIDTH * (1.0 - np.cos(np.linspace(0.0, np.pi, 129)))  # dense where the corners are steep
    x[64], x[-1] = 0.5 * WIDTH, WIDTH
    inwards = CORNER - np.minimum(np.minimum(x, WIDTH - x), CORNER)
    corner = CORNER - np.sqrt(CORNER**2 - inwards**2)
    hem = np.column_stack([x, corner + 0.5 * depth * (1.0 + np.cos(2.0 * np.pi * LOBES * x / WIDTH))])
    hem[64, 1] = 0.0  # cos(5 pi) is -1 only to rounding
    t = np.linspace(0.0, np.pi, 97)
    head = np.column_stack([0.5 * WIDTH * (1.0 + np.cos(t)), 0.5 * WIDTH * (1.0 + np.sin(t))])
    head[48] = 0.5 * WIDTH, WIDTH
    head[-1] = 0.0, 0.5 * WIDTH
    return np.vstack([hem, head])


def rings(depth):
    middle = 0.5 * WIDTH
    return [
        body(depth),
        ellipse(middle - EYE["x"], EYE["y"], EYE["rx"], EYE["ry"], 48)[::-1],
        ellipse(middle + EYE["x"], EYE["y"], EYE["rx"], EYE["ry"], 48)[::-1],
        ellipse(middle, MOUTH["y"], MOUTH["rx"], MOUTH["ry"], 48)[::-1],
    ]


def area(polygon):
    """Shoelace formula; holes run clockwise and so subtract."""
    total = 0.0
    for ring in polygon:
        x, y = ring.T
        total += 0.5 * np.sum(x * np.roll(y, -1) - np.roll(x, -1) * y)
    return total


def inside(polygon, x, y):
    """Even-odd rule for arrays of points."""
    result = np.zeros(x.shape, dtype=bool)
    for ring in polygon:
        for (ax, ay), (bx, by) in zip(ring, np.roll(ring, -1, axis=0)):
            if ay == by:
                continue
            result ^= ((ay > y) != (by > y)) & (x < ax + (y - ay) / (by - ay) * (bx - ax))
    return result


def count(polygon, across):
    """Points inside of a square grid with `across` points a direction in the bounding box."""
    c = (np.arange(across) + 0.5) * WIDTH / across
    return int(inside(polygon, *np.meshgrid(c, c)).sum())


def solve():
    """Rings with the wanted area: the area falls as the hem's arches grow."""
    low, high = 0.0, 0.15
    assert area(rings(low)) > AREA > area(rings(high))
    for _ in range(200):
        depth = 0.5 * (low + high)
        low, high = (depth, high) if area(rings(depth)) > AREA else (low, depth)
    return low, rings(low)


def main():
    depth, polygon = solve()
    lines = ["# The ghost: 0.4 m x 0.4 m, area 0.10736 m^2, drawn by outline.py. Outer ring, two eyes, a mouth.", "x,y"]
    blocks = ["\n".join(f"{float(x)!r},{float(y)!r}" for x, y in ring) for ring in polygon]
    Path(__file__).with_name("outline.csv").write_text("\n".join(lines) + "\n" + "\n\n".join(blocks) + "\n")
    print(f"depth of the hem {depth:.6f} m, area {area(polygon):.15f} m^2")
    for across in (31, 60, 120):
        print(f"{across} points across: {count(polygon, across)} inside")
    if "--picture" in sys.argv:
        import matplotlib

        matplotlib.use("Agg")
        import matplotlib.pyplot as plt

        figure, axes = plt.subplots(figsize=(4, 4))
        for ring in polygon:
            axes.plot(*np.vstack([ring, ring[:1]]).T, "k-", linewidth=1)
        axes.set_aspect("equal")
        figure.savefig(sys.argv[sys.argv.index("--picture") + 1], dpi=120)


if __name__ == "__main__":
    main()
