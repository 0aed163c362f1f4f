"""An edited formula never keeps its old compiled result, and damaged or missing files cost time only."""

import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from tpss.kernel import KERNEL_PACKAGES, source_digest

SOURCE = Path(__file__).parents[2] / "src" / "tpss"


def test_an_edit_in_any_kernel_source_changes_the_digest(tmp_path):
    shutil.copytree(SOURCE, tmp_path / "tpss")
    digests = {source_digest(tmp_path / "tpss")}
    for name in KERNEL_PACKAGES:
        file = next(iter(sorted((tmp_path / "tpss" / name).glob("[a-z]*.py"))))
        file.write_text(file.read_text("utf-8") + "\n# edited\n", "utf-8")
        digests.add(source_digest(tmp_path / "tpss"))
    assert len(digests) == len(KERNEL_PACKAGES) + 1


def test_kernels_that_are_compiled_otherwise_have_another_digest(tmp_path):
    shutil.copytree(SOURCE, tmp_path / "tpss")
    before, options = source_digest(tmp_path / "tpss"), tmp_path / "tpss" / "kernel.py"
    text = options.read_text("utf-8")
    assert '"fastmath": {"contract"}' in text
    options.write_text(text.replace('"fastmath": {"contract"}', '"fastmath": False'), "utf-8")
    assert source_digest(tmp_path / "tpss") != before


def test_an_edited_formula_takes_effect_in_the_kernels_that_call_it(tmp_path):
    """Gravity is edited in another file than the compiled, cached `adhesion_limit` that uses it."""
    shutil.copytree(SOURCE, tmp_path / "tpss")
    script = (
        "from tpss.physics.adhesion import adhesion_limit\n"
        "print(adhesion_limit(1.0, 0.0, 0) / (0.161 + 7.5 / 44.0))\n"
    )
    environment = {
        **os.environ,
        "NUMBA_CACHE_DIR": str(tmp_path / "c"),
        "PYTHONPATH": str(tmp_path),
    }

    def run():
        call = [sys.executable, "-c", script]
        done = subprocess.run(
            call, env=environment, cwd=tmp_path, capture_output=True, text=True, check=True
        )
        return round(float(done.stdout), 6)

    assert run() == 9.81
    constants = tmp_path / "tpss" / "physics" / "constants.py"
    edited = constants.read_text("utf-8").replace("GRAVITY_M_S2 = 9.81", "GRAVITY_M_S2 = 1.62")
    constants.write_text(edited, "utf-8")
    assert run() == 1.62


OWN_KERNEL = """
import logging, sys
logging.basicConfig(format="%(message)s", level=logging.WARNING, stream=sys.stdout)
from own import double
print(double(2.0), sum(double.stats.cache_hits.values()))
"""


def run_own_kernel(folder, **more):
    """What a process prints that runs a kernel of its own, with its cache in a folder."""
    (folder / "own.py").write_text(
        "from tpss.kernel import kernel\n\n\n@kernel\ndef double(x):\n    return 2.0 * x\n"
    )
    environment = {**os.environ, "NUMBA_CACHE_DIR": str(folder / "cache"), **more}
    environment.pop("NUMBA_DISABLE_JIT", None)
    done = subprocess.run(
        [sys.executable, "-c", OWN_KERNEL], cwd=folder, env=environment, text=True, check=True,
        capture_output=True,
    )  # fmt: skip
    return done.stdout


@pytest.mark.parametrize("suffix", ["nbi", "nbc"])
@pytest.mark.parametrize("share", [0.0, 0.5])
def test_a_damaged_kernel_is_compiled_anew(tmp_path, suffix, share):
    """An emptied file, and one that is cut off, as a loss of power leaves them."""
    assert run_own_kernel(tmp_path) == "4.0 0\n"
    assert run_own_kernel(tmp_path) == "4.0 1\n"
    (file,) = (tmp_path / "cache").rglob(f"*.{suffix}")
    content = file.read_bytes()
    file.write_bytes(content[: int(share * len(content))])
    said = run_own_kernel(tmp_path)
    assert said.startswith("the cache of compiled kernels cannot be read: ")
    assert said.endswith("what is damaged is compiled anew\n4.0 0\n")
    assert run_own_kernel(tmp_path) == "4.0 1\n"


@pytest.mark.parametrize("suffix", ["nbi", "nbc"])
def test_a_kernel_with_another_bit_is_compiled_anew(tmp_path, suffix):
    """Machine code of which a bit is another one can be read; what it does then, nobody knows."""
    run_own_kernel(tmp_path)
    (file,) = (tmp_path / "cache").rglob(f"*.{suffix}")
    content = bytearray(file.read_bytes())
    content[len(content) // 2] ^= 4
    file.write_bytes(content)
    assert "is not as it was written; what is damaged is" in run_own_kernel(tmp_path)
    assert run_own_kernel(tmp_path) == "4.0 1\n"


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="no disk that is full here")
def test_without_room_kernels_stay_in_memory(tmp_path, monkeypatch):
    code = OWN_KERNEL.replace(
        "from own",
        "import os; os.replace = lambda *_: open('/dev/full', 'wb', 0).write(b'x')\nfrom own",
    )
    monkeypatch.setitem(globals(), "OWN_KERNEL", code)
    said = run_own_kernel(tmp_path)
    assert "cannot be written: [Errno 28] No space left on device; the next start" in said
    assert said.endswith("4.0 0\n")
