"""Kernels with a form each that the conversion for lanes does not know, which their docstrings name."""

from tpss.kernel import kernel


@kernel
def cubes(x: float, y: float) -> float:
    """A power that is not a square."""
    return x**3 + y


@kernel
def raises(x: float, y: float) -> float:
    """A statement of an unknown kind."""
    if x > y:
        raise ValueError
    return x


@kernel
def loops_over_numbers(x: float, y: float) -> float:
    """A loop over what is no range."""
    for factor in (1.0, 2.0):
        x *= factor
    return x + y


@kernel
def loops_in_steps(x: float, y: float) -> float:
    """A loop in steps."""
    for k in range(0, 4 if x > y else 6, 2):
        x += k
    return x


@kernel
def breaks_out(x: float, y: float) -> float:
    """A break by some lanes out of a loop over a range."""
    for _ in range(4):
        if x > y:
            break
        x += 1.0
    return x


@kernel
def ends_a_loop(x: float, y: float) -> float:
    """A loop with an end of its own."""
    while x < y:
        x += 1.0
    else:
        x = y
    return x


@kernel
def unpacks_twice(x: float, y: float) -> float:
    """Names unpacked within others."""
    a, (b, c) = x, (y, x)
    return a + b + c


@kernel
def stores_a_tuple_in_two(x: float, y: float) -> float:
    """A tuple in a tuple."""
    (a, b) = both = (x, y)
    return a + b + both[0]


@kernel
def names_an_argument(x: float, y: float) -> float:
    """A call with names of arguments."""
    return cubes(x, y=y)


@kernel
def compares_otherwise(x: float, y: float) -> float:
    """A comparison of an unknown kind."""
    return 1.0 if x not in (1.0, y) else 2.0


@kernel
def has_a_function(x: float, y: float) -> float:
    """An expression of an unknown kind."""
    return sum([k * x for k in (1.0, y)])


@kernel
def declares(x: float, y: float) -> float:
    """A name without a value."""
    z: float
    z = x + y
    return z


KERNELS = (
    cubes, raises, loops_over_numbers, loops_in_steps, breaks_out, ends_a_loop, unpacks_twice,
    stores_a_tuple_in_two, names_an_argument, compares_otherwise, has_a_function, declares,
)  # fmt: skip


@kernel
def calls_one(x: float, y: float) -> float:
    """Itself it has none."""
    return cubes(x, y) + 1.0
