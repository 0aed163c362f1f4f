"""What the rails' voltages and stray currents come to, in lines, and what is beyond its limit."""

from typing import TYPE_CHECKING

from tpss.units import on_line

if TYPE_CHECKING:
    from tpss.results.result import Result


def rails_in_words(result: "Result") -> list[str]:
    """Lines about the rails of a run; none unless they are conductors of their own."""
    found = result.rails
    if not len(found):
        return []
    is_direct = result.scenario.supply.is_direct
    limits = result.scenario.standards.rails.completed(is_direct)
    lines = [
        _highest(result, "short_v", "in a second or a step", limits.short_v),
        _highest(result, "permanent_v", "over 300 s", limits.permanent_v),
    ]
    for row in result.stray_current.to_dict("records"):
        where = f" of {row['line']}" if "line" in row else ""
        lines.append(
            f"Stray current{where}: {row['leaving_a']:.2f} A as a mean, "
            f"{row['leaving_ma_per_m']:.2f} mA/m of track (limit {limits.stray_ma_per_m:g} mA/m)"
            f"{_beyond(row['leaving_ma_per_m'], limits.stray_ma_per_m)}"
        )
    return [line for line in lines if line]


def _highest(result: "Result", column: str, words: str, limit_v: float | None) -> str:
    """The place with the highest mean, in a line; empty if the run is too short for one."""
    found = result.rails.dropna(subset=[column])
    if not len(found):
        return ""
    row = found.to_dict("records")[int(found[column].to_numpy().argmax())]
    place = on_line(str(row.get("line", "")), f"{row['position_km']:.2f} km")
    return (
        f"Rails to earth: at most {row[column]:.1f} V {words}, at {place} (limit {limit_v:g} V)"
        f"{_beyond(row[column], limit_v)}"
    )


def _beyond(value: float, limit: float | None) -> str:
    return ", beyond it" if limit is not None and value > limit else ""
