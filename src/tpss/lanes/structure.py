"""Which cases are alike: those by whose numbers kernels branch alike, and whose arrays match."""

from collections.abc import Iterator
from typing import Any

import numpy as np

from tpss.api import Prepared



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
        tuple(line for line, _, _ in frame.zones),
        frame.at_line_level.tobytes(),
        model.options,
        model.control._replace(studied_train=0),
        network.system,
        network.tolerance,
        model.points.shape,
        tuple(each.shape for each in records),
        tuple(part for each in records for part in _whole_numbers(np.asarray(each))),
        tuple(np.asarray(each).tobytes() for each in plain),
    )


def _whole_numbers(array: Any) -> Iterator[bytes]:
    """All numbers of an array of records that are whole."""
    if array.dtype.names is None:
        if array.dtype.kind in "iub":
            yield array.tobytes()
        return
    for name in array.dtype.names:
        yield from _whole_numbers(array[name])
