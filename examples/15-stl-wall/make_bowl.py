"""Writes bowl.stl: a bowl of half a ball's inside, closed by a lid, its axis tilted, as a triangulated surface.

usage: make_bowl.py FILE
"""
import math
import sys


def bowl(centre, radius, rings, sectors):
    """Triangles, outward normals by the right-hand rule, of the lower half of a ball and its flat lid."""
    def vertex(ring, sector):
        polar = 0.5 * math.pi * ring / rings
        angle = 2.0 * math.pi * (sector % sectors) / sectors
        r = radius * math.sin(polar)
        return (centre[0] + r * math.cos(angle), centre[1] + r * math.sin(angle),
                centre[2] - radius * math.cos(polar))

    lid = tuple(centre)
    triangles = []
    for k in range(sectors):
        triangles.append((vertex(0, 0), vertex(1, k + 1), vertex(1, k)))
        for ring in range(1, rings):
            a, b = vertex(ring, k), vertex(ring, k + 1)
            c, d = vertex(ring + 1, k), vertex(ring + 1, k + 1)
            triangles += [(a, b, d), (a, d, c)]
        triangles.append((lid, vertex(rings, k), vertex(rings, k + 1)))
    return triangles


def write(file, triangles):
    with open(file, "w", encoding="ascii") as out:
        out.write("solid bowl\n")
        for triangle in triangles:
            out.write(" facet normal 0 0 0\n  outer loop\n")
            for x in triangle:
                out.write("   vertex " + " ".join(f"{round(v, 9) + 0.0:.9g}" for v in x) + "\n")
            out.write("  endloop\n endfacet\n")
        out.write("endsolid bowl\n")


if __name__ == "__main__":
    write(sys.argv[1], bowl((0.5, 0.5, 0.62), 0.4, 8, 24))
