"""Reads and draws the results of Wisp.

    from wisp import Results
    results = Results("out")
    results.times            # of the written states [s]
    results.points(-1)       # the last one: a dict of NumPy arrays, "positions" among them
    results.history["time"]  # a dict of NumPy arrays, one for each column
"""
from .errors import ResultsError
from .results import Points, Results, read_history, read_pvd, read_vtu

__all__ = ["Points", "Results", "ResultsError", "read_history", "read_pvd", "read_vtu"]
