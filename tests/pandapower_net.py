"""A recorded step as a pandapower net: the network read and solved by other software than ours.

The net is laid out from the scenario's own tables in their own units (km, ohm per km, nF per km),
without `tpss.model` and `tpss.powerflow`, after [Boullanger2009]_, figure 2-4 and appendix A.2.  The
high-voltage line keeps its own voltage, with real transformers; a transformer between the stations of
an AT system has a bus between it and its connection impedance.  From the result come the trains
(position, P and Q) and, in place of each converter station's law, voltage and angle at its node.  A
transformer station is laid out whole: an ideal source behind its impedances.

A single-phase network (U, P) equals a balanced three-phase one with U between its phases, P in all
three together, and the same ohms.
"""

import cmath
import math
from itertools import pairwise

import numpy as np
import pandapower as pp
import pandas as pd
import xarray as xr

import tpss
from tpss.scenario.supply import Catenary, Supply, TransformerStation

BASE_MVA = 10.0
SHORTEST_KM = 1e-3  # trains closer than a metre to each other or to a node count as a metre away

LINE_KV = {"15kV-16.7Hz": 16.5, "25kV-50Hz": 27.5}
"""Base voltages of the systems, to which our per-unit values refer."""

Net = pp.auxiliary.pandapowerNet
Buses = dict[float, int]  # by position in km


def solve_with_pandapower(scenario: tpss.Scenario, moment: xr.Dataset) -> Net:
    """Net of one instant of a result's dataset, solved from a flat start."""
    net = pp.create_empty_network(f_hz=scenario.supply.frequency_hz, sn_mva=BASE_MVA)
    stations_km = [station.position_km for station in scenario.supply.stations]
    transformers_km = positions_of_transformers(scenario.supply)
    # A node at every feeding point and at the line's ends; a feeder's bus may lie behind it.
    points_km = sorted({0.0, scenario.line.length_km, *stations_km, *transformers_km})
    line_kv = LINE_KV[scenario.supply.system]
    contact = {km: add_bus(net, "contact line", km, line_kv) for km in points_km}
    lay_islands(net, scenario.supply, contact, add_trains(net, moment, line_kv))
    feeding = {km: behind_connection(net, scenario.supply, contact, km) for km in stations_km}
    if scenario.supply.high_voltage_line is not None:
        lay_high_voltage_line(net, scenario.supply, contact, feeding, transformers_km)
    add_sources(net, scenario.supply, feeding, moment)
    # 1 mVA, just above what the rounding at pieces of one metre of line may leave.
    pp.runpp(net, init="flat", calculate_voltage_angles=True, tolerance_mva=1e-9, numba=False)
    return net


def solve_network_with_pandapower(scenario: tpss.Scenario, moment: xr.Dataset) -> Net:
    """The same of a network of lines without high-voltage line, of one or two tracks tied at posts."""
    net = pp.create_empty_network(f_hz=scenario.supply.frequency_hz, sn_mva=BASE_MVA)
    supply, line_kv = scenario.supply, LINE_KV[scenario.supply.system]
    meeting: dict[str, int] = {}
    feeding: Buses = {}
    for number, (name, line) in enumerate(scenario.lines.items()):
        others = [each.stations for key, each in scenario.lines.items() if key != name]
        shared = {
            station.position_km: station.name
            for station in line.stations
            if any(station.name == each.name for stations in others for each in stations)
        }
        fed = [station.position_km for station in supply.stations if station.line == name]
        posts = [post.position_km for post in supply.posts if post.line == name and post.closed]
        contact: Buses = {}
        for km in sorted({*shared, *fed, *posts}):
            known = meeting.get(shared.get(km, ""))
            contact[km] = add_line_bus(net, name, km, line_kv) if known is None else known
            if km in shared:
                meeting[shared[km]] = contact[km]
        own = [each.catenary for each in supply.contact_lines if each.line == name]
        catenary = own[0] if own else supply.catenary
        for track in range(1, line.tracks + 1):
            words = f", track {track}" if line.tracks > 1 else ""
            ends = {
                km: add_line_bus(net, name, km, line_kv, words)
                for km in (line.begins_at_km, line.end_km)
                if km not in contact
            }
            here = (moment.train_line == number) & (moment.get("train_track", 1) == track)
            trains = add_trains(net, moment.where(here), line_kv)
            lay_contact_line(net, catenary, dict(sorted({**contact, **ends}.items())), trains)
        connection = complex(catenary.connection_r_ohm, catenary.connection_x_ohm)
        for km in fed:
            feeding[km] = contact[km]
            if connection:
                feeder = f"AT feeder at {name} {km:g} km"
                feeding[km] = int(pp.create_bus(net, vn_kv=line_kv, name=feeder))
                add_impedance(net, feeding[km], contact[km], connection)
    add_sources(net, supply, feeding, moment)
    pp.runpp(net, init="flat", calculate_voltage_angles=True, tolerance_mva=1e-9, numba=False)
    return net


def add_line_bus(net: Net, line: str, km: float, kv: float, words: str = "") -> int:
    return int(pp.create_bus(net, vn_kv=kv, name=f"contact line at {line} {km:g} km{words}"))


def positions_of_transformers(supply: Supply) -> list[float]:
    """Transformers between stations: as listed, or as many between neighbouring stations."""
    line = supply.high_voltage_line
    if line is None or line.transformers_km is not None:
        return list(line.transformers_km) if line else []
    stations = sorted(station.position_km for station in supply.converter_stations)
    inner = [np.linspace(a, b, line.transformers + 2)[1:-1] for a, b in pairwise(stations)]
    return list(np.concatenate(inner))


def add_bus(net: Net, name: str, km: float, kv: float) -> int:
    return int(pp.create_bus(net, vn_kv=kv, name=f"{name} at {km:g} km"))


def add_trains(net: Net, moment: xr.Dataset, line_kv: float) -> list[tuple[float, int]]:
    """A bus with a load for each train on the line; gives their positions [km] and buses."""
    trains = moment.where(np.isfinite(moment.active_power), drop=True)
    buses = pp.create_buses(net, trains.train.size, vn_kv=line_kv, name=trains.train.values)
    megawatt, megavar = trains.active_power.values / 1e6, trains.reactive_power.values / 1e6
    pp.create_loads(net, buses, p_mw=megawatt, q_mvar=megavar)
    return list(zip(trains.position.values / 1e3, buses, strict=True))


def lay_islands(net: Net, supply: Supply, contact: Buses, trains: list[tuple[float, int]]) -> None:
    """The contact line between neutral sections, each of which parts it in its middle.

    Every island counts its angles from its own sources, as each has a slack of its own.
    """
    line_kv, begin_km, beginning = LINE_KV[supply.system], -math.inf, dict[float, int]()
    for km in [*(each.middle_km for each in supply.neutral_sections), math.inf]:
        own = {at: bus for at, bus in contact.items() if begin_km < at < km}
        ending: Buses = {}
        following: Buses = {}
        if km < math.inf:
            for buses, side in ((ending, "before"), (following, "behind")):
                name = f"contact line at {km:g} km, {side} neutral section"
                buses[km] = int(pp.create_bus(net, vn_kv=line_kv, name=name))
        under = [(at, bus) for at, bus in trains if begin_km <= at < km]
        lay_contact_line(net, supply.catenary, {**beginning, **own, **ending}, under)
        begin_km, beginning = km, following


def lay_contact_line(
    net: Net, catenary: Catenary, contact: Buses, trains: list[tuple[float, int]]
) -> None:
    """A line between neighbours, half of its capacitance at either end, of one metre at least.

    A train at a node stands behind it, except at the end of the line.
    """
    *nodes, end = contact.items()
    places = [*sorted([*nodes, *trains], key=lambda place: place[0]), end]
    positions_km, buses = zip(*places, strict=True)
    pp.create_lines_from_parameters(
        net, buses[:-1], buses[1:], np.maximum(SHORTEST_KM, np.diff(positions_km)),
        r_ohm_per_km=catenary.r_ohm_per_km, x_ohm_per_km=catenary.x_ohm_per_km,
        c_nf_per_km=catenary.capacitance_nf_per_km, max_i_ka=1.0,
    )  # fmt: skip


def add_impedance(net: Net, start: int, end: int, ohm: complex, length: float = 1.0) -> None:
    """A lumped impedance, or `length` times an impedance per kilometre."""
    pp.create_line_from_parameters(
        net, start, end, length_km=length, r_ohm_per_km=ohm.real, x_ohm_per_km=ohm.imag,
        c_nf_per_km=0.0, max_i_ka=1.0,
    )  # fmt: skip


def behind_connection(net: Net, supply: Supply, contact: Buses, km: float) -> int:
    """A new bus behind a connection impedance to the contact line (AT), or the line's own (BT)."""
    connection = complex(supply.catenary.connection_r_ohm, supply.catenary.connection_x_ohm)
    if not connection:
        return contact[km]
    bus = add_bus(net, "AT feeder", km, LINE_KV[supply.system])
    add_impedance(net, bus, contact[km], connection)
    return bus


def lay_high_voltage_line(
    net: Net, supply: Supply, contact: Buses, feeding: Buses, transformers_km: list[float]
) -> None:
    """The line at its own voltage; 25 MVA units at the converter stations, 16 MVA units between."""
    line = supply.high_voltage_line
    points_km = sorted([*feeding, *transformers_km])
    high = {km: add_bus(net, "high-voltage line", km, line.base_kv) for km in points_km}
    for a, b in pairwise(points_km):
        per_km = complex(line.type.r_ohm_per_km, line.type.x_ohm_per_km)
        add_impedance(net, high[a], high[b], per_km, length=b - a)
    for km in points_km:
        at_station = km in feeding
        unit = line.station_transformer if at_station else line.line_transformer
        low = feeding[km] if at_station else behind_connection(net, supply, contact, km)
        # Short-circuit voltages in percent of a unit of BASE_MVA, whose ohms are the same.
        line_kv = LINE_KV[supply.system]
        percent = 100.0 * BASE_MVA / line_kv**2
        pp.create_transformer_from_parameters(
            net, high[km], low, sn_mva=BASE_MVA, vn_hv_kv=line.base_kv, vn_lv_kv=line_kv,
            vkr_percent=percent * unit.r_ohm, vk_percent=percent * math.hypot(unit.r_ohm, unit.x_ohm),
            pfe_kw=0.0, i0_percent=0.0,
        )  # fmt: skip


def add_sources(net: Net, supply: Supply, feeding: Buses, moment: xr.Dataset) -> None:
    """An ideal source in place of each converter station, or behind a transformer station."""
    line_kv = LINE_KV[supply.system]
    for station in supply.transformer_stations:
        behind = add_bus(net, f"grid of {station.name}", station.position_km, line_kv)
        add_impedance(net, behind, feeding[station.position_km], station_ohm(station))
        net.line.loc[net.line.index[-1], "name"] = station.name
        pp.create_ext_grid(net, behind, vm_pu=station.no_load_voltage_kv / line_kv, va_degree=0.0)
    for station in supply.converter_stations:
        bus = feeding[station.position_km]
        node = moment.sel(node=net.bus.name[bus])
        pp.create_ext_grid(
            net, bus, name=station.name,
            vm_pu=float(node.node_voltage) / (1e3 * line_kv),
            va_degree=math.degrees(node.node_angle),
        )  # fmt: skip


def station_ohm(station: TransformerStation) -> complex:
    """Both phases of the grid, 2 E²/S_k, and the transformers in parallel. [Ω]"""
    unit, kv = station.transformer, station.no_load_voltage_kv
    z_ohm = unit.short_circuit_percent / 100.0 * kv**2 / unit.rated_mva
    r_ohm = unit.load_loss_kw / 1e3 * kv**2 / unit.rated_mva**2
    ohm = complex(r_ohm, math.sqrt(z_ohm**2 - r_ohm**2)) / station.transformers
    if station.grid_short_circuit_mva is not None:
        angle = math.atan2(1.0, station.grid_r_over_x)
        ohm += 2.0 * kv**2 / station.grid_short_circuit_mva * cmath.exp(1j * angle)
    return ohm


def worst_differences(net: Net, moment: xr.Dataset) -> dict[str, float]:
    """Largest differences between a solved net and the recorded instant it was built from.

    Returns
    -------
    dict
        Of the voltages of all pantographs and nodes [p.u. of their own base] and their angles [rad],
        and of the stations' active and reactive powers [p.u. of `BASE_MVA`].
    """
    found = net.bus[["name", "vn_kv"]].join(net.res_bus).set_index("name")
    feeding = net.ext_grid[["name"]].join(net.res_ext_grid).dropna(subset="name").set_index("name")
    stations = (
        net.line[["name"]].join(-net.res_line[["p_to_mw", "q_to_mvar"]]).dropna(subset="name")
    )
    stations = stations.set_axis(["name", "p_mw", "q_mvar"], axis=1).set_index("name")
    feeding = pd.concat([feeding, stations])
    volts, angles = (
        pd.concat([moment[f"{at}_{what}"].to_series().dropna() for at in ("pantograph", "node")])
        for what in ("voltage", "angle")
    )
    seen = volts > 0.0  # that of a train all through a neutral section is recorded as none
    volts, angles = volts[seen], angles[seen]
    found = found.loc[volts.index]
    differences = {
        "voltage": volts / (1e3 * found.vn_kv) - found.vm_pu,
        "angle": angles - np.radians(found.va_degree),
        "P": moment.station_active_power.to_series() / (1e6 * BASE_MVA) - feeding.p_mw / BASE_MVA,
        "Q": moment.station_reactive_power.to_series() / (1e6 * BASE_MVA) - feeding.q_mvar / BASE_MVA,
    }  # fmt: skip
    return {what: float(values.abs().max(skipna=False)) for what, values in differences.items()}
