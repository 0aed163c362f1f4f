"""Which value of a staircase holds at a position."""

import numpy as np
import pytest

from tpss.numerics.staircase import index_at, index_from

FROM_M = np.array([0.0, 1000.0, 3000.0])


@pytest.mark.parametrize(
    ("position_m", "stair"),
    [(-50.0, 0), (0.0, 0), (999.9, 0), (1000.0, 1), (2999.9, 1), (3000.0, 2), (1e6, 2)],
)
def test_a_stair_holds_from_its_position_and_the_outer_ones_beyond_the_ends(
    as_run, position_m, stair
):
    assert as_run(index_at)(position_m, FROM_M) == stair
    for before in range(FROM_M.size):
        assert as_run(index_from)(before, position_m, FROM_M) == stair
