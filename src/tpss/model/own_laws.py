"""Laws of other packages, as scenarios name them, as records that kernels call."""

from typing import Any

from tpss.laws.compiled import called
from tpss.numerics.called import Called
from tpss.scenario.own_laws import OwnLaw


def own_law(own: OwnLaw | None) -> Any:
    """A row of `Called`, without a function where there is no law.

    Raises
    ------
    LawError
        numba cannot compile the law.
    """
    return Called.row() if own is None else called(own.registered.law, own.values)
