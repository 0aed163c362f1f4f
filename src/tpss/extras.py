"""Packages that only some commands need, by their extras: ``pip install "tpss[report]"``.

What needs one asks for it before it begins, so that nothing is simulated in vain; the fault says what to
install.
"""

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from importlib.util import find_spec

from tpss.errors import ApproximatorError, PlanError, ResultError, StudyError, TpssError


@dataclass(frozen=True)
class Need:
    """What needs packages, which, and the extra that has them."""

    what: str
    """In words, as the beginning of a sentence."""
    modules: tuple[str, ...]
    extra: str
    error: type[TpssError] = ResultError
    """Raised if one is missing."""


NEEDS = {
    "report": Need("reports", ("jinja2", "plotly"), "report"),
    "plan report": Need(
        "reports of plans", ("jinja2", "matplotlib", "plotly"), "report", PlanError
    ),
    "figures": Need("figures", ("matplotlib",), "report"),
    "xlsx": Need("xlsx files", ("xlsxwriter",), "excel"),
    "sheets": Need("workbooks", ("openpyxl",), "excel"),
    "study": Need("studies", ("pyarrow", "scipy"), "study", StudyError),
    "scheduler": Need("studies on a Dask scheduler", ("distributed",), "study", StudyError),
    "parquet": Need("parquet files", ("pyarrow",), "parquet"),
    "training": Need("approximators", ("sklearn", "pyarrow"), "study", ApproximatorError),
    "plan": Need("plans", ("pyarrow", "scipy", "xlsxwriter"), "plan", PlanError),
    "budget": Need("plans with a budget", ("highspy",), "plan", PlanError),
    "studio": Need(
        "pages of the studio",
        ("starlette", "uvicorn", "tomlkit", "latex2mathml", "jinja2", "plotly"),
        "studio",
    ),
    "least squares": Need("the load flow by least squares", ("scipy",), "least-squares"),
}
"""What needs more than the core does; a failed import is told as that of the first that needs it."""

PACKAGES = {"sklearn": "scikit-learn"}
"""Packages that are not called like the modules they hold."""


def absent(need: str) -> list[str]:
    """Packages that something needs, and that are not installed."""
    missing = (name for name in NEEDS[need].modules if find_spec(name) is None)
    return [PACKAGES.get(name, name) for name in missing]


def remedy(*needs: str) -> str:
    """The command that installs what something needs."""
    extras = dict.fromkeys(NEEDS[need].extra for need in needs)
    return f'pip install "tpss[{",".join(extras)}]"'


def demand(*needs: str) -> None:
    """Demand the packages that something needs.

    Parameters
    ----------
    *needs : str
        Of `NEEDS`.

    Raises
    ------
    TpssError
        Some are missing: the error of the first need that lacks any.
    """
    lacking = {need: packages for need in needs if (packages := absent(need))}
    if lacking:
        told = (f"{NEEDS[need].what} need {', '.join(names)}" for need, names in lacking.items())
        error = NEEDS[next(iter(lacking))].error
        raise error(f"{'; '.join(told)}, not installed: {remedy(*lacking)}")


@contextmanager
def imports_explained() -> Iterator[None]:
    """Say of a package that is missing in an import which extra has it.

    Raises
    ------
    TpssError
        An import failed for want of a package of an extra.
    """
    try:
        yield
    except ModuleNotFoundError as error:
        for each in NEEDS.values():
            module = (error.name or "").partition(".")[0]
            if module in each.modules:
                package = PACKAGES.get(module, module)
                words = f"{each.what} need {package}, not installed"
                raise each.error(f'{words}: pip install "tpss[{each.extra}]"') from error
        raise
