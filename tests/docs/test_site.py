"""The site as its readers have it: in a folder, without a server, in a browser."""

import os
import shutil
import subprocess
import sys
from functools import partial
from html.parser import HTMLParser
from http.server import SimpleHTTPRequestHandler, ThreadingHTTPServer
from pathlib import Path
from threading import Thread
from urllib.parse import unquote, urlsplit

import pytest
from filelock import FileLock

ROOT = Path(__file__).parents[2]
PAGES = (
    "index", "approximator", "how-to/outages", "reference/python", "theory/train",
    "source/physics/locomotive",
)  # fmt: skip
"""Pages that have all kinds of content between them."""

IN_THE_DARK = ("index", "theory/train", "source/physics/locomotive")
"""Pages that have all colours between them."""


class Anchors(HTMLParser):
    """What a page leads to or shows, and the anchors that it has."""

    def __init__(self, text: str) -> None:
        super().__init__()
        self.targets: list[str] = []
        self.anchors: set[str] = {"", "__top"}
        self.feed(text)

    def handle_starttag(self, tag, attrs):
        found = dict(attrs)
        self.anchors |= {value for name in ("id", "name") if (value := found.get(name))}
        self.targets += [value for name in ("href", "src") if (value := found.get(name))]


@pytest.fixture(scope="session")
def site(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The site, built once for all processes of a test run."""
    pytest.importorskip("zensical", reason="what builds the site is not installed")
    base = tmp_path_factory.getbasetemp()
    shared = base.parent if "PYTEST_XDIST_WORKER" in os.environ else base
    project = shared / "project"
    with FileLock(shared / "site.lock"):
        if not project.exists():
            build(project)
    return project / "site"


def build(project: Path) -> None:
    """Build the site of a copy of the documentation."""
    project.mkdir()
    for name in ("docs", "benchmarks", "tools"):
        shutil.copytree(ROOT / name, project / name, ignore=shutil.ignore_patterns("source"))
    for name in ("mkdocs.yml", "CHANGELOG.md", "CITATION.cff"):
        shutil.copy(ROOT / name, project)
    (project / "src").symlink_to(ROOT / "src")
    call = [sys.executable, "docs/site", "build", "--strict"]
    done = subprocess.run(call, cwd=project, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout + done.stderr


def test_every_link_leads_somewhere(site):
    pages = {file: Anchors(file.read_text("utf-8")) for file in site.rglob("*.html")}
    del pages[site / "404.html"]  # served in place of any page, so that its links begin at /
    dead = [
        f"{file.relative_to(site)}: {target}"
        for file, page in pages.items()
        for target in page.targets
        if not leads(file, target, pages)
    ]
    assert dead == []


def leads(file: Path, target: str, pages: dict[Path, Anchors]) -> bool:
    """Whether a link of a page leads to a file of the site, and to an anchor in it, or out of it."""
    parts = urlsplit(target)
    if parts.scheme or parts.netloc:
        return True
    to = Path(os.path.normpath(file.parent / unquote(parts.path))) if parts.path else file
    return to.is_file() and (to not in pages or unquote(parts.fragment) in pages[to].anchors)


def test_every_page_is_in_the_menu(site):
    menu = Anchors((site / "index.html").read_text("utf-8")).targets
    pages = {
        file.relative_to(ROOT / "docs").with_suffix(".html").as_posix()
        for file in (ROOT / "docs").rglob("*.md")
    }
    assert pages - {os.path.normpath(urlsplit(target).path) for target in menu} == set()


def test_equations_are_one_click_from_their_code(site):
    page = Anchors((site / "equations.html").read_text("utf-8"))
    assert any(
        target.startswith("source/physics/") and "#line-" in target for target in page.targets
    )


def test_a_formula_needs_no_script(site):
    page = (site / "theory" / "train.html").read_text("utf-8")
    assert "<math" in page
    assert "arithmatex" not in page


def test_a_name_of_a_source_file_that_is_gone_stops_the_build(site, tmp_path):
    """As no link would be checked that was never made."""
    project = tmp_path / "project"
    project.mkdir()
    shutil.copytree(ROOT / "docs" / "extensions", project / "docs" / "extensions")
    shutil.copytree(ROOT / "docs" / "site", project / "docs" / "site")
    (project / "docs" / "index.md").write_text("`physics/converter_of_yesterday.py`", "utf-8")
    (project / "src").symlink_to(ROOT / "src")
    (project / "CHANGELOG.md").touch()
    settings = "site_name: x\nmarkdown_extensions: [source_links:SourceLinks]\n"
    (project / "mkdocs.yml").write_text(settings, "utf-8")
    call = [sys.executable, "docs/site", "build", "--strict"]
    done = subprocess.run(call, cwd=project, capture_output=True, text=True, check=False)
    assert done.returncode != 0
    assert "physics/converter_of_yesterday.py, which does not exist" in done.stdout + done.stderr


def test_the_search_finds_pages_from_a_folder(site, browser):
    requests: list[str] = []
    tab = browser.new_page()
    tab.on("request", lambda request: requests.append(request.url))
    tab.goto((site / "how-to" / "install.html").as_uri())
    tab.keyboard.press("/")
    tab.keyboard.type("mean useful voltage", delay=20)
    found = tab.locator("a[href*='evidence-for-standards.html']", has_text="voltage")
    found.first.wait_for(timeout=30_000)
    found.first.click()
    tab.wait_for_url("**/evidence-for-standards.html*")
    tab.close()
    assert [url for url in requests if not url.startswith(("file:", "data:", "blob:"))] == []


@pytest.mark.parametrize(("scheme", "pages"), [("light", PAGES), ("dark", IN_THE_DARK)])
def test_pages_have_no_barriers_that_axe_knows(site, browser, scheme, pages):
    """Rules of WCAG and good practice, checked by axe-core: contrast, names, landmarks, keyboard."""
    axe = pytest.importorskip("axe_playwright_python.sync_playwright").Axe()
    found: dict[str, list[str]] = {}
    tab = browser.new_page(color_scheme=scheme)
    for page in pages:
        tab.goto((site / f"{page}.html").as_uri())
        tab.wait_for_load_state("networkidle")
        for rule in axe.run(tab).response["violations"]:
            found[f"{page}: {rule['id']}"] = [node["html"] for node in rule["nodes"]]
    tab.close()
    assert found == {}


def test_the_page_that_is_served_for_a_missing_one_has_no_barriers(site, browser):
    """Its links begin at the root of the server, so that a folder is not enough to see it."""
    axe = pytest.importorskip("axe_playwright_python.sync_playwright").Axe()
    handler = partial(SimpleHTTPRequestHandler, directory=site)
    with ThreadingHTTPServer(("127.0.0.1", 0), handler) as server:
        Thread(target=server.serve_forever, daemon=True).start()
        tab = browser.new_page()
        tab.goto(f"http://127.0.0.1:{server.server_port}/404.html")
        tab.wait_for_load_state("networkidle")
        violations = axe.run(tab).response["violations"]
        tab.close()
        server.shutdown()
    assert violations == []
