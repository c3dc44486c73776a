"""The one kind of error that bad results or options raise."""


class ResultsError(Exception):
    """Results that are missing or cannot be understood; its text is one line."""
