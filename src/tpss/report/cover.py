"""The first page of a report: what it is about, in the words of its author, and what to know at once."""

from collections.abc import Iterator
from dataclasses import dataclass

from tpss.report.drawings.network import network
from tpss.report.render.inline import inline
from tpss.report.tables import Table
from tpss.results.result import Result
from tpss.units import on_line


@dataclass(frozen=True)
class Cover:
    """What an author says of a report; what is empty is left out."""

    title: str = ""
    project: str = ""
    author: str = ""
    remarks: str = ""
    """In paragraphs, parted by empty lines."""
    variants: Table | None = None
    """Variants side by side."""

    @property
    def paragraphs(self) -> list[str]:
        """Paragraphs of the remarks."""
        parts = (part.strip() for part in self.remarks.replace("\r\n", "\n").split("\n\n"))
        return [part for part in parts if part]


def drawing_of(result: Result) -> str:
    """Picture of the lines, in the colours of the lowest voltage; empty for a run without a step."""
    if result.dataset.sizes["time"] < 2 or not result.audit["passed"]:
        return ""
    words = "The lines, coloured by the lowest voltage of the run, with what feeds them"
    return inline(network(result), "cover", words)


def worst_places(result: Result) -> list[str]:
    """Where the voltage is lowest, the useful voltage too, and which station is loaded highest."""
    return list(_worst_places(result)) if result.audit["passed"] else []


def _worst_places(result: Result) -> Iterator[str]:
    lowest = result.summary["lowest_voltage"]
    if lowest:
        place = on_line(lowest.get("line", ""), f"km {lowest['position_km']:.1f}")
        yield (
            f"Lowest voltage: {lowest['voltage_kv']:.2f} kV at {place}, at {lowest['train']} after "
            f"{lowest['time_min']:.1f} min"
        )
    zones = result.standards.useful_voltage_zones.dropna(subset=["mean_useful_kv"])
    if len(zones):
        k = int(zones.mean_useful_kv.to_numpy().argmin())
        lowest_kv, zone = zones.mean_useful_kv.iloc[k], zones.zone.iloc[k]
        yield f"Lowest mean useful voltage: {lowest_kv:.2f} kV, {zone}"
    stations = result.stations.dropna(subset=["peak_loading"])
    if len(stations):
        k = int(stations.peak_loading.to_numpy().argmax())
        loading, station = stations.peak_loading.iloc[k], stations.station.iloc[k]
        yield f"Highest loading of a station: {100.0 * loading:.0f} %, {station}"
