"""Files of a comparison with measurements."""

import json
from typing import TYPE_CHECKING

from tpss.results.csv_texts import csv_of

if TYPE_CHECKING:
    from tpss.measured.compare import MeasuredComparison

TABLES = ("aligned", "figures", "windows", "durations")
"""Tables by the names of their files, and of the attributes that hold them."""

HOW = "comparison.json"


def contents(comparison: "MeasuredComparison") -> dict[str, bytes]:
    """Tables of a comparison as CSV, and how it came about as JSON, by the names of their files."""
    files = {f"{name}.csv": csv_of(getattr(comparison, name)) for name in TABLES}
    text = json.dumps(comparison.as_dict(), indent=2, ensure_ascii=False)
    return {**files, HOW: f"{text}\n".encode()}
