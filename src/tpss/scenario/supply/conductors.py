"""Contact line, rails and feeder as conductors of their own: their matrices, and the rails' leakage."""

from typing import Annotated, Literal, Self

import numpy as np
import numpy.typing as npt
from pydantic import Field, model_validator

from tpss.scenario.fields import Name, Part, Position, Real, ascending, fault, name_of_line

ConductorName = Literal[
    "contact", "feeder", "rails",
    "contact 1", "feeder 1", "rails 1", "contact 2", "feeder 2", "rails 2",
]  # fmt: skip
"""What a conductor of a track is; of two coupled tracks with the number of its track."""

Row = Annotated[tuple[Real, ...], Field(min_length=2, max_length=6)]
Matrix = Annotated[tuple[Row, ...], Field(min_length=2, max_length=6)]

ASYMMETRY = 1e-6
"""Matrices may be unsymmetrical by so much of their largest element, as rounded ones are. [1]"""


class LineMatrices(Part):
    """The conductors of a track, or of two tracks side by side, with matrices of a kilometre.

    `tpss line-constants` writes them from where the conductors hang.
    """

    names: Annotated[tuple[ConductorName, ...], Field(min_length=2, max_length=6)] = Field(
        description="What each row and column is: `contact`, `rails` and, if there is one, `feeder`; "
        "of two coupled tracks `contact 1`, `rails 1`, ..., `contact 2`, ..."
    )
    r_ohm_per_km: Matrix = Field(description="Resistances, and those that two have in common.")
    x_ohm_per_km: Matrix = Field(description="Reactances at the supply's frequency.")
    b_us_per_km: Matrix | None = Field(
        default=None, description="Susceptances at that frequency; leave it out: none."
    )

    @property
    def tracks(self) -> int:
        """Number of tracks that they describe."""
        return sum(name.startswith("contact") for name in self.names)

    @property
    def impedance_ohm_per_m(self) -> npt.NDArray[np.complex128]:
        """Series impedances. [Ω/m]"""
        return (np.array(self.r_ohm_per_km) + 1j * np.array(self.x_ohm_per_km)) / 1e3

    @property
    def susceptance_s_per_m(self) -> npt.NDArray[np.complex128]:
        """Shunt admittances, without what leaks from rails. [S/m]"""
        if self.b_us_per_km is None:
            return np.zeros((len(self.names),) * 2, dtype=complex)
        return 1e-9j * np.array(self.b_us_per_km)

    @model_validator(mode="after")
    def _tracks_are_whole(self) -> Self:
        kinds = [name.partition(" ") for name in self.names]
        tracks = sorted({number for _, _, number in kinds})
        if len(set(self.names)) < len(self.names) or tracks not in ([""], ["1", "2"]):
            raise fault(
                f"the names {', '.join(self.names)} are neither those of one track nor of two",
                "name each conductor once, all of them without a number or all with 1 or 2",
            )
        of_tracks = [{kind for kind, _, number in kinds if number == track} for track in tracks]
        if not {"contact", "rails"} <= of_tracks[0] or of_tracks[0] != of_tracks[-1]:
            raise fault(
                f"the names {', '.join(self.names)} lack a conductor",
                "name contact and rails, and a feeder if there is one, of each track",
            )
        return self

    @model_validator(mode="after")
    def _matrices_are_passive(self) -> Self:
        n = len(self.names)
        for key in ("r_ohm_per_km", "x_ohm_per_km", "b_us_per_km"):
            given = getattr(self, key)
            if given is None:
                continue
            if len(given) != n or any(len(row) != n for row in given):
                raise fault(
                    f"{key} has not {n} rows of {n} numbers",
                    "give a row and a column for each name",
                )
            matrix = np.array(given)
            if np.abs(matrix - matrix.T).max() > ASYMMETRY * np.abs(matrix).max():
                raise fault(
                    f"{key} is not symmetrical",
                    "give what two conductors have in common in both places",
                )
        if np.linalg.eigvalsh(np.array(self.r_ohm_per_km)).min() <= 0.0:
            raise fault(
                "r_ohm_per_km is that of no passive line: currents in it would give power",
                "check the resistances in common, which are less than those of each",
            )
        return self


class Conductors(Part):
    """Contact line, rails and feeder are conductors of their own, and rails have a voltage to earth.

    Impedances are those of the catenary: its `conductors`, or, on direct current, `contact_line` and
    `rails`.
    """

    leakage_s_per_km: Real = Field(
        ge=0, le=1_000, description="Conductance between the rails of a track and the earth."
    )
    nodes_every_km: Real = Field(
        default=2.0,
        ge=0.05,
        le=1_000,
        description="Longest piece of line between two nodes, at which the voltage of the rails is told "
        "and their leakage is lumped.",
    )


class Autotransformers(Part):
    """Autotransformers between contact line, rails and feeder, at one place or several."""

    line: Name | None = name_of_line()
    positions_km: Annotated[tuple[Position, ...], Field(min_length=1), ascending("position")] = (
        Field(description="Where they stand, in ascending order.")
    )
    rated_mva: Real = Field(gt=0, le=1_000, description="Rated power of one.")
    short_circuit_percent: Real = Field(
        gt=0,
        le=50,
        description="Short-circuit voltage on `rated_mva`, at half of the whole voltage, the whole "
        "winding short-circuited.",
    )
    load_loss_kw: Real = Field(default=0.0, ge=0, le=10_000, description="Losses at rated power.")
    no_load_loss_kw: Real = Field(default=0.0, ge=0, le=10_000, description="Losses without load.")
    no_load_current_percent: Real = Field(
        default=0.0, ge=0, le=50, description="Magnetising current, of the rated one."
    )

    @model_validator(mode="after")
    def _losses_fit(self) -> Self:
        if self.load_loss_kw > 10.0 * self.rated_mva * self.short_circuit_percent:
            raise fault(
                f"load_loss_kw ({self.load_loss_kw:g} kW) needs more than the whole impedance of "
                f"short_circuit_percent ({self.short_circuit_percent:g} %)",
                "lower load_loss_kw, or raise short_circuit_percent",
            )
        if self.no_load_loss_kw > 10.0 * self.rated_mva * self.no_load_current_percent:
            raise fault(
                f"no_load_loss_kw ({self.no_load_loss_kw:g} kW) needs more than the whole current of "
                f"no_load_current_percent ({self.no_load_current_percent:g} %)",
                "lower no_load_loss_kw, or raise no_load_current_percent",
            )
        return self

    def leakage_ohm(self, half_v: float) -> complex:
        """Leakage impedance of one half of the winding, at half of the whole voltage [V]. [Ω]

        Short-circuited over both halves, half of it is seen from one.
        """
        per_va = 2.0 * half_v**2 / (self.rated_mva * 1e6)
        z_pu, r_pu = self.short_circuit_percent / 100.0, self.load_loss_kw / 1e3 / self.rated_mva
        return complex(r_pu, (z_pu**2 - r_pu**2) ** 0.5) * per_va

    def magnetising_s(self, half_v: float) -> complex:
        """Magnetising admittance over the whole winding. [S]"""
        per_va = self.rated_mva * 1e6 / (2.0 * half_v) ** 2
        y_pu = self.no_load_current_percent / 100.0
        g_pu = self.no_load_loss_kw / 1e3 / self.rated_mva
        return complex(g_pu, -((y_pu**2 - g_pu**2) ** 0.5)) * per_va
