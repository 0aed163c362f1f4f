"""Stores of energy on board of trains."""

from pydantic import Field

from tpss.scenario.fields import Real
from tpss.scenario.storage import EnergyStore


class OnBoardStorage(EnergyStore):
    """A store on board: it takes what the train brakes, and helps where much is asked for."""

    line_power_cap_kw: Real | None = Field(
        default=None,
        gt=0,
        le=1_000_000,
        description="Power from the line above which the store gives the rest, as far as it can; leave "
        "it out: it helps only where there is no contact line.",
    )
    standing_current_a: Real | None = Field(
        default=None,
        gt=0,
        le=100_000,
        description="Highest current at the pantograph while the train stands at a stop and charges its "
        "store; leave it out: it charges by its brakes only.",
    )
