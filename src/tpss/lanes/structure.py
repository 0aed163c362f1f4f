"""Which cases are alike: those by whose numbers kernels branch alike, and whose arrays match."""

from collections.abc import Iterator
from functools import cache
from typing import Any

import numpy as np

from tpss.api import Prepared
from tpss.lanes.records import WORD, words_of


def structure_of(case: Prepared) -> tuple[Any, ...]:
    """What has to be the same in all cases of a batch, to be compared.

    These are all whole numbers of a model (places, kinds, numbers of points), the shapes of its arrays,
    the choices of the simulation, and the number of steps if it is given.
    """
    start, frame = case.start, case.frame
    model = start.model
    network = model.network
    records = (
        model.stops, model.types, model.legs, network.sections, network.branches, network.sources,
    )  # fmt: skip
    plain = (*network.pattern, network.source_of_node)
    return (
        start.steps,
        tuple(service.train_type for service in start.services),
        tuple(line for line, _, _ in frame.zones),
        frame.at_line_level.tobytes(),
        model.options,
        model.control._replace(studied_train=0),
        network.system,
        network.tolerance,
        model.points.shape,
        tuple(each.shape for each in records),
        tuple(_whole_numbers(each) for each in records),
        tuple(np.asarray(each).tobytes() for each in plain),
    )


def _whole_numbers(array: Any) -> bytes:
    """All numbers of an array of records that are whole."""
    return words_of(array)[..., _whole_words(array.dtype)].tobytes()


@cache
def _whole_words(dtype: Any) -> list[int]:
    """Words of a record that hold whole numbers or booleans."""
    return sorted({offset // WORD for offset in _whole_offsets(dtype)})


def _whole_offsets(dtype: Any) -> Iterator[int]:
    for name in dtype.names:
        kind, offset = dtype.fields[name][:2]
        if kind.names is not None:
            yield from (offset + inner for inner in _whole_offsets(kind))
        elif kind.base.kind in "iub":
            yield offset
