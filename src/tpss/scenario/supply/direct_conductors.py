"""Contact line, third rail and running rails of a track of direct current, which give its resistance."""

from pydantic import Field

from tpss.scenario.fields import Part, Real

REFERENCE_C = 20.0
"""Temperature of the resistances that are given. [°C]"""


def warmer(temperature_c: float, coefficient_per_k: float) -> float:
    r"""Resistance over that at 20 °C, :math:`1 + \alpha (\theta - 20)`. [1]"""
    return 1.0 + coefficient_per_k * (temperature_c - REFERENCE_C)


class DirectContactLine(Part):
    """The contact line or the third rail of a track, new and at 20 °C."""

    r_ohm_per_km: Real = Field(ge=0.0005, le=10, description="Resistance, new and at 20 °C.")
    contact_wire_percent: Real = Field(
        default=100.0,
        ge=0,
        le=100,
        description="Share of its conductance that is in the wires, or the rail, that wear.",
    )
    temperature_coefficient_per_k: Real = Field(
        default=0.0038,
        ge=0,
        le=0.01,
        description="Rise of the resistance at 20 °C, of copper 0.0038.",
    )

    def worn_ohm_per_km(self, wear_percent: float, temperature_c: float) -> float:
        r"""Resistance with a share w of the contact wires' area worn off, at a temperature. [Ω/km]

        .. math:: R = R_{20} \frac{1 + \alpha (\theta - 20)}{1 - s \, w}

        with the share s of the conductance that wears.
        """
        worn = self.contact_wire_percent / 100.0 * wear_percent / 100.0
        warm = warmer(temperature_c, self.temperature_coefficient_per_k)
        return self.r_ohm_per_km * warm / (1.0 - worn)


class RunningRails(Part):
    """The running rails of a track, both of them, through which the current returns."""

    r_ohm_per_km: Real = Field(ge=0.0005, le=10, description="Resistance of both rails at 20 °C.")
    temperature_coefficient_per_k: Real = Field(
        default=0.005, ge=0, le=0.01, description="Rise of the resistance at 20 °C, of steel 0.005."
    )

    def warm_ohm_per_km(self, temperature_c: float) -> float:
        r"""Resistance at a temperature, :math:`R_{20} (1 + \alpha (\theta - 20))`. [Ω/km]"""
        return self.r_ohm_per_km * warmer(temperature_c, self.temperature_coefficient_per_k)
