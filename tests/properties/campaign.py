"""Many random scenarios, some spoilt, some crowded, each judged; a tally of outcomes, and the faults.

    python -m tests.properties.campaign --cases 10000 --seed 1
    python -m tests.properties.campaign --cases 10000 --seed 1 --kind "feeding back"

The same seed gives the same cases.  A fault is shrunk to its smallest scenario, which is printed as
a Python literal: `judge` of it shows the fault again.  The exit code is 1 if there were faults.
"""

import os

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")  # small matrices: threads only cost

import argparse
import sys
import time
import traceback
import warnings
from collections import Counter
from collections.abc import Callable
from typing import Any

from hypothesis import HealthCheck, Phase, given, seed, settings

from .crowds import crowded_scenarios
from .judge import judge, warm_up
from .own_laws import scenarios_by_own_laws
from .strategies import (
    direct_scenarios,
    network_scenarios,
    scenarios_of_conductors,
    scenarios_that_feed_back,
    sound_scenarios,
    spoilt_scenarios,
)
from .together import judge_together, like_cases

Document = dict[str, Any]

BATCH = 250
"""Cases that share a seed; the first fault of a batch ends it."""

KINDS = {
    "sound": sound_scenarios,
    "spoilt": spoilt_scenarios,
    "crowded": crowded_scenarios,
    "feeding back": scenarios_that_feed_back,
    "direct current": direct_scenarios,
    "conductors": scenarios_of_conductors,
    "networks": network_scenarios,
    "laws of one's own": lambda: scenarios_by_own_laws(sound_scenarios()),
    "like cases": lambda: like_cases(sound_scenarios()),
}

JUDGES: dict[str, Callable[[Document], str]] = {"like cases": judge_together}
"""Of kinds that have one of their own."""


class Campaign:
    """What has come of the cases so far; faults are printed when they are found, and at the end."""

    def __init__(self, shrink: bool = True) -> None:
        self.phases = [Phase.generate, Phase.shrink] if shrink else [Phase.generate]
        self.tally: Counter[tuple[str, str]] = Counter()
        self.faults: dict[str, Document] = {}
        self.slowest_s = 0.0

    def run_batch(self, title: str, number: int, cases: int) -> None:
        """Judge so many cases of one kind; note the faults that end them, if there are any."""
        found: dict[str, Document] = {}

        @seed(number)
        @settings(
            max_examples=cases,
            database=None,
            deadline=None,
            phases=self.phases,
            suppress_health_check=list(HealthCheck),
            print_blob=False,
        )
        @given(KINDS[title]())
        def look(document: Document) -> None:
            started = time.perf_counter()
            try:
                self.tally[title, JUDGES.get(title, judge)(document)] += 1
            except Exception as error:
                found[_place_of(error)] = document  # the last one that shows it is the smallest
                raise
            self.slowest_s = max(self.slowest_s, time.perf_counter() - started)

        try:
            look()
        except Exception as error:
            faults = error.exceptions if isinstance(error, ExceptionGroup) else [error]
            for fault in faults:
                self.tally[title, "fault"] += 1
                words = f"{_place_of(fault)}: {fault}".splitlines()[0]
                self.faults.setdefault(words, found[_place_of(fault)])
                print(f"\n{words}\n{found[_place_of(fault)]!r}", flush=True)

    def report(self) -> None:
        """Print tally and faults."""
        print(f"\n{sum(self.tally.values())} cases, the slowest took {self.slowest_s:.1f} s")
        for title in KINDS:
            print(f"\n{title} scenarios")
            for (of, outcome), count in sorted(self.tally.items(), key=lambda item: -item[1]):
                if of == title:
                    print(f"{count:8d}  {outcome}")
        print(f"\n{len(self.faults)} faults")
        for fault, document in self.faults.items():
            print(f"\n{fault}\n{document!r}")


def _place_of(error: Exception) -> str:
    """Kind of an exception and where it was raised: what tells faults apart."""
    where = traceback.extract_tb(error.__traceback__)[-1]
    return f"{type(error).__name__} in {where.name}, line {where.lineno}"


def main() -> int:
    """Run a campaign; return the exit code."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--cases", type=int, default=10_000)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--kind", choices=list(KINDS), help="only cases of this kind")
    parser.add_argument(
        "--shrink", action=argparse.BooleanOptionalAction, default=True,
        help="whether faults are made smaller, which may take minutes each",
    )  # fmt: skip
    asked = parser.parse_args()
    warnings.simplefilter("error")
    warm_up()
    campaign = Campaign(asked.shrink)
    for begun in range(0, asked.cases, BATCH):
        number = begun // BATCH
        title = asked.kind or list(KINDS)[number % len(KINDS)]
        campaign.run_batch(title, 100_000 * asked.seed + number, min(BATCH, asked.cases - begun))
        print(f"\r{begun + BATCH} cases, {len(campaign.faults)} faults", end="", file=sys.stderr)
    campaign.report()
    return 1 if campaign.faults else 0


if __name__ == "__main__":
    sys.exit(main())
