"""The audit of links: their currents from the recorded voltages of their nodes."""

from typing import Any

import numpy as np
import numpy.typing as npt

from tpss.kernel import where_any
from tpss.powerflow.links import Links

Complexes = npt.NDArray[np.complex128]


def _audit_nothing(*_: Any) -> None:
    """`audit_links` of no links."""


@where_any(without=_audit_nothing)
def audit_links(links: Links, node_v: Complexes, leaving_a: Complexes) -> None:
    """Add the currents into links to those that leave the nodes, shape (nodes,). [A]"""
    for k in range(links.admittance_s.size):
        voltage = complex(0.0, 0.0)
        for end in range(links.first[k], links.first[k + 1]):
            voltage += links.weight[end] * node_v[links.node[end]]
        current = links.admittance_s[k] * voltage
        for end in range(links.first[k], links.first[k + 1]):
            leaving_a[links.node[end]] += links.weight[end] * current
