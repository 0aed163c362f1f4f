"""How a result and measurements were compared, in words."""

from tpss.measured.compare import MeasuredComparison


def sentences(comparison: MeasuredComparison) -> list[str]:
    """How the two were compared, in words."""
    grid = comparison.grid
    first = (
        f"{comparison.file.name}, whose time is {comparison.begins} at minute 0 of the run, over "
        f"{grid.intervals} intervals of {grid.step_s / 60.0:g} min from minute "
        f"{grid.begin_s / 60.0:.2f} on"
    )
    return [first] if comparison.offset is None else [first, comparison.offset.in_words]
