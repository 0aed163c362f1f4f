"""Kernels that come compiled with the package: used where all fits, else compiled as ever."""

import logging
import pickle
import sys
import zipfile

import numba
import pytest

from tpss import kernel_cache, shipped
from tpss.kernel_cache import KernelCache
from tpss.shipped import LEVELS, Shipped, file_name, key_of, levels_of, name_of

LEVEL = "x86-64-v3"


def twice(number):
    return 2.0 * number


@pytest.fixture
def made(tmp_path, monkeypatch):
    """Makes `twice` anew, with a user's cache in a folder of its own, and shipped kernels or none."""

    def make(folder, shipped):
        monkeypatch.setattr(numba.config, "CACHE_DIR", str(tmp_path / folder))
        compiled = numba.njit(cache=True, no_cfunc_wrapper=True, _nrt=False)(twice)
        compiled._cache = KernelCache(twice, lambda: shipped)
        return compiled

    return make


@pytest.fixture
def archive(tmp_path, made):
    """A file with the code of `twice` for floats, as the tool writes it from numba's cache."""
    compiled = made("whoever made it", None)
    assert compiled(1.5) == 3.0
    [(key, code)] = compiled._cache._cache_file._load_index().items()
    path = tmp_path / "kernels.zip"
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as file:
        file.writestr(f"{name_of(twice)}.index", pickle.dumps({key_of(key, LEVEL): "0"}))
        file.writestr("0", (compiled._cache.index.parent / code).read_bytes())
    return path


@pytest.fixture
def fresh(made):
    """Makes `twice` for somebody with an empty cache, and a file of shipped kernels."""
    return lambda path, level=LEVEL: made("cache", Shipped(path, level))


def test_what_is_shipped_is_not_compiled(archive, fresh, tmp_path):
    compiled = fresh(archive)
    assert compiled(4.0) == 8.0
    assert sum(compiled.stats.cache_hits.values()) == 1
    assert not [*(tmp_path / "cache").rglob("*.nbc")]


def test_code_for_another_level_is_not_taken(archive, fresh, tmp_path):
    compiled = fresh(archive, "x86-64-v4")
    assert compiled(4.0) == 8.0
    assert sum(compiled.stats.cache_misses.values()) == 1
    assert [*(tmp_path / "cache").rglob("*.nbc")]


def test_other_types_are_compiled_as_ever(archive, fresh):
    compiled = fresh(archive)
    assert compiled(3 + 1j) == 6 + 2j
    assert sum(compiled.stats.cache_misses.values()) == 1


def test_a_damaged_file_is_told_and_done_without(archive, fresh, monkeypatch, caplog):
    """A byte in the middle of the code is another one: the checksum of the archive does not fit."""
    monkeypatch.setattr(kernel_cache, "_told", set())
    damaged = bytearray(archive.read_bytes())
    with zipfile.ZipFile(archive) as file:
        damaged[file.getinfo("0").header_offset + 200] ^= 0xFF
    archive.write_bytes(bytes(damaged))
    with caplog.at_level(logging.WARNING, "tpss.kernels"):
        assert fresh(archive)(4.0) == 8.0
    assert "what is damaged is compiled anew" in caplog.text


def test_a_processor_has_the_levels_all_of_whose_features_it_has(monkeypatch):
    monkeypatch.setattr(shipped.platform, "machine", lambda: "x86_64")
    with_avx2 = dict.fromkeys(LEVELS["x86-64-v3"], True)
    assert levels_of(with_avx2) == ["x86-64-v3"]
    assert levels_of(dict.fromkeys(LEVELS["x86-64-v4"], True)) == ["x86-64-v4", "x86-64-v3"]
    assert levels_of({**with_avx2, "fma": False}) == []


def test_other_machines_have_none(monkeypatch):
    monkeypatch.setattr(shipped.platform, "machine", lambda: "arm64")
    assert levels_of(dict.fromkeys(LEVELS["x86-64-v4"], True)) == []


def test_the_name_of_a_file_says_all_that_has_to_fit():
    name = file_name("0123456789abcdef", LEVEL)
    python = f"cp{sys.version_info[0]}{sys.version_info[1]}"
    assert name.startswith(f"0123456789abcdef-{python}")
    assert name.endswith(f"-{LEVEL}.zip")
    assert sys.platform in name
    assert shipped.llvmlite.__version__ in name


def test_without_files_that_fit_there_are_none(tmp_path, monkeypatch):
    monkeypatch.setattr(shipped, "FOLDER", tmp_path)
    assert shipped.shipped.__wrapped__("0123456789abcdef") is None


def test_a_processor_that_was_named_is_compiled_for(archive, tmp_path, monkeypatch):
    monkeypatch.setattr(shipped, "FOLDER", tmp_path)
    for level in LEVELS:
        archive.with_name(file_name("0123456789abcdef", level)).write_bytes(archive.read_bytes())
    monkeypatch.setattr(numba.config, "CPU_NAME", "generic")
    assert shipped.shipped.__wrapped__("0123456789abcdef") is None
