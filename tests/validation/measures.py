"""What is measured on a result, by the names that ``expected.toml`` uses.

A measure takes the result of a run, that of the run it is compared ``against`` if the quantity names
one, and the quantity's arguments.  It returns a number in the quantity's unit.
"""

from collections.abc import Callable

import numpy as np
import numpy.typing as npt
import xarray as xr

import tpss
from tpss.report.gradients import inclination

Floats = npt.NDArray[np.float64]
Measure = Callable[..., float]

MEASURES: dict[str, Measure] = {}


def measure(function: Measure) -> Measure:
    """Offer a function as a measure."""
    MEASURES[function.__name__] = function
    return function


@measure
def trip_time_min(result: tpss.Result) -> float:
    """Time from the studied train's departure to its arrival."""
    return float(result.summary["trip_time_min"])


@measure
def station_energy_mwh(result: tpss.Result, station: str) -> float:
    """Energy that a converter station fed into the railway."""
    return float(result.summary["station_energy_mwh"][station])


@measure
def total_energy_mwh(result: tpss.Result) -> float:
    """Energy that all stations fed into the railway."""
    return float(result.summary["total_energy_mwh"])


@measure
def extra_energy_percent(result: tpss.Result, other: tpss.Result) -> float:
    """How much more all stations fed than in the other run."""
    return 100.0 * (total_energy_mwh(result) / total_energy_mwh(other) - 1.0)


def studied(result: tpss.Result) -> xr.Dataset:
    """The studied train's part of a dataset, while it is on the line."""
    data = result.dataset.sel(train=result.summary["studied_train"])
    return data.isel(time=np.isfinite(data.pantograph_voltage.to_numpy()))


def voltage_at(result: tpss.Result, km: float) -> float:
    """Voltage that the studied train meets at a place. [kV]"""
    data = studied(result)
    where, volts = data.position.to_numpy() / 1e3, data.pantograph_voltage.to_numpy() / 1e3
    return float(np.interp(km, where, volts))


@measure
def voltage_lift_v(result: tpss.Result, at_km: float, beside_km: float) -> float:
    """Voltage at a place, above the mean of those so far before and after it."""
    beside = voltage_at(result, at_km - beside_km) + voltage_at(result, at_km + beside_km)
    return 1e3 * (voltage_at(result, at_km) - beside / 2.0)


@measure
def lowest_voltage_km(result: tpss.Result) -> float:
    """Where the studied train meets its lowest voltage."""
    data = studied(result)
    return float(data.position[int(data.pantograph_voltage.argmin("time"))]) / 1e3


@measure
def end_over_middle_kv(result: tpss.Result, end_km: float) -> float:
    """Voltage a kilometre from an end of the line, above that half-way."""
    length_km = result.scenario.line.length_km
    near = end_km + (1.0 if end_km < length_km / 2 else -1.0)
    return voltage_at(result, near) - voltage_at(result, length_km / 2.0)


@measure
def mean_voltage_change_v(result: tpss.Result, other: tpss.Result) -> float:
    """Mean voltage at the studied train's pantograph, less that of the other run."""
    means = [float(studied(run).pantograph_voltage.mean()) for run in (result, other)]
    return means[0] - means[1]


@measure
def train_energy_change_percent(result: tpss.Result, other: tpss.Result, power: str) -> float:
    """Active or reactive energy that the studied train draws, relative to the other run's."""
    sums = [float(studied(run)[power].sum()) for run in (result, other)]
    return 100.0 * (sums[0] / sums[1] - 1.0)


@measure
def highest_speed_kmh(result: tpss.Result) -> float:
    """Highest speed of any train."""
    return float(result.dataset.speed.max()) * 3.6


@measure
def power_follows_inclination(result: tpss.Result, from_km: float, to_km: float) -> float:
    """Correlation of the studied train's power with the inclination, on a part of the line."""
    data = studied(result)
    where = data.position.to_numpy()
    within = (where >= from_km * 1e3) & (where <= to_km * 1e3)
    power = data.active_power.to_numpy()[within]
    return float(np.corrcoef(power, inclination(result.scenario.only_line, where[within]))[0, 1])


@measure
def power_swing(result: tpss.Result) -> float:
    """Mean change of the studied train's power from step to step, over its mean power."""
    power = studied(result).active_power.to_numpy()
    return float(np.abs(np.diff(power)).mean() / power.mean())


@measure
def stop_error_mm(result: tpss.Result, stop_km: float, trains: str) -> float:
    """Largest distance between a stop and where trains of a kind stood or arrived.

    ``trains`` is ``departed`` (the studied train) or ``placed`` (those on the line at the start, as far
    as they had the stop ahead of them).
    """
    places = standing_km(result, stop_km, trains)
    return float(np.abs(places - stop_km).max()) * 1e6


def standing_km(result: tpss.Result, stop_km: float, trains: str) -> Floats:
    """Place where each train of a kind stood, among those that came past or to a stop."""
    data = result.dataset
    placed = ~np.isfinite(data.departure_time.to_numpy())
    chosen = placed if trains == "placed" else data.train == result.summary["studied_train"]
    data = data.isel(train=np.flatnonzero(chosen))
    position_km, speed = data.position.to_numpy() / 1e3, data.speed.to_numpy()
    stood = np.where((speed == 0.0) & (position_km > 0.0), position_km, np.nan)
    nearest = np.full(data.sizes["train"], np.nan)
    for i in range(data.sizes["train"]):
        passed = np.nanmax(position_km[:, i]) > stop_km - 0.1
        ahead_at_start = np.nanmin(position_km[:, i]) < stop_km - 0.1
        if passed and ahead_at_start:
            nearest[i] = stood[np.nanargmin(np.abs(stood[:, i] - stop_km)), i]
    return nearest[np.isfinite(nearest)]


@measure
def highest_retardation_m_s2(result: tpss.Result) -> float:
    """Highest retardation of any train."""
    return float(-result.dataset.acceleration.min())


@measure
def initial_loading_percent(result: tpss.Result, minutes: float) -> float:
    """Mean loading of both stations' converters over the first minutes, when all run."""
    loading = before_end(result).converter_loading
    return 100.0 * float(loading.where(loading.time < minutes * 60.0).mean())


def controlled(result: tpss.Result) -> xr.Dataset:
    """A dataset from the first control, after three minutes, to the end."""
    data = before_end(result)
    return data.isel(time=data.time.to_numpy() >= 180.0)


def before_end(result: tpss.Result) -> xr.Dataset:
    """A dataset without its last instant, at which no interval begins."""
    return result.dataset.isel(time=slice(0, -1))


@measure
def mean_loading_percent(result: tpss.Result) -> float:
    """Mean loading of both stations' running converters after the first control."""
    return 100.0 * float(controlled(result).converter_loading.mean())


@measure
def lowest_loading_percent(result: tpss.Result) -> float:
    """Lowest loading of a station's running converters after the first control."""
    return 100.0 * float(controlled(result).converter_loading.min())


@measure
def loading_of_all_percent(result: tpss.Result) -> float:
    """Mean loading of both stations' converters over the whole run."""
    return 100.0 * float(before_end(result).converter_loading.mean())


@measure
def converters_divided_by(result: tpss.Result) -> float:
    """Converters installed over the mean number that run after the first control."""
    installed = result.scenario.supply.converter_stations[0].converters
    return installed / float(controlled(result).active_converters.mean())


@measure
def highest_angle_change_deg(result: tpss.Result, other: tpss.Result) -> float:
    """Largest difference of the studied train's angle to the other run's; negative: it fell."""
    difference = studied(result).pantograph_angle - studied(other).pantograph_angle
    return float(np.degrees(difference.max()))


@measure
def mean_angle_change_deg(result: tpss.Result, other: tpss.Result) -> float:
    """Mean difference of the studied train's angle to the other run's; negative: it fell."""
    difference = studied(result).pantograph_angle - studied(other).pantograph_angle
    return float(np.degrees(difference.mean()))


@measure
def total_power_change_percent(result: tpss.Result, other: tpss.Result) -> float:
    """Largest relative difference between the stations' total powers in both runs."""
    total = [before_end(run).station_active_power.sum("station") for run in (result, other)]
    return 100.0 * float(np.abs(total[0] / total[1] - 1.0).max())


def steps_with_unequal_numbers(result: tpss.Result) -> tuple[xr.Dataset, Floats, Floats]:
    """Steps at which two stations run different numbers of converters: data, fewer, more."""
    data = before_end(result)
    running = data.active_converters.to_numpy()
    data = data.isel(time=running[:, 0] != running[:, 1])
    fewer = data.active_converters.to_numpy().argmin(axis=1)
    return data, fewer, 1 - fewer


@measure
def fewer_take_less_percent(result: tpss.Result, other: tpss.Result) -> float:
    """Share of the unequal steps at which the station with fewer converters feeds less than in the
    other run, and less than its neighbour."""
    data, fewer, more = steps_with_unequal_numbers(result)
    steps = np.arange(data.sizes["time"])
    power = data.station_active_power.to_numpy()
    before = other.dataset.station_active_power.sel(time=data.time).to_numpy()
    less = (power[steps, fewer] < before[steps, fewer]) & (power[steps, fewer] < power[steps, more])
    return 100.0 * float(less.mean())


@measure
def fewer_are_loaded_higher_percent(result: tpss.Result) -> float:
    """Share of the unequal steps at which the station with fewer converters loads them higher."""
    data, fewer, more = steps_with_unequal_numbers(result)
    steps = np.arange(data.sizes["time"])
    loading = data.converter_loading.to_numpy()
    return 100.0 * float((loading[steps, fewer] > loading[steps, more]).mean())


@measure
def share_percent(result: tpss.Result, power: str) -> float:
    """The first station's share of all stations' active or reactive power, in the last step."""
    fed = before_end(result)[power].to_numpy()[-1]
    return 100.0 * float(fed[0] / fed.sum())


@measure
def last_voltage_v(result: tpss.Result) -> float:
    """Voltage at the only train, in the last step."""
    return float(before_end(result).pantograph_voltage.to_numpy()[-1, 0])


@measure
def train_power_w(result: tpss.Result, at_km: float) -> float:
    """Active power that the studied train draws in the step that passes a place."""
    data = studied(result)
    passed = int((data.position.to_numpy() <= at_km * 1e3).sum()) - 1
    return float(data.active_power[passed])


@measure
def time_to_speed_s(result: tpss.Result, speed_m_s: float) -> float:
    """Time after which the studied train has a speed for the first time."""
    data = studied(result)
    return float(np.interp(speed_m_s, data.speed.to_numpy(), data.time.to_numpy()))


@measure
def way_to_speed_m(result: tpss.Result, speed_m_s: float) -> float:
    """Way after which the studied train has a speed for the first time."""
    data = studied(result)
    return float(np.interp(speed_m_s, data.speed.to_numpy(), data.position.to_numpy()))
