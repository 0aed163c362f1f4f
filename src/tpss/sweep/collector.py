"""Garbage collection in processes that do nothing but cases."""

import gc

OBJECTS = 20_000
"""New objects after which they are looked through: those of many cases, where usual is a part of one."""


def spare_the_collector() -> None:
    """Let garbage be collected seldom, and never among what exists by now.

    The objects that exist are permanent: the many objects of cases would have them looked through,
    which would take a tenth of a second each time.  Those of a case hardly ever refer to each other in
    a circle, and go by themselves.
    """
    gc.collect()
    gc.freeze()
    gc.set_threshold(OBJECTS)
