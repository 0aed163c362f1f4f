"""Where the transformers of a high-voltage line stand."""

from tpss.scenario.supply.supply import Supply


def transformer_positions_km(supply: Supply) -> list[float]:
    """Positions of the transformers between stations, given or equally spaced."""
    high_voltage = supply.high_voltage_line
    if high_voltage is None:
        return []
    if high_voltage.transformers_km is not None:
        return list(high_voltage.transformers_km)
    stations = stations_beside_km(supply)
    count = high_voltage.transformers or 0
    return [
        start + (end - start) * (i + 1) / (count + 1)
        for start, end in zip(stations, stations[1:], strict=False)
        for i in range(count)
    ]


def stations_beside_km(supply: Supply) -> list[float]:
    """Positions of the stations on the line beside which the high-voltage line runs, in order. [km]"""
    line = supply.high_voltage_line.line if supply.high_voltage_line is not None else None
    return sorted(
        s.position_km for s in supply.stations if None in (line, s.line) or s.line == line
    )


def feeding_positions_km(supply: Supply) -> list[float]:
    """Positions of all transformers of the high-voltage line, those at stations too, in order. [km]"""
    if supply.high_voltage_line is None:
        return []
    return sorted([*stations_beside_km(supply), *transformer_positions_km(supply)])
