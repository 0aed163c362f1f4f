"""The command ``tpss check``: what a scenario describes, without simulating it."""

import textwrap
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

from rich.markup import escape
from rich.table import Table

from tpss import library, units
from tpss.cli.library import KINDS
from tpss.cli.notes import notes, stuck
from tpss.cli.terminal import Console, say
from tpss.model.build import build_model
from tpss.model.outages import service_of
from tpss.model.start import given_steps
from tpss.model.traffic import build_services
from tpss.run.clocks import clock_of
from tpss.run.start import demand_room_to_depart
from tpss.scenario import Scenario, load_scenario
from tpss.scenario.clock import clock_at
from tpss.scenario.direct_current import without_reactive_power
from tpss.scenario.fields import Part, library_name
from tpss.scenario.line import Line, SpeedLimit
from tpss.scenario.of_the_system import under_its_system
from tpss.scenario.open_step import with_step
from tpss.scenario.override import parse_assignment
from tpss.scenario.rolling_stock import Train
from tpss.scenario.signalling import Signalling
from tpss.scenario.simulation import Simulation
from tpss.scenario.standards import Standards
from tpss.scenario.supply import Catenary, HighVoltageLine, Post, SectionBreak, Supply
from tpss.scenario.supply.transformers import transformer_positions_km
from tpss.scenario.traffic import Stop, Traffic
from tpss.units import kilometres, on_line

MOST_LISTED = 8
"""Longer lists are shown by their first and last item and their length."""


SPARE_TIME = {
    "held-speed": "a lower held speed",
    "coasting": "coasting before stops",
    "least-energy": "coasting and a held speed, at the least energy",
}
"""How trains use it, in words."""


def check_scenario(file: Path, assignments: list[str]) -> None:
    """Validate a scenario, build its model, and print what it describes.

    Raises
    ------
    ScenarioError
        It has faults; all are listed.
    TooLargeError
        Its run would not fit into memory.
    """
    scenario = load_scenario(file, dict(parse_assignment(text) for text in assignments))
    model, _ = build_model(with_step(scenario))
    demand_room_to_depart(model, build_services(scenario, model), given_steps(scenario, model))
    clock_of(scenario.simulation.load_flow, scenario.given_source)
    for outage in scenario.outages:
        service_of(scenario, outage)
    for name in scenario.variants:
        varied = with_step(scenario.variant(name))
        build_services(varied, build_model(varied)[0])
    console = Console()
    title = f"[bold]{scenario.name}[/bold]  {escape(scenario.description)}\n"
    console.print(title, highlight=False)
    rows = Table.grid(padding=(0, 2))
    rows.add_column(no_wrap=True)
    rows.add_column(overflow="fold")
    for heading, text in summary(scenario):
        rows.add_row(f"[dim]{heading}[/dim]", escape(text))
    console.print(rows)
    for note in (*scenario.file_notes, *notes(scenario), *stuck(scenario, model)):
        console.print(f"\n[yellow]Note:[/yellow] {escape(note)}", highlight=False)
    say(console, f"\nNo faults in {file}")


def summary(scenario: Scenario) -> Iterator[tuple[str, str]]:
    """Headings and texts that describe a scenario."""
    several = len(scenario.lines_by_name) > 1
    for name, line in scenario.lines_by_name.items():
        yield from _line(line, f"{name}: " if several else "")
    yield from _supply(scenario.supply)
    for name, train in scenario.trains.items():
        yield "train", f"{name}: {_train(train, scenario.supply.system)}"
    for text in _traffic(scenario.traffic, scenario.simulation.start_s):
        yield "traffic", text
    if scenario.signalling.separation != "none":
        yield "signalling", _signalling(scenario.signalling)
    yield "standards", _standards(scenario.standards)
    yield "simulation", _simulation(scenario.simulation, scenario.traffic[0])
    for outage in scenario.outages:
        yield "outage", f"{outage.name}: {outage.in_words}"
    for name, variant in scenario.variants.items():
        yield "variant", f"{name}: {variant.description or 'changes ' + ', '.join(variant.paths)}"


def _line(line: Line, name: str) -> Iterator[tuple[str, str]]:
    yield "line", f"{name}{line.in_words}"
    yield "stations", _listed([f"{s.name} {kilometres(s.position_km)} km" for s in line.stations])
    if line.most_tracks > 1:
        counts = [f"{int(n)} from {kilometres(km)} km" for km, _, n in line.tracks_by_stretch]
        yield "tracks", _listed(counts)
    pieces = line.gradients_between(line.begins_at_km, line.end_km)
    lowest, highest = min(p for _, _, p in pieces), max(p for _, _, p in pieces)
    climb_m = sum((end - start) * permille for start, end, permille in pieces)
    spread = f"{lowest:g} ‰" if lowest == highest else f"{lowest:g} to {highest:g} ‰"
    yield "gradients", f"{spread}; from beginning to end {climb_m:+.0f} m"
    yield "speed limits", _limits(line.speed_limits)
    if line.speed_limits_down:
        yield "... down", _limits(line.speed_limits_down)


def _limits(limits: Sequence[SpeedLimit]) -> str:
    return _listed(
        [f"{each.speed_kmh:g} km/h from {kilometres(each.from_km)} km" for each in limits]
    )


def _listed(texts: list[str]) -> str:
    """Texts in a row, or the first and the last of many."""
    if len(texts) > MOST_LISTED:
        return f"{texts[0]} ... {texts[-1]}, {len(texts)} in all"
    return ", ".join(texts)


def _supply(supply: Supply) -> Iterator[tuple[str, str]]:
    frequency = "" if supply.is_direct else f", {supply.frequency_hz:g} Hz"
    yield "system", f"{supply.system}{frequency}"
    catenary = supply.catenary
    reactance = "" if supply.is_direct else f" + j{catenary.x_ohm_per_km:g}"
    impedance = f"{catenary.r_ohm_per_km:g}{reactance} Ω/km"
    yield "catenary", f"{_conductors(catenary)}: {impedance}"
    yield "high voltage", _high_voltage(supply, supply.high_voltage_line)
    for station in supply.stations:
        place = on_line(station.line or "", f"{kilometres(station.position_km)} km")
        yield "feeding", f"{station.name} {place}: {station.in_words}"
    if (conductors := supply.conductors) is not None:
        leakage = f"{conductors.leakage_s_per_km:g} S/km from the rails of a track to earth"
        yield "conductors", f"{leakage}, nodes every {conductors.nodes_every_km:g} km at most"
    for each in supply.autotransformers:
        places = ", ".join(kilometres(km) for km in each.positions_km)
        where = on_line(each.line or "", f"{places} km")
        yield "autotransf.", f"{where}: {each.rated_mva:g} MVA, {each.short_circuit_percent:g} %"
    for store in supply.storage:
        place = on_line(store.line or "", f"{kilometres(store.position_km)} km")
        yield "storage", f"{store.name} {place}: {store.in_words}"
    for stretch in supply.without_contact_line:
        yield "no line", stretch.in_words
    if supply.tracks_tied is not None:
        yield "tracks tied", supply.tracks_tied
    for kind, switches in (("posts", supply.posts), ("breaks", supply.section_breaks)):
        if switches:
            yield kind, _listed([_switch(each) for each in switches])
    for section in supply.neutral_sections:
        yield "neutral", section.in_words


def _conductors(catenary: Catenary) -> str:
    """Library names of a contact line: of the whole, or of its conductors, worn and warm."""
    if catenary.contact_line is None or catenary.rails is None:
        return library_name("catenaries", catenary)
    state = {
        "worn by {:g} %": catenary.wear_percent,
        "at {:g} °C": catenary.conductor_temperature_c,
        "rails at {:g} °C": catenary.rails_temperature_c,
    }
    names = (
        library_name("contact_lines", catenary.contact_line),
        f"rails {library_name('rails', catenary.rails)}",
    )
    told = (words.format(value) for words, value in state.items() if value is not None)
    return ", ".join((*names, *told))


def _switch(switch: Post | SectionBreak) -> str:
    place = on_line(switch.line or "", f"{kilometres(switch.position_km)} km")
    return f"{switch.name} {place}{'' if switch.closed else ' (open)'}"


def _signalling(signalling: Signalling) -> str:
    blocks = f" of {signalling.block_m:g} m" if signalling.block_m else ""
    return f"{signalling.separation}{blocks}; single tracks: {signalling.single_track}"


def _high_voltage(supply: Supply, line: HighVoltageLine | None) -> str:
    if line is None:
        return "none"
    positions = [f"{kilometres(km)} km" for km in transformer_positions_km(supply)]
    between = library_name("transformers", line.line_transformer)
    at_stations = library_name("transformers", line.station_transformer)
    placed = f"{between} at {_listed(positions)}" if positions else "none between stations"
    conductors = library_name("high_voltage_lines", line.type)
    return (
        f"{conductors}, {line.base_kv:g} kV; transformers: {placed}, {at_stations} at the stations"
    )


def _standards(standards: Standards) -> str:
    limits = standards.voltage_limits
    texts = [
        f"{limits.system}: {limits.umin1_kv:g} to {limits.umax1_kv:g} kV, for a limited time "
        f"{limits.umin2_kv:g} to {limits.umax2_kv:g} kV",
        *_changed(limits, library.entries("voltage_limits").get(limits.system, {})),
    ]
    if standards.peak_from_min or standards.peak_to_min is not None:
        end = "the end" if standards.peak_to_min is None else f"{standards.peak_to_min:g} min"
        texts.append(f"peak window {standards.peak_from_min:g} min to {end}")
    if standards.zones:
        texts.append(f"zones {_listed([zone.name for zone in standards.zones])}")
    return "; ".join(texts)


def _changed(part: Part, usual: Mapping[str, Any]) -> list[str]:
    """What a part changes in the values of the library entry that it starts from, if anything."""
    changed = [
        f"{key} {_plain(getattr(part, key))} ({_plain(usual[key])})"
        for key in type(part).model_fields
        if key in usual and getattr(part, key) != usual[key]
    ]
    return [f"changed from the library: {', '.join(changed)}"] if changed else []


def _train(train: Train, system: str) -> str:
    key_data = [
        f"{units.words(key)} {getattr(train, key):g} {units.label(key)}"
        for key in KINDS["locomotives"].shown
        if getattr(train, key) is not None
    ]
    text = f"{train.model or 'own'}, {', '.join(key_data)}"
    return "; ".join([text, *_changed(train, _of_model(train.model, system))])


def _of_model(name: str | None, system: str) -> dict[str, Any]:
    """Values of a model as it is under a system, by the keys that the library gives it."""
    if name not in library.entries("locomotives"):
        return {}
    document = {"supply": {"system": system}, "trains": {"it": {"model": name}}}
    under = without_reactive_power(under_its_system(document))["trains"]["it"]
    model = Train.model_validate(under)
    keys = {*library.entries("locomotives")[name], *under} & {*Train.model_fields}
    return {key: getattr(model, key) for key in keys}


def _plain(value: Any) -> str:
    if value is None:
        return "none"
    return f"{value:g}" if isinstance(value, float) else textwrap.shorten(str(value), 40)


def _traffic(traffic: Sequence[Traffic], start_s: float | None) -> Iterator[str]:
    """Each service; of many single trains, as of a timetable, what they have in common."""
    single = [entry for entry in traffic if entry.departure_min is not None]
    for entry in traffic:
        if entry.departure_min is None or len(single) <= MOST_LISTED:
            yield _service(entry, start_s)
    if len(single) > MOST_LISTED:
        minutes = [entry.departure_min for entry in single if entry.departure_min is not None]
        ends = " to ".join(_moment(minute, start_s) for minute in (min(minutes), max(minutes)))
        calls = sum(len(entry.stops) for entry in single)
        yield f"{_listed([entry.name for entry in single])}: from {ends}, with {calls} stops"


def _moment(minute: float, start_s: float | None) -> str:
    clock = "" if start_s is None else f" ({clock_at(minute, start_s)})"
    return f"{minute:g} min{clock}"


def _service(entry: Traffic, start_s: float | None) -> str:
    texts = [f"{entry.name}: {entry.train} from {entry.origin} to {entry.destination}"]
    if entry.via:
        texts.append(f"over {_listed(list(entry.via))}")
    if tracks := _tracks(entry):
        texts.append(_listed(tracks))
    if (listed := entry.listed_departures_min) is not None:
        texts.append(f"at {_listed([_moment(minute, start_s) for minute in listed])}")
    else:
        first = _moment(entry.first_departure_min, start_s)
        texts.append(f"every {entry.headway_min:g} min from {first}")
    if entry.already_running:
        texts.append("already running at the start")
    if entry.initial_trains:
        texts.append(f"trains on the line at the start: {len(entry.initial_trains)}")
    if entry.has_supplement:
        keys = ("supplement_percent", "supplement_min_per_100km")
        given = {key: getattr(entry, key) for key in keys if getattr(entry, key) > 0.0}
        shares = [f"{value:g} {units.label(key)}" for key, value in given.items()]
        texts.append(f"supplement {' and '.join(shares)}")
    if entry.spare_time is not None:
        texts.append(f"spare time by {SPARE_TIME[entry.spare_time]}")
    if entry.delays is not None:
        share, mean_min = 100.0 * entry.delays.share, entry.delays.mean_min
        texts.append(f"{share:g} % delayed by {mean_min:g} min on average")
    if entry.stops:
        stops = [_stop(stop) for stop in entry.stops]
        texts.append(f"stops: {_listed(stops)}")
    if entry.passes and not entry.via:
        texts.append(f"passes {_listed([each.station for each in entry.passes])}")
    return ", ".join(texts)


def _tracks(entry: Traffic) -> list[str]:
    """Tracks that a service gives, and from where on its trains run there."""
    calls = [(entry.origin, entry.track)]
    calls += [(stop.station, stop.track) for stop in entry.stops]
    calls += [(each.station, each.track) for each in entry.passes]
    return [f"on track {track} from {station}" for station, track in calls if track is not None]


def _stop(stop: Stop) -> str:
    text = f"{stop.station} {stop.dwell_min:g} min"
    if stop.depart_after_min is None:
        return text
    return f"{text}, not before {stop.depart_after_min:g} min under way"


def _simulation(simulation: Simulation, first: Traffic) -> str:
    step, duration = simulation.time_step_min, simulation.duration_min
    steps = "steps of a length to be chosen" if step is None else f"steps of {step:g} min"
    studied = first.name if first.departure_min is not None else f"{first.name} 1"
    end = f"until {studied} arrives" if duration is None else f"for {duration:g} min"
    if simulation.starts_at is not None:
        end += f" from {simulation.starts_at}"
    choices = [
        f"{key} {getattr(simulation, key)}"
        for key, field in Simulation.model_fields.items()
        if isinstance(field.default, str) and getattr(simulation, key) != field.default
    ]
    return ", ".join([f"{steps} {end}", *choices])
