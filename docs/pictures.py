"""Draw the pictures of the README: ``python docs/pictures.py``.

The report is photographed in Chromium, by Playwright (``pip install "tpss[test]"``).
"""

import io
import shutil
import tempfile
from pathlib import Path

from PIL import Image
from playwright.sync_api import sync_playwright

import tpss
from tpss.report.figures import draw

ROOT = Path(__file__).parents[1]
PICTURES = Path(__file__).parent / "figures"
SCENARIO = ROOT / "examples" / "thesis_3_7_2.toml"
MINUTE = 64
SIZE = {"width": 1100, "height": 1440}


def main() -> None:
    """Run the scenario, and write both pictures."""
    result = tpss.simulate(tpss.load_scenario(SCENARIO))
    drawn = io.BytesIO()
    draw("time-distance", result).savefig(drawn, format="png", dpi=130)
    keep(drawn.getvalue(), "time_distance.png")
    with tempfile.TemporaryDirectory() as folder:
        keep(photograph(tpss.write_report(result, Path(folder) / "report.html")), "report.png")


def photograph(report: Path) -> bytes:
    """The plots of a report at a moment, as a browser shows them."""
    with sync_playwright() as program:
        browser = program.chromium.launch(
            executable_path=shutil.which("chromium"), args=["--no-sandbox", "--disable-gpu"]
        )
        page = browser.new_page(viewport=SIZE)
        page.goto(report.as_uri())
        page.wait_for_selector("body[data-ready]")
        page.locator("#time").fill(str(MINUTE))
        page.locator("#time").blur()
        page.evaluate("document.getElementById('plots').scrollIntoView()")
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
