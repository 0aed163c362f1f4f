"""What is recorded: the one table from which records, dataset, tables and reference follow.

To record one more quantity of a train, node or station takes a line here, and the line in
`tpss.step.record` that writes the field of this name.
"""

from collections.abc import Sequence
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from tpss.record import Record


class Recorded(NamedTuple):
    """A recorded quantity.

    Attributes
    ----------
    name : str
        Of the variable in the dataset, and of the field of the record.
    of : str
        What there is one of at every instant: train, node, station or branch; empty: of the whole.
    unit : str
    words : str
    symbol : str
        In the notation of the thesis.
    remark : str
        What the words leave open.
    column : str
        Its name, with a unit, in the table of the trains' steps; empty if it is not in there.
    heading, digits : str, int
        How that column is printed; empty if it is not.
    phasor : str
        Phasor of which it is the magnitude or, in rad, the angle.  That is recorded as the load flow has
        it, in fields ``<phasor>_real`` and ``<phasor>_imag``; magnitude and angle are found later.
    array : str
        Array of `Recording` that holds it, if it is no field of a record.
    flags : tuple of str
        What its values from 0 on mean.
    at_instant : bool
        Whether it holds at the instant; otherwise over the interval that follows, as a mean where forces
        change within it.
    derived : bool
        Whether it follows from others when a dataset is made, and no record holds it.
    """

    name: str
    of: str
    unit: str
    words: str
    symbol: str = ""
    remark: str = ""
    column: str = ""
    heading: str = ""
    digits: int = 0
    phasor: str = ""
    array: str = ""
    flags: tuple[str, ...] = ()
    at_instant: bool = False
    derived: bool = False

    @property
    def dimensions(self) -> tuple[str, ...]:
        """Dimensions in the dataset."""
        return ("time", self.of) if self.of else ("time",)

    @property
    def fields(self) -> tuple[str, ...]:
        """Fields of a record that hold it."""
        if self.array or self.derived:
            return ()
        return (f"{self.phasor}_real", f"{self.phasor}_imag") if self.phasor else (self.name,)


RECORDED = (
    Recorded("route_position", "train", "m", "position along the route of the train", "x",
             "grows as it goes", at_instant=True),
    Recorded("position", "train", "m", "position on its line, in kilometre posts",
             column="position_km", heading="position", digits=3, at_instant=True, derived=True),
    Recorded("speed", "train", "m/s", "speed", "v",
             column="speed_kmh", heading="speed", digits=2, at_instant=True),
    Recorded("acceleration", "train", "m/s2", "acceleration", "a",
             column="acceleration_m_s2", heading="accel.", digits=4),
    Recorded("pantograph_voltage", "train", "V", "voltage at the pantograph", "U", phasor="pantograph",
             column="pantograph_voltage_kv", heading="voltage", digits=3),
    Recorded("pantograph_angle", "train", "rad", "voltage angle at the pantograph", r"\theta",
             phasor="pantograph", column="pantograph_angle_deg"),
    Recorded("tractive_force", "train", "N", "tractive force at the wheel rim", "F", "not negative",
             column="tractive_force_kn", heading="traction", digits=2),
    Recorded("braking_force", "train", "N", "braking force", "F_{brake}", "not negative",
             column="braking_force_kn", heading="brakes", digits=2),
    Recorded("running_resistance", "train", "N", "running resistance", "A + B v + C v^2",
             "0 while dwelling", column="running_resistance_kn", heading="resist.", digits=2),
    Recorded("gradient_force", "train", "N", "gradient force, positive uphill", r"m g \alpha",
             column="gradient_force_kn", heading="gradient", digits=2),
    Recorded("traction_power", "train", "W", "power of the tractive force", r"F v"),
    Recorded("braking_power", "train", "W", "power of the brakes", r"F_{brake} v"),
    Recorded("resistance_power", "train", "W", "power of the running resistance",
             "(A + B v + C v^2) v"),
    Recorded("gradient_power", "train", "W", "power of the gradient force, positive uphill",
             r"m g \alpha v"),
    Recorded("motor_power", "train", "W", "mechanical power of the motors", "P_{motor}"),
    Recorded("motor_current", "train", "A", "motor current", "I_D",
             "of one motor, in the former model of all four",
             column="motor_current_a", heading="motor", digits=1),
    Recorded("active_power", "train", "W", "active power drawn at the pantograph", "P_D",
             column="active_power_mw", heading="P", digits=3),
    Recorded("reactive_power", "train", "var", "reactive power drawn at the pantograph", "Q_D",
             "positive inductive", column="reactive_power_mvar", heading="Q", digits=3),
    Recorded("holding_time", "train", "s", "time at constant speed, before braking in the step", r"\tau",
             "0 in a step that does not brake within it", column="holding_time_s"),
    Recorded("node_voltage", "node", "V", "node voltage, at its own level", "U", phasor="node"),
    Recorded("node_angle", "node", "rad", "node voltage angle", r"\theta", phasor="node"),
    Recorded("station_active_power", "station", "W", "active power fed into the railway", "P_G"),
    Recorded("station_reactive_power", "station", "var", "reactive power fed into the railway", "Q_G"),
    Recorded("active_converters", "station", "1", "converters running", "n"),
    Recorded("converter_loading", "station", "1", "loading of the running converters", "Ld",
             "apparent power over their rating"),
    Recorded("station_losses", "station", "W", "losses within transformer stations and their grid",
             remark="0 in converter stations: the table converter_losses has theirs"),
    Recorded("network_losses", "", "W", "losses of contact line, transformers, high-voltage line",
             array="network_losses"),
    Recorded("branch_current", "branch", "A", "current of a branch, at its own level",
             remark="of a transformer, a high-voltage line, or at an end of a section of contact line",
             array="branch_current"),
    Recorded("train_state", "train", "1", "state of the train; -1: not on the line", array="train_state",
             flags=("waiting", "motoring", "coasting", "braking", "dwelling", "arrived")),
    Recorded("load_flow_passes", "", "1", "evaluations of the network", array="passes"),
)  # fmt: skip
"""Everything that is recorded, in the order of the dataset."""


REGENERATED = (
    Recorded("electric_braking_power", "train", "W", "power of the electric brakes at the wheel rim",
             r"F_e v"),
    Recorded("regenerated_power", "train", "W", "power that its electric brakes give it and the line",
             remark="auxiliaries, which are fed first, included"),
    Recorded("refused_power", "train", "W", "power that its electric brakes offer and the line refuses"),
)  # fmt: skip
"""What is recorded besides where trains have electric brakes."""

LINKED = (
    Recorded("link_current", "link", "A", "current of a transformer between several nodes",
             remark="on the side of the contact line", phasor="link"),
    Recorded("link_angle", "link", "rad", "angle of that current", phasor="link"),
)  # fmt: skip
"""What is recorded besides where transformers stand between several nodes."""
STORED = (
    Recorded("stored_energy", "store", "J", "energy in a store at the line", "E", at_instant=True),
    Recorded("store_power", "store", "W", "power that a store takes from the line", "P",
             "negative where it gives"),
    Recorded("store_losses", "store", "W", "losses of a store"),
)  # fmt: skip
"""What is recorded of stores of energy at the line."""

ON_BOARD = (
    Recorded("train_stored_energy", "train", "J", "energy in the store on board", "E",
             "0 of a train without one", at_instant=True),
    Recorded("train_storage_power", "train", "W", "power that the store on board takes", "S",
             "negative where it gives"),
    Recorded("train_storage_losses", "train", "W", "losses of the store on board"),
)  # fmt: skip
"""What is recorded besides where trains have stores of energy on board."""


RETURNED = (
    Recorded("rail_voltage", "train", "V", "voltage of the rails to earth, at the train",
             phasor="rail"),
    Recorded("rail_angle", "train", "rad", "angle of that voltage", phasor="rail"),
)  # fmt: skip
"""What is recorded besides where rails are conductors of their own."""


def _fields_of(what: str, table: Sequence[Recorded]) -> list[str]:
    own = (field for each in table if each.of == what for field in each.fields)
    return list(dict.fromkeys(own))


class Row(Record):
    """What is recorded of a train, node or station at an instant and over the interval that follows."""

    def __init_subclass__(cls, of: str, table: Sequence[Recorded] = RECORDED) -> None:
        fields = np.dtype([(field, float) for field in _fields_of(of, table)], align=True)
        cls.dtype = np.dtype((np.record, fields))

    if TYPE_CHECKING:

        def __getattr__(self, field: str) -> float: ...
        def __setattr__(self, field: str, value: float) -> None: ...


class TrainRow(Row, of="train"):
    """Row of a train."""


class RegenerationRow(Row, of="train", table=REGENERATED):
    """What the electric brakes of a train do."""


class NodeRow(Row, of="node"):
    """Row of a node."""


class StationRow(Row, of="station"):
    """Row of a feeding station."""


class LinkRow(Row, of="link", table=LINKED):
    """Row of a link."""


class RailRow(Row, of="train", table=RETURNED):
    """What the rails do at a train."""


class StoreRow(Row, of="store", table=STORED):
    """Row of a store of energy at the line."""


class OnBoardRow(Row, of="train", table=ON_BOARD):
    """What the store of a train does."""
