"""Labels that tell results apart which are shown together."""

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from tpss.errors import ResultError

if TYPE_CHECKING:
    from tpss.results.result import Result


def demand_fitting(given: Sequence[str], folders: Sequence[Path]) -> None:
    """Raise a `ResultError` unless there is a label for each of several results, or none."""
    if not given:
        return
    if len(folders) == 1:
        raise ResultError("labels tell compared results apart; leave --label out for a single one")
    if len(given) != len(folders):
        counts = f"{len(given)} labels for {len(folders)} results"
        raise ResultError(f"{counts}; give --label once for each, in their order")
    twice = next((label for k, label in enumerate(given) if label in given[:k]), None)
    if twice is not None:
        raise ResultError(f"two results have the label {twice!r}; give each its own")


def labels(folders: Sequence[Path], results: Sequence["Result"]) -> list[str]:
    """Names of the scenarios, or of the folders where those are the same; each only once."""
    for names in (
        [result.scenario.name for result in results],
        [folder.resolve().name for folder in folders],
        [str(folder) for folder in folders],
    ):
        if len(set(names)) == len(names):
            return names
    return [f"{number}: {folder}" for number, folder in enumerate(folders, 1)]
