"""Time ``tpss run`` as a process, with a cold kernel cache and with a warm one.

Usage: python benchmarks/command_line.py
"""

import os
import statistics
import subprocess
import sys
import tempfile
import time
from pathlib import Path

EXAMPLE = Path(__file__).parents[1] / "examples" / "thesis_160km.toml"


def seconds(environment: dict[str, str], folder: str) -> float:
    """Wall-clock time of one process."""
    command = [sys.executable, "-c", "from tpss.cli.main import main; main()", "run", str(EXAMPLE)]
    started = time.perf_counter()
    subprocess.run(
        [*command, "--out", f"{folder}/result", "--force"],
        env=environment, check=True, capture_output=True,
    )  # fmt: skip
    return time.perf_counter() - started


def main() -> None:
    with tempfile.TemporaryDirectory() as folder:
        environment = {**os.environ, "NUMBA_CACHE_DIR": f"{folder}/kernels"}
        print(f"cold kernel cache: {seconds(environment, folder):.1f} s")
        warm = [seconds(environment, folder) for _ in range(5)]
        print(f"warm kernel cache: {statistics.median(warm):.2f} s (median of {len(warm)})")


if __name__ == "__main__":
    main()
