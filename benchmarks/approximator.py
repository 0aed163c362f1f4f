"""Predictions a second, with intervals, domain and probability of collapse.

Usage: python benchmarks/approximator.py MODEL.json [--rows N] [--runs N]

Lines are drawn from the trained ranges, and only those inside the trained region are kept.
"""

import argparse
import time
from pathlib import Path

import numpy as np

import tpss
from tpss.approximator.approximator import Approximator


def lines_inside(model: Approximator, rows: int) -> dict[str, np.ndarray]:
    """Inputs of lines, drawn evenly from the trained ranges."""
    draw = np.random.default_rng(0)
    return {
        each.name: draw.choice(each.values, rows)
        if each.kind == "choice"
        else draw.uniform(each.low, each.high, rows)
        for each in model.file.inputs.varying
    }


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("model", type=Path, help="file that tpss approximate train has written")
    parser.add_argument("--rows", type=int, default=100_000)
    parser.add_argument("--runs", type=int, default=5)
    given = parser.parse_args()
    model = tpss.load_approximator(given.model)
    lines = lines_inside(model, given.rows)
    columns = model.file.inputs.read(lines, "lines")
    inside = [not words for words in model.file.domain.objections(columns, model.file.inputs)]
    lines = {name: values[inside] for name, values in lines.items()}
    repeats = -(-given.rows // sum(inside))
    lines = {name: np.tile(values, repeats)[: given.rows] for name, values in lines.items()}
    times, busy = [], []
    for _ in range(given.runs):
        started, worked = time.perf_counter(), time.process_time()
        model.predict(lines)
        times.append(time.perf_counter() - started)
        busy.append(time.process_time() - worked)
    rates = [f"{given.rows / min(each):,.0f}" for each in (times, busy)]
    print(
        f"{given.rows:,} predictions (best of {given.runs}): {rates[0]} a second, {rates[1]} a second "
        "of processor time"
    )


if __name__ == "__main__":
    main()
