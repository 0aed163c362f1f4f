"""What the program tells those who listen: records of the logger ``tpss``, which prints nothing.

>>> import logging
>>> logging.basicConfig(level=logging.INFO)  # doctest: +SKIP

Each record has its kind as ``record.event``, and what it tells of as ``record.fields``, a dict.
"""

import logging
from typing import Any

LOG = logging.getLogger("tpss")
LOG.addHandler(logging.NullHandler())

EVENTS = {
    "compiling": (logging.INFO, "compiling the numerical kernels, once"),
    "simulating": (logging.INFO, "simulating %(scenario)s"),
    "note": (logging.INFO, "%(scenario)s: %(note)s"),
    "simulated": (
        logging.INFO,
        "%(scenario)s: %(status)s after %(duration_min).1f min, in %(simulation_s).3f s; "
        "notes: %(notes)d, steps in which something was limited: %(limited)d",
    ),
    "audit failed": (logging.WARNING, "%(scenario)s: the audit failed: %(failures)s"),
    "no lanes": (logging.WARNING, "cases run alone, as lanes cannot be used: %(problem)s"),
    "saved": (logging.INFO, "%(scenario)s: saved in %(folder)s"),
    "cases": (logging.INFO, "%(name)s: %(done)d of %(cases)d cases done"),
}
"""Kinds of records, their levels and words."""


def is_heard(event: str) -> bool:
    """Whether anybody listens to a kind of records, so that what takes long to tell is worth it."""
    return LOG.isEnabledFor(EVENTS[event][0])


def tell(event: str, **fields: Any) -> None:
    """Tell what happens.

    Parameters
    ----------
    event : str
        Of `EVENTS`.
    **fields
        What its words name.
    """
    level, words = EVENTS[event]
    if LOG.isEnabledFor(level):
        LOG.log(level, words, fields, extra={"event": event, "fields": fields})
