"""How far a run of many cases has come."""

from dataclasses import dataclass


@dataclass(frozen=True)
class Advance:
    """Progress of a study, or of the cases of a plan."""

    cases: int
    done: int
    """Finished cases."""
    before: int
    """Cases that were finished at the start."""
    elapsed_s: float
