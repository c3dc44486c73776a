"""Reads Wisp's results into NumPy arrays; needs NumPy and the standard library, no VTK."""
import os
import re
import xml.etree.ElementTree as ElementTree
import zlib

import numpy as np

from .errors import ResultsError
from .scene import read_scene

_TYPES = {"Float64": "f8", "Float32": "f4", "Int64": "i8", "Int32": "i4", "UInt8": "u1"}


class Points(dict):
    """The arrays of one state by name, point by point: ``positions`` (n, 3) [m], and the fields (n,) or (n, components).

    ``units`` and ``component_names`` belong to the arrays of the same name; ``globals`` holds the numbers of the
    whole state (time, step).
    """

    def __init__(self):
        super().__init__()
        self.units = {}
        self.component_names = {}
        self.globals = {}

    @property
    def dimension(self):
        """2 if all points lie in z = 0, else 3."""
        return 3 if np.any(self["positions"][:, 2] != 0.0) else 2

    def field_names(self):
        return [name for name in self if name != "positions"]


class _Appended:
    """The arrays that follow the head of a .vtu file, compressed in blocks by zlib."""

    def __init__(self, path, content, start, order):
        self.path, self.content, self.start, self.order = path, content, start, order

    def array(self, element):
        kind = _TYPES.get(element.get("type"))
        if kind is None or element.get("format") != "appended":
            raise ResultsError(f"{self.path}: the array {element.get('Name')} is not of a kind that Wisp writes")
        at = self.start + int(element.get("offset"))
        blocks, _, _ = np.frombuffer(self.content, self.order + "u8", 3, at)
        sizes = np.frombuffer(self.content, self.order + "u8", int(blocks), at + 24)
        at += 24 + 8 * int(blocks)
        parts = []
        for size in sizes:
            parts.append(zlib.decompress(self.content[at:at + int(size)]))
            at += int(size)
        values = np.frombuffer(b"".join(parts), self.order + kind).astype(kind)
        components = int(element.get("NumberOfComponents", "1"))
        return values.reshape(-1, components) if components > 1 else values


def _read_bytes(path):
    try:
        with open(path, "rb") as stream:
            return stream.read()
    except OSError as error:
        raise ResultsError(f"cannot read {path}: {error.strerror}") from None


def read_vtu(path):
    """The points of one .vtu file, or of all pieces that a .pvtu file names. ResultsError if it is not whole."""
    path = os.fspath(path)
    if path.endswith(".pvtu"):
        return _read_pieces(path)
    content = _read_bytes(path)
    mark = content.find(b'<AppendedData encoding="raw">')
    if mark < 0 or not content.rstrip().endswith(b"</VTKFile>"):
        raise ResultsError(f"{path} is truncated or not a file of Wisp")
    try:
        root = ElementTree.fromstring(content[:mark] + b"</VTKFile>")
        if root.get("compressor") != "vtkZLibDataCompressor" or root.get("header_type") != "UInt64":
            raise ResultsError(f"{path} is not a file of Wisp: expected arrays compressed by zlib with UInt64 headers")
        order = "<" if root.get("byte_order") == "LittleEndian" else ">"
        appended = _Appended(path, content, content.index(b"_", mark + 28) + 1, order)
        points = Points()
        piece = root.find(".//Piece")
        points["positions"] = appended.array(piece.find("Points/DataArray")).reshape(-1, 3)
        for element in piece.iterfind("PointData/DataArray"):
            _take(points, element, appended)
        for element in root.iterfind(".//FieldData/DataArray"):
            points.globals[element.get("Name")] = appended.array(element)
        count = int(piece.get("NumberOfPoints"))
        if any(len(values) != count for values in points.values()):
            raise ResultsError(f"{path}: an array has not the {count} rows announced")
        return points
    except (ElementTree.ParseError, zlib.error, ValueError, TypeError, AttributeError) as error:
        raise ResultsError(f"{path} is damaged: {error}") from None


def _take(points, element, appended):
    name = element.get("Name")
    values = appended.array(element)
    points[name] = values
    unit = element.find("InformationKey[@name='UNITS_LABEL']")
    points.units[name] = "" if unit is None else (unit.text or "")
    components = values.shape[1] if values.ndim > 1 else 1
    names = [element.get(f"ComponentName{i}") for i in range(components)]
    if components > 1 and all(names):
        points.component_names[name] = names


def _read_pieces(path):
    root = _parse_xml(path)
    pieces = [read_vtu(os.path.join(os.path.dirname(path), piece.get("Source"))) for piece in root.iter("Piece")]
    if not pieces:
        raise ResultsError(f"{path} names no pieces")
    points = pieces[0]
    for name in points:
        try:
            points[name] = np.concatenate([piece[name] for piece in pieces])
        except (KeyError, ValueError):
            raise ResultsError(f"{path}: the pieces do not all hold {name}") from None
    return points


def _parse_xml(path):
    try:
        return ElementTree.fromstring(_read_bytes(path))
    except ElementTree.ParseError as error:
        raise ResultsError(f"{path} is damaged: {error}") from None


def read_pvd(path):
    """The entries (time, file, part) of a .pvd series, the files with the folder of the series."""
    folder = os.path.dirname(os.fspath(path))
    entries = []
    for element in _parse_xml(path).iter("DataSet"):
        try:
            entries.append((float(element.get("timestep")), os.path.join(folder, element.get("file")),
                            int(element.get("part", "0"))))
        except (TypeError, ValueError):
            raise ResultsError(f"{path}: cannot understand the entry {element.attrib}") from None
    return entries


def read_history(path):
    """The columns of a history.csv by name; a last line torn by a killed run is left out."""
    text = _read_bytes(path).decode("utf-8", "replace")
    whole = text[:text.rfind("\n") + 1].splitlines()
    if not whole or not whole[0].startswith("step,time"):
        raise ResultsError(f"{path} is not a history: expected columns that begin with step,time")
    names = whole[0].split(",")
    rows = np.empty((len(whole) - 1, len(names)))
    for number, line in enumerate(whole[1:]):
        cells = line.split(",")
        try:
            if len(cells) != len(names):
                raise ValueError
            rows[number] = [float(cell) for cell in cells]
        except ValueError:
            raise ResultsError(f"{path}:{number + 2}: expected {len(names)} numbers separated by commas") from None
    columns = {name: rows[:, i].copy() for i, name in enumerate(names)}
    columns["step"] = columns["step"].astype(np.int64)
    return columns


class Results:
    """A folder of results, or one .pvd file of it.

    ``series`` names the .pvd file without its ending; ``points.pvd`` unless told otherwise, or the only one there is.
    """

    def __init__(self, folder, series=None):
        folder = os.fspath(folder)
        if folder.endswith(".pvd"):
            self.folder, self._pvd = os.path.dirname(folder) or ".", folder
        else:
            self.folder, self._pvd = folder, None
        if not os.path.isdir(self.folder):
            raise ResultsError(f"there is no folder {self.folder}")
        if self._pvd is None:
            self._pvd = self._find_series(series)
        self._entries = [] if self._pvd is None else [e for e in read_pvd(self._pvd) if e[2] == 0]
        self._history = None

    def _find_series(self, series):
        found = sorted(name for name in os.listdir(self.folder) if name.endswith(".pvd"))
        wanted = (series or "points") + ".pvd"
        if wanted in found:
            return os.path.join(self.folder, wanted)
        if series is not None:
            raise ResultsError(f"there is no {wanted} in {self.folder}")
        if len(found) > 1:
            raise ResultsError(f"several series in {self.folder} ({', '.join(found)}): name one of them")
        return os.path.join(self.folder, found[0]) if found else None

    @property
    def times(self):
        """Times of the written states [s]."""
        return np.array([time for time, _, _ in self._entries])

    def points(self, i=-1):
        """The state ``i`` (negative: counted from the end)."""
        if not self._entries:
            raise ResultsError(f"no states of points are listed in {self.folder} (no .pvd, or an empty one)")
        try:
            entry = self._entries[i]
        except IndexError:
            raise ResultsError(f"{self.folder} has {len(self._entries)} states, not a number {i}") from None
        return read_vtu(entry[1])

    def nearest(self, time):
        """The number of the state whose time is nearest."""
        if not self._entries:
            raise ResultsError(f"no states of points are listed in {self.folder} (no .pvd, or an empty one)")
        return int(np.argmin(np.abs(self.times - time)))

    @property
    def has_history(self):
        return os.path.exists(os.path.join(self.folder, "history.csv"))

    @property
    def history(self):
        """The columns of history.csv by their names; a unit in brackets belongs to the name."""
        if self._history is None:
            self._history = read_history(os.path.join(self.folder, "history.csv"))
        return self._history

    @property
    def scene(self):
        """What stands around the points, from scene.json; empty where there is no such file."""
        return read_scene(os.path.join(self.folder, "scene.json"))


def split_unit(column):
    """``"kinetic energy [J]"`` -> ``("kinetic energy", "J")``; no unit is ``""``."""
    match = re.fullmatch(r"(.*?)\s*\[([^\[\]]*)\]", column)
    return (match.group(1), match.group(2)) if match else (column, "")
