"""What the README shows is run as it stands."""

import re
import tomllib
from pathlib import Path

ROOT = Path(__file__).parents[2]
README = (ROOT / "README.md").read_text("utf-8")


def test_the_python_example_runs(tmp_path, monkeypatch, capsys):
    (tmp_path / "examples").symlink_to(ROOT / "examples")
    monkeypatch.chdir(tmp_path)
    (snippet,) = re.findall(r"```python\n(.*?)```", README, re.DOTALL)
    exec(compile(snippet, "README.md", "exec"), {})
    assert "eastbound 1" in capsys.readouterr().out
    assert (tmp_path / "results" / "table-3-3" / "result.nc").is_file()


def test_the_pipeline_on_a_clean_checkout_uses_the_readme_s_commands():
    blocks = re.findall(r"```\n(.*?)```", README, re.DOTALL)
    pipeline = (ROOT / ".ci" / "run").read_text("utf-8")
    assert blocks[0].splitlines() == ["pip install .", "tpss run examples/thesis_160km.toml"]
    install, test = blocks[1].splitlines()
    assert test in pipeline
    assert install.removeprefix("pip install ") in pipeline


def test_the_pipeline_tries_the_lowest_versions():
    """Of what the program needs; a requirement without a bound would be tried as it is today."""
    pipeline = (ROOT / ".ci" / "run").read_text("utf-8")
    assert '\n.ci/lowest > "$venv.lowest" 2>&1 &\nlowest=$!\n' in pipeline
    assert pipeline.endswith('\nwait "$lowest" || failed=$?\ncat "$venv.lowest"\nexit "$failed"\n')
    project = tomllib.loads((ROOT / "pyproject.toml").read_text("utf-8"))["project"]
    assert all(re.fullmatch(r"[\w-]+>=[\d.]+", needed) for needed in project["dependencies"])


def test_the_product_speaks_of_itself_only():
    """No path of another folder, no mention of where it was made."""
    files = [*ROOT.glob("*.md"), *ROOT.glob("docs/**/*"), *ROOT.glob("examples/**/*")]
    for file in (file for file in files if file.is_file() and file.suffix != ".png"):
        text = file.read_text("utf-8")
        assert "../shared" not in text, file
        assert "model.md" not in text, file
