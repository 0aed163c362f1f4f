"""Files of a comparison with measurements."""

import json
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from tpss.measured.compare import MeasuredComparison

TABLES = ("aligned", "figures", "windows", "durations")
"""Tables by the names of their files, and of the attributes that hold them."""

HOW = "comparison.json"


def contents(comparison: "MeasuredComparison") -> dict[str, bytes]:
    """Tables of a comparison as CSV, and how it came about as JSON, by the names of their files."""
    files = {
        f"{name}.csv": getattr(comparison, name).to_csv(index=False).encode() for name in TABLES
    }
    text = json.dumps(comparison.as_dict(), indent=2, ensure_ascii=False)
    return {**files, HOW: f"{text}\n".encode()}
