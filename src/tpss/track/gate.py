"""Gates: places on a route that a train passes when it is its turn only.

Behind a gate lies a **stretch**, of which trains of both directions use one track, a single one or one
of several, between two places where they may cross.  Trains run on a stretch in one direction at a
time.  Where routes come together on one track there is a stretch without length, which trains enter one
by one.

A train that may not pass waits with its head at the gate; at a station of several tracks it is in
nobody's way there.  Between two single tracks lies a **crossing place**, such a station: a train whose
head has come there stands in it as a whole.
"""

from enum import IntEnum

from tpss.record import Record


class Precedence(IntEnum):
    """Who goes first where trains meet on a single track or come together."""

    FREE = 0
    """Nobody waits."""
    TIMETABLE_ORDER = 1
    FIRST_COME = 2


class Gate(Record):
    """A gate of a route."""

    from_m: float
    """Position at which a train waits; infinite: there is no further gate. [m]"""
    until_m: float
    """Position at which the head leaves the stretch. [m]"""
    clears_whole: bool
    """Whether the rear has to leave it too."""
    stretch: int
    """Index of the stretch behind it."""
    direction: int
    """Direction in which the route uses the stretch, 0 or 1."""
    place: int
    """Index of the crossing place at its end, where there is another gate; -1: there is none."""
    aside: bool
    """Whether trains that wait at it stand on tracks of their own: at a station of several tracks, or at
    their origin."""
