"""Drawings as a page takes them: arrays as bytes, in which a number takes four of them."""

from base64 import b64encode
from collections.abc import Callable, Sequence
from dataclasses import fields
from typing import Any

import numpy as np
import numpy.typing as npt

from tpss.report.drawings import parts

PACKED = "f4"
"""Key of an array of float32, little-endian, in base64."""


def packed(values: npt.ArrayLike) -> dict[str, str]:
    """An array as the page unpacks it; NaN stays NaN."""
    return {PACKED: b64encode(np.asarray(values, dtype="<f4").tobytes()).decode("ascii")}


def of_drawing(drawing: parts.Drawing) -> dict[str, Any]:
    """A drawing as plain data: panels, and their items by their kinds."""
    return {
        "axis": drawing.axis,
        "span": drawing.span,
        "columns": list(drawing.columns),
        "panels": [_panel(panel) for panel in drawing.panels],
    }


def _panel(panel: parts.Panel) -> dict[str, Any]:
    return {
        "label": panel.label,
        "span": panel.span,
        "from_zero": panel.from_zero,
        "rows": list(panel.rows),
        "items": [_item(item) for item in panel.items],
    }


def _item(item: parts.Item) -> dict[str, Any]:
    """An item with the name of its kind, such as ``curve``."""
    told = {field.name: _value(getattr(item, field.name)) for field in fields(item)}
    return {"kind": type(item).__name__.lower(), **told}


def _value(value: Any) -> Any:
    for kind, pack in _PACKS:
        if isinstance(value, kind):
            return pack(value)
    return value


def _colours(colours: parts.Colours) -> dict[str, Any]:
    return {
        "values": packed(colours.values),
        "label": colours.label,
        "low": colours.low,
        "high": colours.high,
    }


def _words(words: Sequence[Any]) -> dict[str, Any] | list[Any]:
    """Texts, each different one once, and which of them stands where."""
    if not all(isinstance(word, str) for word in words) or len(words) == len(set(words)):
        return list(words)
    names = {word: number for number, word in enumerate(dict.fromkeys(words))}
    return {"names": list(names), "which": packed([names[word] for word in words])}


_PACKS: tuple[tuple[type, Callable[[Any], Any]], ...] = (
    (np.ndarray, packed),
    (np.generic, lambda number: number.item()),
    (parts.Colours, _colours),
    (list, _words),
    (tuple, _words),
)
"""How values of a kind are packed; others are as they are."""
