"""One number for each point out of a field: components, magnitudes, invariants; and readable units."""
import difflib

import numpy as np

from .errors import ResultsError
from .results import split_unit

#: Order of symmetric tensors: plane strain keeps the first four.
SYMMETRIC = ["xx", "yy", "zz", "xy", "yz", "zx"]
_PREFERRED = ["displacement", "velocity", "stress"]
_PREFIXED = {"Pa", "N", "J", "W", "N/m", "J/m"}  # units whose first letter may carry a prefix (m^3 may not)


def nearest_name(wanted, names):
    names = [split_unit(name)[0] for name in names]
    close = difflib.get_close_matches(wanted, names, 1, 0.4)
    return f"; did you mean {close[0]}?" if close else (f"; there are {', '.join(names)}" if names else "")


def von_mises(stress):
    """Von Mises' equivalent of symmetric tensors (n, 4) xx yy zz xy, or (n, 6) xx yy zz xy yz zx."""
    xx, yy, zz = stress[:, 0], stress[:, 1], stress[:, 2]
    shear = np.sum(stress[:, 3:]**2, axis=1)
    return np.sqrt(0.5 * ((xx - yy)**2 + (yy - zz)**2 + (zz - xx)**2) + 3.0 * shear)


def default_field(points):
    for name in _PREFERRED + points.field_names():
        if name in points:
            return name
    raise ResultsError("the points carry no field")


def scalar(points, name=None, component=None):
    """(values (n,), label, unit) of a field.

    ``component``: a number, a component's name (x, xx), ``magnitude``, ``von-mises`` or ``mean`` (a third of the
    trace). Without it vectors give their magnitude and symmetric tensors von Mises' equivalent.
    """
    name = name or default_field(points)
    if name not in points or name == "positions":
        raise ResultsError(f"there is no field {name}{nearest_name(name, points.field_names())}")
    values = np.asarray(points[name], dtype=float)
    label, unit = name.replace("_", " "), points.units.get(name, "")
    if values.ndim == 1:
        if component not in (None, "0"):
            raise ResultsError(f"{name} has one component, not a component {component}")
        return values, label, unit
    count = values.shape[1]
    names = points.component_names.get(name) or _names(count)
    if component is None:
        component = "von-mises" if count in (4, 6) else "magnitude"
    if component == "magnitude":
        return np.sqrt(np.sum(values**2, axis=1)), f"|{label}|", unit
    if component in ("von-mises", "mean") and count not in (4, 6):
        raise ResultsError(f"{component} needs a symmetric tensor of 4 or 6 components, {name} has {count}")
    if component == "von-mises":
        return von_mises(values), f"von Mises {label}", unit
    if component == "mean":
        return np.mean(values[:, :3], axis=1), f"mean {label}", unit
    if component in names:
        return values[:, names.index(component)], f"{label} {component}", unit
    if component.isdigit() and int(component) < count:
        return values[:, int(component)], f"{label} {names[int(component)]}", unit
    choices = names + ["magnitude"] + (["von-mises", "mean"] if count in (4, 6) else [])
    raise ResultsError(f"{name} has no component {component}: expected 0 to {count - 1} or {', '.join(choices)}")


def _names(count):
    if count in (2, 3):
        return ["x", "y", "z"][:count]
    if count in (4, 6):
        return SYMMETRIC[:count]
    if count == 9:
        return [a + b for a in "xyz" for b in "xyz"]
    return [str(i) for i in range(count)]


def prefixed(values, unit):
    """Values and unit with the SI prefix that keeps the numbers readable: 25000 Pa -> 25 kPa."""
    finite = np.abs(values[np.isfinite(values)])
    largest = finite.max() if finite.size else 0.0
    if unit not in _PREFIXED or largest == 0.0:
        return values, unit
    for prefix, factor in ("G", 1e9), ("M", 1e6), ("k", 1e3), ("", 1.0), ("m", 1e-3), ("µ", 1e-6):
        if largest >= factor:
            return values / factor, prefix + unit
    return values, unit


def label_with_unit(label, unit):
    return f"{label} [{unit}]" if unit and unit != "-" else label
