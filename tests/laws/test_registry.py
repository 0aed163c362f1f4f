"""Which laws there are: those of installed packages, and those of this process."""

import sys

import pytest

from laws.own_laws import CALM, DROOPS, TUNNEL, calm_speed_m_s
from tpss.laws import Law, LawError, known_laws, register
from tpss.laws import registry as registry_module
from tpss.laws.registry import find_law, laws_named

LAWS_PY = """
from tpss.laws import Law
from tpss.laws.kinds import DRIVER

def at_ease(speed_m_s, limit_m_s, position_m, to_stop_m):
    return 0.9 * limit_m_s

laws = [Law(DRIVER, "at-ease", at_ease, "nine tenths of the limit", "made up")]
"""


@pytest.fixture
def install(tmp_path, monkeypatch):
    """Installs a package of one module, as pip would leave it."""

    def put(name, module, text, at):
        (tmp_path / f"{module}.py").write_text(text)
        info = tmp_path / f"{name}-1.2.dist-info"
        info.mkdir()
        (info / "METADATA").write_text(f"Metadata-Version: 2.1\nName: {name}\nVersion: 1.2\n")
        (info / "entry_points.txt").write_text(f"[tpss.laws]\nmine = {module}{at}\n")
        sys.modules.pop(module, None)

    monkeypatch.syspath_prepend(str(tmp_path))
    monkeypatch.setattr(registry_module, "_registered", {})
    registry_module._of_packages.cache_clear()
    yield put
    registry_module._of_packages.cache_clear()


def test_a_package_offers_laws_at_an_entry_point(install):
    install("railway-laws", "railway_laws_a", LAWS_PY, ":laws")
    found = find_law("driver", "at-ease")
    assert found.origin == "railway-laws 1.2"
    assert found.in_words == f"driver law at-ease of railway-laws 1.2, {found.law.digest}"


def test_a_law_of_this_process_hides_one_of_a_package(install):
    install("railway-laws", "railway_laws_b", LAWS_PY, ":laws")
    register(Law(CALM.kind, "at-ease", calm_speed_m_s, "", "", CALM.parameters))
    assert find_law("driver", "at-ease").origin == "this process"


def test_an_unknown_law_is_told_with_those_there_are(install):
    install("railway-laws", "railway_laws_c", LAWS_PY, ":laws")
    with pytest.raises(LawError, match="no driver law 'hasty': take one of at-ease, or install"):
        find_law("driver", "hasty")
    with pytest.raises(LawError, match="no resistance law 'at-ease': install the package"):
        find_law("resistance", "at-ease")


def test_two_packages_with_laws_of_one_name_are_refused(install):
    install("railway-laws", "railway_laws_d", LAWS_PY, ":laws")
    install("other-laws", "other_laws_d", LAWS_PY, ":laws")
    with pytest.raises(LawError, match="both offer a driver law 'at-ease': uninstall one"):
        known_laws()


@pytest.mark.parametrize(
    ("text", "problem"),
    [
        ("import nowhere", "cannot be imported from broken_laws:laws: ModuleNotFoundError"),
        ("laws = [3]", "offers 3, which is not a tpss.laws.Law"),
    ],
)
def test_a_package_that_is_broken_is_named(install, text, problem):
    install("broken-laws", "broken_laws", text, ":laws")
    with pytest.raises(LawError) as raised:
        known_laws()
    assert problem in str(raised.value)
    assert "broken-laws 1.2" in str(raised.value)


def test_a_document_names_laws_wherever_it_says_law(install):
    """For studies, whose tables cannot be continued with another function of the same name."""
    for law in (TUNNEL, CALM, DROOPS):
        register(law)
    document = {
        "trains": {"a": {"driver": {"law": "calm"}}},
        "vary": [{"law": "droops"}, {"law": 3}],
    }
    assert laws_named(document) == [
        find_law("converter", "droops").in_words,
        find_law("driver", "calm").in_words,
    ]
    assert laws_named({"law": "of nobody"}) == []
    assert laws_named({"trains": {}}) == []
