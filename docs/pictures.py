"""Draw the pictures of the README and of guides: ``python docs/pictures.py``.

Reports are photographed in Chromium, by Playwright (``pip install "tpss[test]"``).
"""

import io
import shutil
import tempfile
from pathlib import Path
from typing import Any

from PIL import Image
from playwright.sync_api import sync_playwright

import tpss
from tpss.report.figures import draw

ROOT = Path(__file__).parents[1]
PICTURES = Path(__file__).parent / "figures"
SCENARIO = ROOT / "examples" / "thesis_3_7_2.toml"
PLAN = ROOT / "examples" / "plan_320km.toml"
MINUTE = 64
SIZE = {"width": 1100, "height": 1440}
PLAN_SIZE = {"width": 960, "height": 880}


def main() -> None:
    """Run the scenario and the plan, and write all pictures."""
    result = tpss.simulate(tpss.load_scenario(SCENARIO))
    drawn = io.BytesIO()
    draw("time-distance", result).savefig(drawn, format="png", dpi=130)
    keep(drawn.getvalue(), "time_distance.png")
    with tempfile.TemporaryDirectory() as folder:
        keep(photograph(tpss.write_report(result, Path(folder) / "report.html")), "report.png")
        tpss.run_plan(tpss.load_plan(PLAN), Path(folder) / "plan")
        report = tpss.write_plan_report(Path(folder) / "plan")
        keep(photograph(report, PLAN_SIZE, "decision-tree-0-title"), "plan.png")


def photograph(report: Path, size: Any = SIZE, begins_at: str = "plots") -> bytes:
    """What a report shows from an element on, as a browser shows it; moving plots at a moment."""
    with sync_playwright() as program:
        browser = program.chromium.launch(
            executable_path=shutil.which("chromium"), args=["--no-sandbox", "--disable-gpu"]
        )
        page = browser.new_page(viewport=size)
        page.goto(report.as_uri())
        page.wait_for_selector("body[data-ready]")
        if page.locator("#time").count():
            page.locator("#time").fill(str(MINUTE))
            page.locator("#time").blur()
        page.evaluate(f"document.getElementById('{begins_at}').scrollIntoView()")
        page.wait_for_timeout(1_000)  # the trains move in the next frames
        picture = page.screenshot()
        browser.close()
    return picture


def keep(picture: bytes, name: str) -> None:
    """Store a picture in 256 colours, which are enough, and halve its file."""
    with Image.open(io.BytesIO(picture)) as opened:
        opened.convert("RGB").quantize(256).save(PICTURES / name, optimize=True)


if __name__ == "__main__":
    main()
