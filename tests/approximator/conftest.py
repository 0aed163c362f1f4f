"""Approximators of a made-up study."""

from collections.abc import Iterator
from pathlib import Path
from unittest.mock import patch

import pytest

from tpss.approximator import fit
from tpss.approximator.approximator import Approximator
from tpss.approximator.train import train_approximator

from made_up_studies import SMALL, made_up_table, write_study


@pytest.fixture(autouse=True)
def _small_networks() -> Iterator[None]:
    with patch.dict(fit.NEURONS, SMALL):
        yield


@pytest.fixture(scope="session")
def study(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return write_study(tmp_path_factory.mktemp("study") / "made-up", made_up_table(600))


@pytest.fixture(scope="session")
def model(study: Path) -> Approximator:
    """An approximator of the made-up study."""
    with patch.dict(fit.NEURONS, SMALL):
        return train_approximator(study)


@pytest.fixture
def model_file(model: Approximator, tmp_path: Path) -> Path:
    return model.save(tmp_path / "model.json")
