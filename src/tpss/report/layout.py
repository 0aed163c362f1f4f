"""Where the lines of a network are drawn: a plan without geography, true to length along each line.

The longest line lies level, at its own kilometres.  The others leave it, and each other, at the stations
where they meet, to a row above or below, and run level there.  A line between two such stations is
stretched from one to the other.
"""

from collections.abc import Iterator, Sequence
from typing import NamedTuple

import numpy as np

from tpss.report.sampling import Floats
from tpss.scenario.line import Line
from tpss.scenario.scenario import Scenario

ROWS_ACROSS = 6.0
"""Distance of neighbouring rows, as a part of the length of the longest line: one in so many."""

RAMP = 0.4
"""Length of a way from row to row along the plan, in distances of rows."""

CLOSE = 0.45
"""Distance below which lines are too close to each other, in distances of rows."""

ATOP, COST_ATOP = 0.06, 10.0
"""Distance below which a line lies on another one, in distances of rows, and what that counts more."""

SAMPLES_A_ROW = 12
"""Points of a line at which its distance to others is judged, in a distance of rows."""


class Path(NamedTuple):
    """Way of a line across the plan, straight between points."""

    km: Floats
    """Positions on the line, rising."""
    x: Floats
    """Along the plan. [km]"""
    y: Floats
    """Across it, in rows."""

    def at(self, place_km: Floats | float) -> tuple[Floats, Floats]:
        """Places of positions on the line [km], along [km] and across the plan."""
        x, y = (np.interp(place_km, self.km, each) for each in (self.x, self.y))
        return np.asarray(x), np.asarray(y)


Point = tuple[float, float, float]
"""Position on a line [km], and its place along [km] and across the plan."""


Tried = tuple[list[Point], Sequence[Point]]
"""A way of a part of a line, and the stations at which it is fixed."""


def layout(scenario: Scenario) -> dict[str, Path]:
    """Plan of a scenario's lines, by their names."""
    lines = scenario.lines_by_name
    waiting = sorted(lines, key=lambda name: -lines[name].length_km)
    canvas = _Canvas(lines[waiting[0]].length_km)
    meeting: dict[str, tuple[float, float]] = {}
    paths: dict[str, Path] = {}
    while waiting:
        # Those between two stations that stand already go where there is most room, so come first.
        name = max(waiting, key=lambda each: min(len(_met(lines[each], meeting)), 2))
        waiting.remove(name)
        paths[name] = _path(lines[name], _met(lines[name], meeting), canvas)
        for station in lines[name].stations:
            x, y = paths[name].at(station.position_km)
            meeting.setdefault(station.name, (float(x), float(y)))
    return {name: paths[name] for name in lines}


def _met(line: Line, meeting: dict[str, tuple[float, float]]) -> list[Point]:
    """Stations of a line that stand in the plan already, in the order of its kilometres."""
    met = [(s.position_km, *meeting[s.name]) for s in line.stations if s.name in meeting]
    return sorted(met)


class _Canvas:
    """The plan so far."""

    def __init__(self, longest_km: float) -> None:
        self.row_km = longest_km / ROWS_ACROSS
        self.drawn = np.empty((0, 2))
        """Points of the lines, in distances of rows."""
        self.rows = [0.0]

    def add(self, points: Sequence[Point]) -> None:
        """Draw a part of a line."""
        self.drawn = np.concatenate([self.drawn, self._sampled(points)])
        self.rows.append(points[len(points) // 2][2])

    def _sampled(self, points: Sequence[Point]) -> Floats:
        corners = np.array([(x / self.row_km, y) for _, x, y in points])
        pieces = [
            np.linspace(
                begin, end, 2 + int(SAMPLES_A_ROW * float(np.hypot(*(end - begin)))), endpoint=True
            )
            for begin, end in zip(corners, corners[1:], strict=False)
        ]
        return np.concatenate(pieces)

    def crowding(self, points: Sequence[Point], fixed: Sequence[Point]) -> float:
        """By how much a part of a line is too close to others, away from where it is fixed."""
        sampled = self._sampled(points)
        for _, x, y in fixed:
            away = np.hypot(*(sampled - (x / self.row_km, y)).T) > CLOSE
            sampled = sampled[away]
        apart = np.moveaxis(sampled[:, None] - self.drawn, -1, 0)
        nearest = np.hypot(*apart).min(axis=1, initial=np.inf)
        closeness = np.maximum(0.0, 1.0 - nearest / CLOSE)
        return round(float(np.sum(closeness + (nearest < ATOP) * COST_ATOP)), 6)

    def growth_km(self, points: Sequence[Point]) -> float:
        """By how much a part of a line would make the plan longer. [km]"""
        low, high = self.drawn[:, 0].min() * self.row_km, self.drawn[:, 0].max() * self.row_km
        x = [x for _, x, _ in points]
        return float(max(0.0, low - min(x)) + max(0.0, max(x) - high))

    def free_row(self) -> float:
        """A row below all that is drawn."""
        return float(np.floor(self.drawn[:, 1].min())) - 1.0 if len(self.drawn) else 0.0

    def rows_to_try(self) -> list[float]:
        """Rows that have lines, and one more at either side."""
        low, high = int(np.floor(min(self.rows))), int(np.ceil(max(self.rows)))
        return [float(row) for row in range(low - 1, high + 2)]


def _path(line: Line, met: Sequence[Point], canvas: _Canvas) -> Path:
    if not met:  # the first line, or one that meets none of those before it
        row = canvas.free_row()
        left = canvas.drawn[:, 0].min() * canvas.row_km if row else line.begins_at_km
        points = [
            (line.begins_at_km, left, row),
            (line.end_km, left + line.length_km, row),
        ]
        canvas.add(points)
        return _joined(points)
    points = list(met[:1])
    for begin, end in zip(met, met[1:], strict=False):
        tried: list[Tried] = [(way, (begin, end)) for way in _bridges(begin, end, canvas)]
        points += _best(tried, canvas, begin[2])[1:]
    if met[0][0] > line.begins_at_km:
        tried = [(way, met[:1]) for way in _arms(met[0], line.begins_at_km, canvas)]
        points = _best(tried, canvas, met[0][2])[::-1][:-1] + points
    if met[-1][0] < line.end_km:
        tried = [(way, met[-1:]) for way in _arms(met[-1], line.end_km, canvas)]
        folded = 0.0 if len(points) < 2 else float(np.sign(points[-2][1] - points[-1][1]))
        points += _best(tried, canvas, met[-1][2], folded)[1:]
    return _joined(points)


def _joined(points: Sequence[Point]) -> Path:
    km, x, y = np.array(points).T
    return Path(km, x, y)


def _best(
    tried: Sequence[Tried],
    canvas: _Canvas,
    from_row: float,
    folded: float = 0.0,
) -> list[Point]:
    """The way that crowds least.

    Of such the one that does not go back where the line comes from, on which side that is, and goes
    straight on; that leaves the plan short; and that is near its row, on the emptier side.
    """

    def cost(each: Tried) -> tuple[float, ...]:
        points, fixed = each
        row = points[len(points) // 2][2]
        back = folded != 0.0 and np.sign(points[-1][1] - points[0][1]) == folded
        side = sum(np.sign(other - from_row) == np.sign(row - from_row) for other in canvas.rows)
        return (
            canvas.crowding(points, fixed), float(back), float(len(points) > 2),
            canvas.growth_km(points), abs(row - from_row), float(side),
        )  # fmt: skip

    chosen, _ = min(tried, key=cost)
    canvas.add(chosen)
    return chosen


def _arms(start: Point, end_km: float, canvas: _Canvas) -> Iterator[list[Point]]:
    """Ways from a station to where a line ends, rightwards and leftwards on every row."""
    begin_km, x, y = start
    length_km = abs(end_km - begin_km)
    towards = np.sign(end_km - begin_km)
    ramp_km = min(RAMP * canvas.row_km, 0.5 * length_km)
    for row in (*canvas.rows_to_try(), y):
        for side in (1.0, -1.0):
            corner = (begin_km + towards * ramp_km, x + side * ramp_km, row)
            bent = [corner] if row != y else []
            yield [start, *bent, (end_km, x + side * length_km, row)]


def _bridges(begin: Point, end: Point, canvas: _Canvas) -> Iterator[list[Point]]:
    """Ways between two stations that stand in the plan, straight and on every row."""
    yield [begin, end]
    (begin_km, left, _), (end_km, right, _) = begin, end
    share = min(RAMP * canvas.row_km / max(abs(right - left), 1e-9), 1.0 / 3.0)
    for row in canvas.rows_to_try():
        corners = [
            (begin_km + part * (end_km - begin_km), left + part * (right - left), row)
            for part, y in ((share, begin[2]), (1.0 - share, end[2]))
            if row != y
        ]
        if corners:
            yield [begin, *corners, end]
