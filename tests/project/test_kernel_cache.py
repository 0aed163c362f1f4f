"""An edited formula never keeps its old compiled result."""

import os
import shutil
import subprocess
import sys
from pathlib import Path

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
