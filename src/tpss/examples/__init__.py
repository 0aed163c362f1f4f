"""Examples that come with the program, by their names: scenarios, studies, plans, conductors.

>>> import tpss
>>> scenario = tpss.load_scenario(tpss.examples.path("thesis-160km"))

``tpss new my-line --from thesis-160km`` copies one to start from.
"""

import posixpath
import re
import tomllib
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from tpss.errors import ResultError, no_such

_PACKED = Path(__file__).parent / "files"
_CHECKOUT = Path(__file__).parents[3] / "examples"

_FIRST_SENTENCE = re.compile(r"(.+?[.?])(?:\s|$)")


def folder() -> Path:
    """Folder of the examples: that of the package, or of the checkout that it is imported from."""
    return _PACKED if _PACKED.is_dir() else _CHECKOUT


def names() -> dict[str, str]:
    """Names of all examples, and what each is, in a sentence."""
    return {_name_of(file): _sentence(file) for file in _main_files()}


def path(name: str) -> Path:
    """File of an example.

    Parameters
    ----------
    name : str
        Such as ``thesis-160km``.

    Raises
    ------
    ResultError
        There is no example of that name.
    """
    known = {_name_of(file): file for file in _main_files()}
    if name not in known:
        problem, remedy = no_such("example", name, list(known))
        raise ResultError(f"{name!r}: {problem}; {remedy}")
    return known[name]


def files_of(name: str) -> dict[str, Path]:
    """Files of an example by their places in its folder: its own first, then those that it refers to.

    Raises
    ------
    ResultError
        There is no example of that name.
    """
    known = {each.relative_to(folder()).as_posix(): each for each in folder().rglob("*.*")}
    waiting, found = [path(name).name], {}
    while waiting:
        place = waiting.pop(0)
        if place in found:
            continue
        found[place] = known[place]
        if place.endswith(".toml"):
            texts = _texts(tomllib.loads(known[place].read_text("utf-8")))
            beside = (posixpath.join(posixpath.dirname(place), text) for text in texts)
            waiting += [each for each in map(posixpath.normpath, beside) if each in known]
    return found


def _main_files() -> list[Path]:
    return sorted(folder().glob("*.toml"))


def _name_of(file: Path) -> str:
    return file.stem.replace("_", "-")


def _sentence(file: Path) -> str:
    """The first sentence of the comment that a file begins with."""
    comment = []
    for line in file.read_text("utf-8").splitlines():
        if not line.startswith("# "):
            break
        comment.append(line.removeprefix("#").strip())
    text = " ".join(comment)
    sentence = _FIRST_SENTENCE.match(text)
    return sentence[1] if sentence else text


def _texts(value: Any) -> Iterator[str]:
    """All texts of a document."""
    if isinstance(value, str):
        yield value
    elif isinstance(value, dict | list):
        for each in value.values() if isinstance(value, dict) else value:
            yield from _texts(each)
