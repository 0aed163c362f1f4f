"""The studio in a browser: from a key press or a drag to redrawn curves, and the first picture.

    python benchmarks/studio.py --presses 60

Chromium shows the page at 1280 by 900 px.  A press ends with the frame after the curves of its answer
were drawn; the next press waits for that.  Of a burst, keys come every 30 ms, and the time is that from
the last of them.  The server is a process of its own, whose kernels are warm.
"""

import re
import shutil
import statistics
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from playwright.sync_api import Page, sync_playwright

from report import ROOT, arguments, caption, deliver, machine, table

CASES = {
    "thesis_160km": "headway in min",
    "line_320km": "headway in min",
    "at_headway_3": "headway in min",
    "network": "time step in min",
}
"""Examples, and the fields that are edited."""

SIZE = {"width": 1280, "height": 900}
BURST, BETWEEN_MS = 8, 30
OPENED = 5

WATCH = """() => {
    const seen = window.seen = { pressed: 0, times: [] };
    const begin = event => { seen.pressed = event.timeStamp; };
    addEventListener("keydown", begin, true);
    addEventListener("pointermove", event => { if (event.buttons) begin(event); }, true);
    new MutationObserver(() => requestAnimationFrame(() => setTimeout(() => {
        if (seen.pressed) seen.times.push(performance.now() - seen.pressed);
        seen.done = document.body.dataset.number;
    }))).observe(document.body, { attributeFilter: ["data-number"] });
}"""


@contextmanager
def served(file: Path) -> Iterator[str]:
    """Serve a scenario, and give its address once kernels are warm."""
    command = [sys.executable, "-m", "tpss", "studio", str(file), "--no-browser"]
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as server:
        assert server.stdout is not None
        found = re.search(r"http://\S+", server.stdout.readline())
        assert found is not None
        try:
            yield found[0]
        finally:
            server.kill()


def main() -> None:
    options = arguments(__doc__, presses=60)
    result: dict[str, Any] = {"machine": machine(), "cases": {}}
    with sync_playwright() as program, tempfile.TemporaryDirectory() as folder:
        browser = program.chromium.launch(
            executable_path=shutil.which("chromium"),
            args=["--no-sandbox", "--disable-gpu", "--disable-dev-shm-usage"],
        )
        shutil.copytree(ROOT / "examples", folder, dirs_exist_ok=True)
        for case, field in CASES.items():
            with served(Path(folder) / f"{case}.toml") as home:
                result["cases"][case] = measured(browser, home, field, options.presses)
            print(case, result["cases"][case], flush=True)
        browser.close()
    head = (
        "case",
        "key press [ms]",
        "95 %",
        "burst of 8 keys [ms]",
        "drag [ms]",
        "first picture [s]",
    )
    rows = [
        (
            name,
            *(f"{each[key]:.0f}" for key in ("press", "press_95", "burst", "drag")),
            f"{each['first_s']:.2f}",
        )
        for name, each in result["cases"].items()
    ]
    deliver(
        "studio", result, f"{table(head, rows)}\n\n{caption(result['machine'])}", options.publish
    )


def measured(browser: Any, home: str, field: str, presses: int) -> dict[str, float]:
    """Medians of one scenario, and the 95th percentile of key presses."""
    first = [opened_in(browser, home) for _ in range(OPENED + 1)][
        1:
    ]  # the first one warms the server
    page = browser.new_page(viewport=SIZE)
    open_page(page, home)
    page.wait_for_timeout(3_000)  # the check of the step is over
    if not page.get_by_role("textbox", name=field, exact=True).count():
        page.get_by_text("simulation", exact=True).click()
    page.get_by_role("textbox", name=field, exact=True).first.focus()
    page.evaluate(WATCH)
    keys = presses_of(page, presses, lambda k: page.keyboard.press(("ArrowUp", "ArrowDown")[k % 2]))
    bursts = presses_of(page, presses // 8, lambda _: burst(page))
    handle = page.get_by_role("slider", name=re.compile("^(Feeding|Station)")).first
    box = handle.bounding_box()
    x, y = box["x"] + box["width"] / 2, box["y"] + box["height"] / 2
    page.mouse.move(x, y)
    page.mouse.down()
    drags = presses_of(page, presses // 2, lambda k: page.mouse.move(x + 8 * (1 + k % 5), y))
    page.mouse.up()
    page.close()
    return {
        "press": statistics.median(keys),
        "press_95": sorted(keys)[int(0.95 * len(keys))],
        "burst": statistics.median(bursts),
        "drag": statistics.median(drags),
        "first_s": statistics.median(first),
    }


def presses_of(page: Page, count: int, press: Callable[[int], None]) -> list[float]:
    """Times from each press to the frame that shows what came of it. [ms]"""
    times = []
    for k in range(count):
        page.evaluate("() => { window.seen.times = []; }")
        press(k)
        times.append(until_settled(page))
        page.wait_for_timeout(150)  # before the check begins, which the next press would end
    return times


def until_settled(page: Page) -> float:
    ends = time.monotonic() + 30.0
    while time.monotonic() < ends:
        seen = page.evaluate("() => [window.seen.times.at(-1), document.body.dataset.answered]")
        if seen[0] is not None and seen[1] == "true":
            return float(page.evaluate("() => window.seen.times.at(-1)"))
        page.wait_for_timeout(5)
    raise TimeoutError("nothing was drawn")


def burst(page: Page) -> None:
    for k in range(BURST):
        page.keyboard.press("ArrowUp" if k < BURST // 2 + 1 else "ArrowDown")
        page.wait_for_timeout(BETWEEN_MS)


def opened_in(browser: Any, home: str) -> float:
    """Time until a page shows its first picture. [s]"""
    page = browser.new_page(viewport=SIZE)
    begin = time.perf_counter()
    open_page(page, home)
    taken = time.perf_counter() - begin
    page.close()
    return taken


def open_page(page: Page, home: str) -> None:
    page.goto(home)
    page.wait_for_selector("body[data-number]", timeout=180_000)


if __name__ == "__main__":
    main()
