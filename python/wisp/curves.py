"""Draws columns of the history over time, one panel for each unit."""
import numpy as np

from .fields import label_with_unit, nearest_name, prefixed
from .errors import ResultsError
from .results import split_unit

_PANELS = 4


# How a run went rather than what came out of it; drawn if named.
_OF_THE_STEPS = ("stage", "dt", "residual", "cuts")


def _tells_something(history, name):
    """Not a column of the steps, not one that never changes, not the position of a point whose displacement is there."""
    displacement = name.replace(" position ", " displacement ")
    if split_unit(name)[0] in _OF_THE_STEPS or (displacement != name and displacement in history):
        return False
    values = np.asarray(history[name])
    return values.size == 0 or np.any(values != values[0])


def choose_columns(history, wanted):
    """The columns named (with or without their unit), or all that tell something of the bodies."""
    columns = [name for name in history if name not in ("step", "time")]
    if not wanted:
        return [name for name in columns if _tells_something(history, name)] or columns
    chosen = []
    for name in wanted:
        exact = [c for c in columns if name in (c, split_unit(c)[0])]
        if not exact:
            raise ResultsError(f"the history has no column {name}{nearest_name(name, columns)}")
        chosen += [c for c in exact if c not in chosen]
    return chosen


def panels_of(columns, all_of_them):
    """Columns grouped by unit, in their order; numbers without a unit stand alone, for they may be anything."""
    panels = {}
    for column in columns:
        unit = split_unit(column)[1]
        panels.setdefault(unit if unit not in ("", "-") else column, []).append(column)
    groups = list(panels.values())
    return groups if all_of_them else groups[:_PANELS]


def _abscissa(history):
    time = history["time"]
    if len(time) > 1 and np.all(np.diff(time) >= 0) and time[-1] > time[0]:
        return time, "time [s]"
    return history["step"], "step"


def draw_panel(axes, history, columns):
    x, x_label = _abscissa(history)
    unit = split_unit(columns[0])[1]
    together = np.concatenate([history[column] for column in columns])
    shown_unit = prefixed(together, unit)[1]
    factor = _factor(unit, shown_unit)
    finite = together[np.isfinite(together)]
    if finite.size and finite.min() > 0 and finite.max() > 1e4 * finite.min():
        axes.set_yscale("log")
    style = {"marker": "o", "markersize": 3} if len(x) <= 40 else {}
    for column in columns:
        axes.plot(x, history[column] / factor, linewidth=1.6, label=split_unit(column)[0], **style)
    names = [split_unit(column)[0] for column in columns]
    axes.set_ylabel(label_with_unit(_common_ending(names), shown_unit).strip())
    if len(names) > 1:
        axes.legend(frameon=False, fontsize=9, loc="upper left", bbox_to_anchor=(1.0, 1.0))
    axes.grid(True, color="#d9dee3", linewidth=0.6)
    axes.spines[["top", "right"]].set_visible(False)
    axes.margins(x=0.01)
    axes.ticklabel_format(axis="x", style="sci", scilimits=(-3, 4))
    if axes.get_yscale() == "linear":
        axes.ticklabel_format(axis="y", style="sci", scilimits=(-3, 4), useOffset=False)
    return x_label


def _common_ending(names):
    """The words with which all names end: kinetic energy, strain energy -> energy."""
    words = [name.split() for name in names]
    length = 0
    while all(len(w) > length for w in words) and len({w[-1 - length] for w in words}) == 1:
        length += 1
    return " ".join(words[0][len(words[0]) - length:])


def _factor(unit, shown):
    prefix = shown[:len(shown) - len(unit)] if unit else ""
    return {"G": 1e9, "M": 1e6, "k": 1e3, "m": 1e-3, "µ": 1e-6}.get(prefix, 1.0)
