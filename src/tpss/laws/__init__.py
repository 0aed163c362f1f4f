"""Laws of other packages: resistances, drivers and converters that a scenario names.

A package offers its laws under the entry points ``tpss.laws``, a notebook by `register`; a scenario then
names them, with parameters.  They are compiled when they are used, no kernel of TPSS is compiled again
for them, and results say whose they are.
"""

from tpss.laws.kinds import KINDS
from tpss.laws.law import Law, LawError, LawKind, Parameter, Quantity
from tpss.laws.registry import Registered, known_laws, register

__all__ = [
    "KINDS", "Law", "LawError", "LawKind", "Parameter", "Quantity", "Registered", "known_laws",
    "register",
]  # fmt: skip
