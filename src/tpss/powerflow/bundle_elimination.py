"""The derivatives of a bundle: its points eliminated one after the other, see `bundle`."""

from tpss.kernel import at, inlined, kernel
from tpss.numerics.block_lu import Block
from tpss.numerics.pair_matrix import eliminate
from tpss.numerics.pairs import apply, compose, scaled
from tpss.powerflow.bundle_points import piece_after_m
from tpss.powerflow.bundles import EARTH
from tpss.powerflow.network import Flow, Network


@inlined
def _begin_rows(p: int, g: int, network: Network, flow: Flow) -> None:
    """Equations of point `p` without its train, [D | L | -y | -F]; the point before is eliminated."""
    n, own, bundles = network.bundles.size[at(g)], flow.bundles, network.bundles
    rows, is_first = own.rows, p == own.first[at(g)]
    before_m, after_m = own.points[at(p)].piece_m, piece_after_m(p, g, flow)
    per_before, per_after, half_m = 1.0 / before_m, 1.0 / after_m, 0.5 * (before_m + after_m)
    for c in range(n):
        rows[at(c), at(3 * n), 0] = -own.rest_a[at(p), at(c)]
        rows[at(c), at(3 * n), 1] = 0.0
        for k in range(n):
            series = bundles.series_s_m[at(g), at(c), at(k)]
            shunt = scaled(bundles.shunt_s_per_m[at(g), at(c), at(k)], half_m)
            rows[at(c), at(k), 0] = scaled(series, per_before + per_after) + shunt
            rows[at(c), at(k), 1] = 0.0
            rows[at(c), at(n + k), 0] = -scaled(series, per_before) if is_first else 0j
            rows[at(c), at(n + k), 1] = 0.0
            rows[at(c), at(2 * n + k), 0] = -scaled(series, per_after)
            rows[at(c), at(2 * n + k), 1] = 0.0
    if is_first:
        return
    for c in range(n):
        for k in range(n):
            y = scaled(bundles.series_s_m[at(g), at(c), at(k)], per_before)
            for part in range(2):
                for j in range(n):
                    left = own.solved[at(p - 1), at(k), at(j), at(part)]
                    ahead = own.solved[at(p - 1), at(k), at(n + j), at(part)]
                    rows[at(c), at(n + j), at(part)] += y * left
                    rows[at(c), at(j), at(part)] += y * ahead
                rest = own.solved[at(p - 1), at(k), at(2 * n), at(part)]
                rows[at(c), at(3 * n), at(part)] += y * rest


@inlined
def _add_train(p: int, g: int, network: Network, flow: Flow) -> None:
    """Add the pair of the train at point `p` to the equations of its conductors."""
    rows, c = flow.bundles.rows, flow.bundles.points[at(p)].conductor
    y1, y2 = flow.bundles.pair_s[at(p), 0], flow.bundles.pair_s[at(p), 1]
    r = network.bundles.returns[at(g), at(c)]
    rows[at(c), at(c), 0] += y1
    rows[at(c), at(c), 1] += y2
    if r != EARTH:
        rows[at(c), at(r), 0] -= y1
        rows[at(c), at(r), 1] -= y2
        rows[at(r), at(c), 0] -= y1
        rows[at(r), at(c), 1] -= y2
        rows[at(r), at(r), 0] += y1
        rows[at(r), at(r), 1] += y2


@kernel
def _add(block: Block, p: complex, q: complex) -> None:
    block.p += p
    block.q += q


@inlined
def eliminate_point(p: int, g: int, network: Network, flow: Flow) -> float:
    """Solve the equations of point `p`, and put what is left into those of the start nodes.

    Return the sign of their determinant.
    """
    n, own = network.bundles.size[at(g)], flow.bundles
    place, solved = network.bundles.place[at(g)], own.solved[at(p)]
    _begin_rows(p, g, network, flow)
    _add_train(p, g, network, flow)
    sign = eliminate(own.rows[:n, : 3 * n + 1])
    for c in range(n):
        for j in range(2 * n + 1):
            for part in range(2):
                solved[at(c), at(j), at(part)] = own.rows[at(c), at(n + j), at(part)]
    ahead = own.ahead
    for c in range(n):
        s = network.bundles.section[at(g), at(c)]
        node = flow.nodes[at(network.sections[at(s)].start_node)]
        for j in range(n):
            ahead[1, at(c), at(j), 0] = 0.0
            ahead[1, at(c), at(j), 1] = 0.0
        for k in range(n):
            a_p, a_q = ahead[0, at(c), at(k), 0], ahead[0, at(c), at(k), 1]
            for j in range(n):
                l_p, l_q = compose(a_p, a_q, solved[at(k), at(j), 0], solved[at(k), at(j), 1])
                _add(flow.blocks[at(place[at(c), at(j)])], -l_p, -l_q)
                u_p, u_q = compose(
                    a_p, a_q, solved[at(k), at(n + j), 0], solved[at(k), at(n + j), 1]
                )
                ahead[1, at(c), at(j), 0] -= u_p
                ahead[1, at(c), at(j), 1] -= u_q
            rest = solved[at(k), at(2 * n), 0] + solved[at(k), at(2 * n), 1]
            node.right_side -= apply(a_p, a_q, rest)
    for c in range(n):
        for j in range(n):
            for part in range(2):
                ahead[0, at(c), at(j), at(part)] = ahead[1, at(c), at(j), at(part)]
    return sign


@inlined
def begin_elimination(g: int, network: Network, flow: Flow) -> None:
    """What a bundle's start nodes see of themselves and of the first point."""
    n, own, bundles = network.bundles.size[at(g)], flow.bundles, network.bundles
    first_m = own.closing_m[at(g)]
    if own.first[at(g)] < own.first[at(g + 1)]:
        first_m = own.points[at(own.first[at(g)])].piece_m
    for c in range(n):
        for k in range(n):
            series = scaled(bundles.series_s_m[at(g), at(c), at(k)], 1.0 / first_m)
            shunt = scaled(bundles.shunt_s_per_m[at(g), at(c), at(k)], 0.5 * first_m)
            _add(flow.blocks[at(bundles.place[at(g), at(c), at(k)])], series + shunt, 0j)
            own.ahead[0, at(c), at(k), 0] = -series
            own.ahead[0, at(c), at(k), 1] = 0.0


@inlined
def end_elimination(g: int, network: Network, flow: Flow) -> None:
    """The equations of a bundle's end nodes, with the last point eliminated, if there is one."""
    n, own, bundles = network.bundles.size[at(g)], flow.bundles, network.bundles
    last, place = own.first[at(g + 1)] - 1, network.bundles.place[at(g)]
    closing_m, has_point = own.closing_m[at(g)], own.first[at(g + 1)] > own.first[at(g)]
    for c in range(n):
        s = bundles.section[at(g), at(c)]
        node = flow.nodes[at(network.sections[at(s)].end_node)]
        for k in range(n):
            y = scaled(bundles.series_s_m[at(g), at(c), at(k)], 1.0 / closing_m)
            shunt = scaled(bundles.shunt_s_per_m[at(g), at(c), at(k)], 0.5 * closing_m)
            _add(flow.blocks[at(place[at(n + c), at(n + k)])], y + shunt, 0j)
            _add(
                flow.blocks[at(place[at(c), at(n + k)])],
                own.ahead[0, at(c), at(k), 0],
                own.ahead[0, at(c), at(k), 1],
            )
            if not has_point:
                _add(flow.blocks[at(place[at(n + c), at(k)])], -y, 0j)
                continue
            solved = own.solved[at(last), at(k)]
            for j in range(n):
                _add(
                    flow.blocks[at(place[at(n + c), at(j)])],
                    y * solved[at(j), 0], y * solved[at(j), 1],
                )  # fmt: skip
                _add(
                    flow.blocks[at(place[at(n + c), at(n + j)])],
                    y * solved[at(n + j), 0], y * solved[at(n + j), 1],
                )  # fmt: skip
            node.right_side += y * (solved[at(2 * n), 0] + solved[at(2 * n), 1])
