"""A source of the network, whichever kind it is: its law, what is plausible, its loading, its losses.

The load flow, the audit and the least-squares formulation know sources by the functions here.  A kind
is a file beside this one, with the record of its parameters and its law; here it has a member of
`SourceKind`, a field in `Source`, and a branch where it differs.
"""

from enum import IntEnum

from tpss.kernel import inlined, kernel
from tpss.numerics.pairs import Pair, magnitude
from tpss.record import Record
from tpss.sources.bounded import Bounds, bounded_is_plausible, bounded_residual
from tpss.sources.converter import (
    ConverterLaw,
    converter_is_plausible,
    converter_reserve,
    converter_residual,
    set_unloaded_converter,
    unloaded_converter,
)
from tpss.sources.grid import (
    GridLaw,
    grid_losses,
    grid_residual,
    set_unloaded_grid,
    unloaded_grid,
)
from tpss.sources.mixed import (
    MixedLaw,
    mixed_is_plausible,
    mixed_reserve,
    mixed_residual,
    set_unloaded_mixed,
    unloaded_mixed,
)
from tpss.sources.own import (
    OwnStationLaw,
    own_is_plausible,
    own_residual,
    set_unloaded_own,
    unloaded_own,
)
from tpss.sources.rectifier import (
    RectifierLaw,
    rectifier_residual,
    set_unloaded_rectifier,
    unloaded_rectifier,
)


class SourceKind(IntEnum):
    """Kinds of sources."""

    CONVERTER = 0
    GRID = 1
    MIXED = 2
    BOUNDED = 3
    """A converter station with bounds."""
    RECTIFIER = 4
    OWN = 5
    """A converter station by a law of somebody's own."""


class Source(Record):
    """A feeding station: its node, its units, and the parameters of each kind."""

    node: int
    """Fixed node at which it feeds."""
    kind: SourceKind
    """Which of the kinds holds."""
    installed: int
    """Number of equal units (converters, transformers) installed and in service; 0: it is out."""
    controlled: bool
    """Whether the number of running units follows the loading."""
    rating_va: float
    """Rated power of one unit. [VA]"""
    converter: ConverterLaw = ConverterLaw.row()
    grid: GridLaw = GridLaw.row()
    mixed: MixedLaw = MixedLaw.row()
    bounds: Bounds = Bounds.row()
    rectifier: RectifierLaw = RectifierLaw.row()
    own: OwnStationLaw = OwnStationLaw.row()


@inlined
def residual(
    voltage: complex, current: complex, running: float, source: Source, derivatives: bool
) -> tuple[complex, Pair, Pair]:
    """Voltage of a source less what its law asks for, and the derivatives of that difference. [V]

    Parameters
    ----------
    voltage : complex
        V, at the node. [V]
    current : complex
        J, that leaves the node into the network. [A]
    running : float
        Number of units that run, at least 1.
    source : Source
    derivatives : bool
        Whether the derivatives are asked for, which take as long as the rest; otherwise they may be 0.

    Returns
    -------
    residual : complex
        V - f(V, J), zero at a solution. [V]
    by_voltage, by_current : Pair
        Its derivatives over V [1] and over J [Ω].
    """
    if source.kind == SourceKind.GRID:
        return grid_residual(voltage, current, running, source.grid)
    if source.kind == SourceKind.MIXED:
        return mixed_residual(voltage, current, source.mixed)
    if source.kind == SourceKind.BOUNDED:
        return bounded_residual(voltage, current, running, source.converter, source.bounds)
    if source.kind == SourceKind.RECTIFIER:
        return rectifier_residual(voltage, current, running, source.rectifier)
    if source.kind == SourceKind.OWN:
        return own_residual(voltage, current, running, source.own)
    return converter_residual(voltage, current, running, source.converter, derivatives)


@inlined
def is_plausible(voltage: complex, current: complex, running: float, source: Source) -> bool:
    """Whether a source can be in a state that its law admits."""
    if source.kind == SourceKind.CONVERTER:
        return converter_is_plausible(voltage, current, running, source.converter)
    if source.kind == SourceKind.MIXED:
        return mixed_is_plausible(voltage, current, source.mixed)
    if source.kind == SourceKind.BOUNDED:
        return bounded_is_plausible(voltage, current, running, source.converter, source.bounds)
    if source.kind == SourceKind.OWN:
        return own_is_plausible(voltage, current, running, source.own)
    return True


@kernel
def reserve(voltage: complex, current: complex, running: float, source: Source) -> float:
    """How far a source is from the end of what its law admits: 1 without load, 0 there. [1]"""
    if source.kind in (SourceKind.CONVERTER, SourceKind.BOUNDED):
        return converter_reserve(voltage, current, running, source.converter)
    if source.kind == SourceKind.MIXED:
        return mixed_reserve(voltage, current, source.mixed)
    return 1.0


@kernel
def unloaded(source: Source) -> tuple[float, float]:
    """Magnitude and angle of a source's voltage without load. [V], [rad]"""
    if source.kind == SourceKind.GRID:
        return unloaded_grid(source.grid)
    if source.kind == SourceKind.MIXED:
        return unloaded_mixed(source.mixed)
    if source.kind == SourceKind.RECTIFIER:
        return unloaded_rectifier(source.rectifier)
    if source.kind == SourceKind.OWN:
        return unloaded_own(source.own)
    return unloaded_converter(source.converter)


@kernel
def set_unloaded(magnitude_v: float, angle_rad: float, source: Source) -> None:
    """Give a source another voltage without load; all else of its law stays."""
    if source.kind == SourceKind.GRID:
        set_unloaded_grid(magnitude_v, angle_rad, source.grid)
    elif source.kind == SourceKind.MIXED:
        set_unloaded_mixed(magnitude_v, angle_rad, source.mixed)
    elif source.kind == SourceKind.RECTIFIER:
        set_unloaded_rectifier(magnitude_v, source.rectifier)
    elif source.kind == SourceKind.OWN:
        set_unloaded_own(magnitude_v, angle_rad, source.own)
    else:
        set_unloaded_converter(magnitude_v, angle_rad, source.converter)


@inlined
def losses(current: complex, running: float, source: Source) -> float:
    """Losses within a source, none of a converter or of one that is out of service. [W]

    Those of converters do not act on the network: `tpss.results.converter_losses` finds them.
    """
    if source.kind == SourceKind.GRID and running > 0.0:
        return grid_losses(current, running, source.grid)
    return 0.0


@kernel
def loading(power: complex, running: float, rating_va: float) -> float:
    r"""Apparent power of a source over the rating of its running units, 0 if none runs. [1]

    .. math:: Ld = \sqrt{P_G^2 + Q_G^2} / (NoC_{used} \, S_{nom})

    Parameters
    ----------
    power : complex
        P + jQ fed into the railway. [VA]
    running : float
        Number of units that run.
    rating_va : float
        Rated power of one unit. [VA]

    References
    ----------
    [Boullanger2009]_, eq. (3.6).
    """
    return magnitude(power) / (running * rating_va) if running > 0.0 else 0.0
