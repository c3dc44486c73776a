"""Small results written from Python, in the format of the engine, for the tests of the package."""
import json
import os
import zlib

import numpy as np

_TYPES = {"f8": "Float64", "i8": "Int64"}


def write_vtu(path, positions, fields, time=0.0, block=1 << 12):
    """`fields`: name -> (array, unit)."""
    appended = b""

    def element(name, values, unit=""):
        nonlocal appended
        values = np.ascontiguousarray(values)
        raw = values.tobytes()
        parts = [zlib.compress(raw[i:i + block], 1) for i in range(0, len(raw), block)]
        head = np.array([len(parts), block, len(raw) % block] + [len(part) for part in parts], "u8")
        text = (f'<DataArray type="{_TYPES[values.dtype.str[1:]]}" Name="{name}" '
                f'NumberOfComponents="{values.shape[1] if values.ndim > 1 else 1}" format="appended" '
                f'offset="{len(appended)}">'
                f'<InformationKey name="UNITS_LABEL" location="vtkDataArray">{unit}</InformationKey></DataArray>')
        appended += head.tobytes() + b"".join(parts)
        return text

    body = "".join(element(name, values, unit) for name, (values, unit) in fields.items())
    place = element("Points", positions)
    stamp = element("TimeValue", np.array([time]))
    head = ('<?xml version="1.0"?><VTKFile type="UnstructuredGrid" version="1.0" byte_order="LittleEndian" '
            'header_type="UInt64" compressor="vtkZLibDataCompressor"><UnstructuredGrid>'
            f'<FieldData>{stamp}</FieldData>'
            f'<Piece NumberOfPoints="{len(positions)}" NumberOfCells="0"><PointData>{body}</PointData>'
            f'<Points>{place}</Points></Piece></UnstructuredGrid><AppendedData encoding="raw">_')
    with open(path, "wb") as stream:
        stream.write(head.encode() + appended + b"</AppendedData></VTKFile>")


def write_series(folder, entries):
    with open(os.path.join(folder, "points.pvd"), "w", encoding="utf-8") as stream:
        stream.write('<VTKFile type="Collection" version="1.0"><Collection>')
        for time, name in entries:
            stream.write(f'<DataSet timestep="{time!r}" part="0" file="{name}"/>')
        stream.write("</Collection></VTKFile>")


def write_history(folder, names, rows):
    with open(os.path.join(folder, "history.csv"), "w", encoding="utf-8") as stream:
        stream.write(",".join(["step", "time"] + names) + "\n")
        for row in rows:
            stream.write(",".join(repr(x) for x in row) + "\n")


def beam(folder, per_cell=4):
    """A cantilever bent into an arc, with grid, a wall and a history: 2D."""
    h = 0.25
    x, y = np.meshgrid(np.arange(0.5 * h / per_cell, 4, h / per_cell), np.arange(0.5 * h / per_cell - 0.25, 0.25, h / per_cell))
    start = np.column_stack([x.ravel(), y.ravel(), 0 * x.ravel()])
    entries = []
    for i in range(5):
        curvature = 0.08 * i + 1e-12
        angle = curvature * start[:, 0]
        radius = 1.0 / curvature - start[:, 1]
        now = np.column_stack([radius * np.sin(angle), 1.0 / curvature - radius * np.cos(angle), 0 * angle])
        now[:, 1] *= -1
        stress = np.zeros((len(now), 4))
        stress[:, 0] = 12e3 * curvature * start[:, 1] / 0.25
        stress[:, 2] = 0.3 * stress[:, 0]
        gradient = np.column_stack([np.cos(angle), np.sin(angle), -np.sin(angle), np.cos(angle)])
        half = np.full((len(now), 2), 0.5 * h / per_cell)
        name = f"points-{i:06d}.vtu"
        write_vtu(os.path.join(folder, name), now, {
            "displacement": (now - start, "m"), "stress": (stress, "Pa"), "half_lengths": (half, "m"), "deformation_gradient": (gradient, "-"),
            "volume": (np.full(len(now), (h / per_cell)**2), "m^3"), "id": (np.arange(len(now)), "")}, 0.25 * i)
        entries.append((0.25 * i, name))
    write_series(folder, entries)
    lines = [list(np.arange(-0.5, 5.01, h)), list(np.arange(-3.0, 1.01, h))]
    with open(os.path.join(folder, "scene.json"), "w", encoding="utf-8") as stream:
        json.dump({"title": "Elastic beam", "grid": {"coordinates": lines}, "walls": [[[0, -0.6], [0, 0.6]]]}, stream)
    t = np.linspace(0, 1, 201)
    kinetic, strain = 40 * np.sin(9 * t)**2, 40 * np.cos(9 * t)**2
    write_history(folder, ["kinetic energy [J]", "strain energy [J]", "total energy [J]", "tip deflection [m]", "iterations"],
                  [[i, *map(float, (t[i], kinetic[i], strain[i], kinetic[i] + strain[i], -2.3 * t[i]**1.5, 4 + i % 3))]
                   for i in range(len(t))])


def bar(folder, count=8):
    """A hanging bar, twisted a little: 3D."""
    axis = (np.arange(count) + 0.5) / count
    x, y, z = np.meshgrid(axis, axis, (np.arange(3 * count) + 0.5) / count, indexing="ij")
    start = np.column_stack([x.ravel(), y.ravel(), z.ravel()])
    angle = 0.2 * start[:, 2]
    c, s = np.cos(angle), np.sin(angle)
    now = start.copy()
    now[:, 0] = 0.5 + c * (start[:, 0] - 0.5) - s * (start[:, 1] - 0.5)
    now[:, 1] = 0.5 + s * (start[:, 0] - 0.5) + c * (start[:, 1] - 0.5)
    stress = np.zeros((len(now), 6))
    stress[:, 2] = 1000 * 9.81 * start[:, 2]
    write_vtu(os.path.join(folder, "bar.vtu"), now, {
        "displacement": (now - start, "m"), "stress": (stress, "Pa"),
        "volume": (np.full(len(now), 1.0 / count**3), "m^3")}, 1.0)
    write_series(folder, [(1.0, "bar.vtu")])
