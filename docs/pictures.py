"""Draw the pictures of the README, of guides and of the gallery: ``python docs/pictures.py``.

Reports are photographed in Chromium, by Playwright (``pip install "tpss[test]"``).
"""

import io
import shlex
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path
from typing import Any

from PIL import Image
from playwright.sync_api import sync_playwright

import tpss
from tpss.planning.figures.catalogue import FIGURES as OF_A_PLAN
from tpss.planning.written import read_written
from tpss.report.figures import draw
from tpss.report.render.static import render

DOCS = Path(__file__).parent
sys.path.append(str(DOCS / "generate"))
import gallery_page  # noqa: E402, found where the line above says

PICTURES = DOCS / "figures"
SCENARIO = "thesis-3-7-2"
STUDIO = "thesis-160km"
STUDIO_SIZE = {"width": 1280, "height": 1000}
MINUTE = 64
SIZE = {"width": 1100, "height": 1440}
PLAN_SIZE = {"width": 960, "height": 880}
WIDEST_PX = 1400
"""Of pictures of the gallery."""


def main() -> None:
    """Run the scenario, and the examples of the gallery, and write all pictures."""
    result = tpss.simulate(tpss.load_scenario(tpss.examples.path(SCENARIO)))
    drawn = io.BytesIO()
    draw("time-distance", result).savefig(drawn, format="png", dpi=130)
    keep(drawn.getvalue(), PICTURES / "time_distance.png")
    photograph_studio()
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        report = tpss.write_report(result, folder / "report.html")
        keep(photograph(report), PICTURES / "report.png")
        draw_gallery(folder)
        report = folder / gallery_page.result_of(gallery_page.PLAN) / "report.html"
        keep(photograph(report, PLAN_SIZE, "decision-tree-0-title"), PICTURES / "plan.png")


def draw_gallery(folder: Path) -> None:
    """Draw the pictures of the gallery by the commands that it shows, each called once."""
    shown = [figure for figures in gallery_page.KINDS.values() for figure in figures()]
    for call in dict.fromkeys(call for figure in shown for call in figure.calls):
        subprocess.run([sys.executable, "-m", *shlex.split(call)], cwd=folder, check=True)
    written = read_written(folder / gallery_page.result_of(gallery_page.PLAN))
    for name, figure in OF_A_PLAN.items():
        if drawing := figure.describe(written, written.areas[0]):
            render(drawing).savefig(folder / f"{name}.png", dpi=200, bbox_inches="tight")
    for figure in shown:
        keep((folder / f"{figure.name}.png").read_bytes(), DOCS / figure.picture, WIDEST_PX)


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


def photograph_studio() -> None:
    """Two views of the studio: a transformer that was moved, and what follows from the headway."""
    with tempfile.TemporaryDirectory() as folder, sync_playwright() as program:
        copied = ["new", ".", "--from", STUDIO]
        subprocess.run([sys.executable, "-m", "tpss", *copied], cwd=folder, check=True)
        file = tpss.examples.path(STUDIO).name
        command = [sys.executable, "-m", "tpss", "studio", file, "--no-browser"]
        with subprocess.Popen(command, cwd=folder, stdout=subprocess.PIPE, text=True) as server:
            assert server.stdout is not None
            home = server.stdout.readline().split()[-1]
            browser = program.chromium.launch(
                executable_path=shutil.which("chromium"), args=["--no-sandbox", "--disable-gpu"]
            )
            page = browser.new_page(viewport=STUDIO_SIZE)
            page.goto(home)
            page.wait_for_selector("body[data-number]", timeout=180_000)
            page.get_by_role("slider", name="Transformer").nth(1).focus()
            for _ in range(8):
                page.keyboard.press("Shift+ArrowLeft")
            page.wait_for_timeout(3_000)  # the step is checked once the hand rests
            keep(page.screenshot(), PICTURES / "studio.png")
            page.get_by_role("tab", name="What if").click()
            page.get_by_role("button", name="Response curve").click()
            page.get_by_role("button", name="Find").click()
            page.wait_for_timeout(5_000)
            keep(page.screenshot(), PICTURES / "studio_what_if.png")
            browser.close()
            server.kill()


def keep(picture: bytes, file: Path, widest_px: int | None = None) -> None:
    """Store a picture in 256 colours, which are enough, and halve its file."""
    file.parent.mkdir(exist_ok=True)
    with Image.open(io.BytesIO(picture)) as opened:
        if widest_px is not None:
            opened.thumbnail((widest_px, widest_px))
        opened.convert("RGB").quantize(256).save(file, optimize=True)


if __name__ == "__main__":
    main()
