"""All benchmarks of the page `docs/benchmarks.md`, measured and published: ``python benchmarks``."""

import subprocess
import sys
from pathlib import Path

PUBLISHED = ("simulation", "many", "lanes", "peers", "scaling", "network", "stress", "collapses")


def main() -> None:
    for name in PUBLISHED:
        script = Path(__file__).with_name(f"{name}.py")
        subprocess.run([sys.executable, script, "--publish"], check=True)


if __name__ == "__main__":
    main()
