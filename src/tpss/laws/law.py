"""What a law of somebody's own is: a function of numbers, its parameters, and words about it."""

import hashlib
import inspect
import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass

from tpss.errors import TpssError

MOST_PARAMETERS = 16
"""As many as a record of the kernels has places, `numerics.called`, which a scenario must not import."""


class LawError(TpssError):
    """A law that cannot be used as it is.

    Parameters
    ----------
    problem : str
        What is wrong.
    remedy : str
        What to do about it.
    """

    def __init__(self, problem: str, remedy: str) -> None:
        super().__init__(f"{problem}: {remedy}")
        self.problem, self.remedy = problem, remedy


@dataclass(frozen=True)
class Quantity:
    """A number that a kind of law is given, or has to find."""

    name: str
    unit: str
    describes: str
    may_be_infinite: bool = False


@dataclass(frozen=True)
class Parameter:
    """A number that whoever uses a law sets.

    Parameters
    ----------
    name : str
        As the function calls it, with the unit at its end, such as ``factor`` or ``band_m_s``.
    describes : str
    default : float, optional
        Value where a scenario gives none; without it, a scenario has to.
    least, most : float
        Range of it.
    """

    name: str
    describes: str
    default: float | None = None
    least: float = -math.inf
    most: float = math.inf


@dataclass(frozen=True)
class LawKind:
    """A kind of laws: what they are given, what they find, and where a scenario names them."""

    name: str
    given: tuple[Quantity, ...]
    found: tuple[Quantity, ...]
    place: str
    """Key of a scenario, ``*`` for any name or number."""


@dataclass(frozen=True)
class Law:
    """A law that somebody has written.

    Parameters
    ----------
    kind : LawKind
        One of `KINDS`.
    name : str
        By which a scenario names it.
    function : callable
        Of the numbers in `LawKind.given`, then of the parameters, each under its name; it returns the
        number in `LawKind.found`, or a tuple of them.  It is compiled by numba: arithmetic, conditions,
        and functions of `math`, on floats.
    describes : str
        What it says, in a line.
    source : str
        Where it comes from.
    parameters : tuple of Parameter

    Raises
    ------
    LawError
        The function does not take what its kind gives, or there are too many parameters.
    """

    kind: LawKind
    name: str
    function: Callable[..., float | tuple[float, ...]]
    describes: str
    source: str
    parameters: tuple[Parameter, ...] = ()

    def __post_init__(self) -> None:
        expected = [
            *(each.name for each in self.kind.given),
            *(each.name for each in self.parameters),
        ]
        taken = list(inspect.signature(self.function).parameters)
        if taken != expected:
            raise LawError(
                f"the function of the law {self.name!r} takes ({', '.join(taken)})",
                f"let it take ({', '.join(expected)}): what a law of the kind {self.kind.name!r} is "
                "given, and its parameters",
            )
        if len(self.parameters) > MOST_PARAMETERS:
            raise LawError(
                f"the law {self.name!r} has {len(self.parameters)} parameters",
                f"give it {MOST_PARAMETERS} at most",
            )

    def values(self, given: Mapping[str, float]) -> tuple[float, ...]:
        """Values of all parameters in their order, defaults where none is given.

        Raises
        ------
        LawError
            A parameter is unknown, missing, or outside of its range.
        """
        names = [each.name for each in self.parameters]
        for name in given:
            if name not in names:
                has = f"take one of {', '.join(names)}" if names else "leave it out, it has none"
                raise LawError(f"the law {self.name!r} has no parameter {name!r}", has)
        return tuple(self._value(each, given.get(each.name)) for each in self.parameters)

    def _value(self, parameter: Parameter, given: float | None) -> float:
        value = parameter.default if given is None else given
        if value is None:
            raise LawError(
                f"the law {self.name!r} has no value of {parameter.name!r}",
                f"give parameters = {{ {parameter.name} = ... }}: {parameter.describes}",
            )
        if not parameter.least <= value <= parameter.most:
            raise LawError(
                f"{parameter.name!r} of the law {self.name!r} is {value:g}",
                f"give a value from {parameter.least:g} to {parameter.most:g}: {parameter.describes}",
            )
        return float(value)

    @property
    def digest(self) -> str:
        """SHA-256 of the text of the function, or of its bytecode where there is no text; shortened.

        What the function itself calls is not part of it.
        """
        try:
            text = inspect.getsource(self.function).encode()
        except (OSError, TypeError):
            text = self.function.__code__.co_code
        return hashlib.sha256(text).hexdigest()[:16]
