"""Rails and feeders beside the contact line: their nodes and sections, and what ties them to stations.

At each place with nodes of the contact line there is one of the rails, and one of the feeder, of all
tracks: rails are joined there.  A station stands between contact line and rails: its source has a node
of its own, whose voltage a link of next to no resistance puts between them.
"""

from collections.abc import Iterator, Sequence
from typing import NamedTuple

from tpss.model.contact_line import LineLayout, Stretch, stretches_of
from tpss.model.line_matrices import CONTACT, FEEDER, RAILS, Described, matrices_of
from tpss.model.supply_plan import FEEDER_KIND, RAILS_KIND, SupplyPlan
from tpss.powerflow.assembly import SectionPart
from tpss.powerflow.bundles import EARTH, BundlePart
from tpss.powerflow.links import LinkPart
from tpss.scenario.supply import Autotransformers, Station, Supply, TransformerStation
from tpss.units import kilometres, si

TERMINALS = "station"
KIND_OF = {RAILS: RAILS_KIND, FEEDER: FEEDER_KIND}
AUTOTRANSFORMER, MAGNETISING = "autotransformer", "autotransformer, magnetising"
STATION_WINDING, EARTHING = "station winding", "earthing"

INNER_OHM_PER_V2 = 2e-12
"""Resistance of the link between a station's node and its terminals, over the square of the nominal
voltage; the law of the source is that at its terminals. [Ω/V²]"""


def autotransformers_of(
    supply: Supply, line: LineLayout
) -> Iterator[tuple[float, Autotransformers]]:
    """Places of autotransformers on a line [km], and what stands there."""
    for each in supply.autotransformers:
        if line.holds(each.line):
            yield from ((km, each) for km in each.positions_km)


class _Places:
    """Nodes of rails and feeders by place; one for all lines that meet there."""

    def __init__(self, plan: SupplyPlan, lines: Sequence[LineLayout]) -> None:
        self.plan, self.lines = plan, lines
        self.meet = {(line.number, km): name for line in lines for km, name in line.junctions}
        self.found: dict[tuple[str, object], int] = {}

    def beside(self, node: int, kind: str) -> int:
        """Node of a kind of conductor beside one of the contact line."""
        line, km = self.plan.node_line[node], self.plan.node_km[node]
        key = kind, self.meet.get((line, km), (line, km))
        if key not in self.found:
            self.found[key] = self.plan.add_node(KIND_OF[kind], self.lines[line], km)
        if kind == RAILS:
            self.plan.rails_beside[node] = self.found[key]
        return self.found[key]


class _Piece(NamedTuple):
    """Sections of the contact lines side by side, and the stretch of which they are a piece."""

    sections: tuple[int, ...]
    stretch: Stretch
    line: LineLayout


def add_conductors(plan: SupplyPlan, supply: Supply, lines: Sequence[LineLayout]) -> None:
    """Add rails and feeders to a plan of the contact line and its stations."""
    if supply.conductors is None:
        return
    places = _Places(plan, lines)
    leakage_s_per_m = si(supply.conductors, "leakage_s_per_km")
    for piece in list(_pieces(plan, supply, lines)):
        _add_bundle(piece, matrices_of(piece.stretch, leakage_s_per_m), places)
    _return_by_rails(places)
    for k, station in enumerate(supply.stations):
        _add_station(k, station, supply, places)
    for line in lines:
        for km, each in autotransformers_of(supply, line):
            _add_autotransformer(km, line, each, supply, places)


def _pieces(plan: SupplyPlan, supply: Supply, lines: Sequence[LineLayout]) -> Iterator[_Piece]:
    """Pieces of all lines."""
    for line in lines:
        stretches = stretches_of(line, supply)
        for run in plan.runs[line.number]:
            for sections in zip(*(range(*bounds) for bounds in run.sections), strict=True):
                section = plan.sections[sections[0]]
                middle_km = (section.start_m + section.end_m) / 2e3
                stretch = next(s for s in stretches if s.begin_km <= middle_km < s.end_km)
                yield _Piece(sections, stretch, line)


def _add_bundle(piece: _Piece, described: Described, places: _Places) -> None:
    """Add the sections of rails and feeders of a piece, and the bundle of all its conductors."""
    plan, sections = places.plan, []
    for kind, track, z in zip(
        described.kinds, described.tracks, described.impedance_ohm_per_m.diagonal(), strict=True
    ):
        contact = plan.sections[piece.sections[track]]
        if kind == CONTACT:
            sections.append(piece.sections[track])
            continue
        start, end = (places.beside(n, kind) for n in (contact.start_node, contact.end_node))
        sections.append(len(plan.sections))
        part = SectionPart(start, end, contact.start_m, contact.end_m, complex(z), 0.0)
        plan.sections.append(part)
        where = f"{kilometres(contact.start_m / 1e3)}-{kilometres(contact.end_m / 1e3)} km"
        of_track = f", track {track + 1}" if max(described.tracks) > 0 else ""
        plan.section_names.append(f"{KIND_OF[kind]} {piece.line.prefix}{where}{of_track}")
        plan.section_kinds.append(KIND_OF[kind])
    returns = [
        described.tracks.index(track)
        + described.kinds[described.tracks.index(track) :].index(RAILS)
        if kind == CONTACT
        else EARTH
        for kind, track in zip(described.kinds, described.tracks, strict=True)
    ]
    plan.bundles.append(
        BundlePart(
            tuple(sections),
            tuple(returns),
            described.impedance_ohm_per_m,
            described.admittance_s_per_m,
        )
    )


def _return_by_rails(places: _Places) -> None:
    """Let the current of what is linked to the contact line return by the rails."""
    plan = places.plan
    on_line = {n for n, kind in enumerate(plan.node_kinds) if kind in plan.kinds_of_contact_line}
    for k, link in enumerate(plan.links):
        for node, weight in zip(link.nodes, link.weights, strict=True):
            if node in on_line:
                rails = places.beside(node, RAILS)
                plan.links[k] = LinkPart(
                    (*plan.links[k].nodes, rails), (*plan.links[k].weights, -weight),
                    link.impedance_ohm,
                )  # fmt: skip


def _add_station(k: int, station: Station, supply: Supply, places: _Places) -> None:
    """Put the source of a station between contact line and rails, and earth its return conductor."""
    plan, contact = places.plan, places.plan.sources[k]
    line, km = places.lines[plan.node_line[contact]], plan.node_km[contact]
    rails = places.beside(contact, RAILS)
    if station.rail_earthing_ohm is not None:
        plan.add_link(EARTHING, station.name, (rails,), (1.0,), complex(station.rail_earthing_ohm))
    if plan.node_kinds[contact] not in plan.kinds_of_contact_line:
        return
    terminals = plan.add_node(TERMINALS, line, km)
    plan.sources[k] = terminals
    if isinstance(station, TransformerStation) and station.secondary == "2x":
        feeder = places.beside(contact, FEEDER)
        half = 2.0 * half_impedance_ohm(station)
        named, first = (STATION_WINDING, station.name), len(plan.links)
        plan.station_links[k] = [first, first + 1]
        plan.add_link(*named, (contact, feeder, rails), (1.0, 1.0, -2.0), half)
        plan.add_link(*named, (contact, feeder, terminals), (1.0, -1.0, -2.0), half)
        plan.inner_ohm.append(0.0)
        return
    inner_ohm = INNER_OHM_PER_V2 * (si(supply.system_values, "nominal_kv")) ** 2
    nodes = (contact, rails, terminals)
    plan.add_link(TERMINALS, station.name, nodes, (1.0, -1.0, -1.0), complex(inner_ohm))
    plan.inner_ohm.append(inner_ohm)


def half_impedance_ohm(station: TransformerStation) -> complex:
    """Impedance of one half of a secondary of two windings, of all transformers of a station. [Ω]"""
    unit = station.transformer
    base_ohm = si(station, "no_load_voltage_kv") ** 2 / si(unit, "rated_mva")
    z_pu = complex(unit.r_pu, (unit.z_pu**2 - unit.r_pu**2) ** 0.5)
    return 2.0 * station.share_in_halves * z_pu * base_ohm / station.transformers


def _add_autotransformer(
    km: float, line: LineLayout, each: Autotransformers, supply: Supply, places: _Places
) -> None:
    """Add an autotransformer: its leakage, and what magnetises it."""
    plan = places.plan
    contact = plan.contact_node(line, km)
    rails, feeder = (places.beside(contact, kind) for kind in (RAILS, FEEDER))
    half_v = half_voltage_v(supply)
    name, first = f"{line.prefix}{kilometres(km)} km", len(plan.links)
    nodes, leakage_ohm = (contact, rails, feeder), 2.0 * each.leakage_ohm(half_v)
    plan.add_link(AUTOTRANSFORMER, name, nodes, (1.0, -2.0, 1.0), leakage_ohm)
    magnetising_s = each.magnetising_s(half_v)
    if magnetising_s != 0.0:
        plan.add_link(MAGNETISING, name, (contact, feeder), (1.0, -1.0), 1.0 / magnetising_s)
    plan.autotransformer_links[line.name, km] = list(range(first, len(plan.links)))


def half_voltage_v(supply: Supply) -> float:
    """Voltage of a half of autotransformers: that of the stations without load, or nominal. [V]"""
    halved = [
        si(station, "no_load_voltage_kv")
        for station in supply.transformer_stations
        if station.secondary == "2x"
    ]
    return max(halved, default=si(supply.system_values, "nominal_kv"))
