"""The folder of a study: a manifest, and one file of rows per batch, written whole or not at all."""

import json
import re
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import pandas as pd
from filelock import FileLock, Timeout

from tpss.errors import StudyError
from tpss.files.checked import checked_name, read_checked, takes_checksum, with_checksum
from tpss.files.json_text import read_json_file
from tpss.files.refusals import ANOTHER, explained, reason
from tpss.files.whole import UNFINISHED, write_file

REMEDY = (
    f"free space, or {ANOTHER}. Finished cases are kept, and the same command continues from them"
)

MANIFEST, CASES = "study.json", "cases"

FORMAT_KEY, FORMAT = "table_format", 1
"""Key and number of the format in which a folder is written.

It increases when a column is renamed, removed or changes its meaning.
"""

STEP_CHECK = "step_check"
"""Key of what the time step costs a sample of the cases."""

_PART = re.compile(r"cases-(\d+)-(\d+)(-[0-9a-f]+)?\.parquet")

Ranges = list[tuple[int, int]]
"""Cases from the first to the one before the second, ascending."""


class Folder:
    """The folder of a study, opened by one process at a time."""

    def __init__(self, path: Path) -> None:
        self.path = path

    @contextmanager
    def opened(self, manifest: dict[str, Any]) -> Iterator[dict[str, Any]]:
        """Make the folder, or continue it; gives the manifest that it was begun with.

        Raises
        ------
        StudyError
            It belongs to another study or version, another process works in it, or it cannot be
            written.
        """
        with explained(self.path, REMEDY, StudyError, within=True):
            self._refuse_others()
            (self.path / CASES).mkdir(parents=True, exist_ok=True)
            with lock(self.path):
                begun = self._begin(manifest)
                for leftover in (self.path / CASES).glob(f"*{UNFINISHED}"):
                    leftover.unlink()
                yield begun

    def _refuse_others(self) -> None:
        """A folder that is not empty must be one of a study."""
        if not self.path.exists():
            return
        if not self.path.is_dir():
            raise StudyError(f"{self.path} is not a folder; give another --out")
        names = {entry.name for entry in self.path.iterdir()} - {CASES, LOCK}
        if MANIFEST not in names and not all(name.endswith(UNFINISHED) for name in names):
            raise StudyError(
                f"{self.path} is not empty, nor the folder of a study; give another --out"
            )

    def _begin(self, manifest: dict[str, Any]) -> dict[str, Any]:
        place = self.path / MANIFEST
        if not place.exists():
            write_file(place, _as_json(manifest))
            return manifest
        begun = read_manifest(self.path)
        for key, problem, remedy in (
            (FORMAT_KEY, "is of another format", "finish it with the version that began it"),
            ("study_hash", "holds another study", f"see {MANIFEST} there"),
            ("tpss_version", "was begun by another version", "finish it with that version"),
            ("kernel_hash", "was begun by other kernels", "finish it with those"),
        ):
            if begun.get(key) != manifest[key]:
                raise StudyError(
                    f"{self.path} {problem} ({key} {begun.get(key)}, here {manifest[key]}); {remedy}, "
                    "or give another --out"
                )
        return begun

    def add_to_manifest(self, key: str, value: Any) -> None:
        """Add what was found out about the study."""
        manifest = {**read_manifest(self.path), key: value}
        write_file(self.path / MANIFEST, _as_json(manifest))

    def done(self) -> Ranges:
        """Cases whose rows are there."""
        parts = (_PART.fullmatch(file.name) for file in (self.path / CASES).iterdir())
        return sorted((int(part[1]), int(part[2])) for part in parts if part)

    def add(self, first: int, end: int, content: bytes) -> None:
        """Add the rows of a batch."""
        name = checked_name(f"cases-{first:08d}-{end:08d}", ".parquet", content)
        write_file(self.path / CASES / name, content)


LOCK = ".lock"


@contextmanager
def lock(path: Path) -> Iterator[None]:
    """Keep other processes out until this one ends, in whatever manner."""
    held = FileLock(path / LOCK)
    try:
        held.acquire(timeout=0)
    except Timeout:
        raise StudyError(
            f"{path} is in use by another process; wait for it, or give another --out"
        ) from None
    try:
        yield
    finally:
        held.release()


def missing(done: Ranges, cases: int) -> Ranges:
    """Gaps between ranges of finished cases."""
    gaps, at = [], 0
    for first, end in [*done, (cases, cases)]:
        if first > at:
            gaps.append((at, min(first, cases)))
        at = max(at, end)
    return gaps


def batches(ranges: Ranges, size: int) -> Iterator[tuple[int, int]]:
    """Ranges cut into batches, at multiples of their size."""
    for first, end in ranges:
        while first < end:
            cut = min(end, (first // size + 1) * size)
            yield first, cut
            first = cut


def _as_json(manifest: dict[str, Any]) -> bytes:
    """A manifest with its checksum."""
    return json.dumps(with_checksum(manifest), indent=1).encode()


def read_manifest(path: Path) -> dict[str, Any]:
    """Manifest of the folder of a study.

    Raises
    ------
    StudyError
        It is no such folder, or damaged.
    """
    try:
        manifest = read_json_file(path / MANIFEST)
    except (OSError, ValueError) as error:
        raise StudyError(
            f"{path} is not the folder of a study ({MANIFEST}: {reason(error)}); name one that tpss "
            "sweep has written"
        ) from error
    if not isinstance(manifest, dict):
        raise StudyError(f"{path / MANIFEST} is damaged; give the study another folder")
    if not takes_checksum(manifest):
        raise StudyError(
            f"{path / MANIFEST} is damaged (its checksum is another); give the study another folder"
        )
    return manifest


def load_table(folder: str | Path) -> pd.DataFrame:
    """The table of a study, one row per finished case.

    Raises
    ------
    StudyError
        The folder is not that of a study, or of another version's format, or a file is damaged.
    """
    path = Path(folder)
    written = read_manifest(path).get(FORMAT_KEY)
    if written != FORMAT:
        raise StudyError(
            f"{path} was written by another version of TPSS: its format is {written}, this version "
            f"reads {FORMAT}; read it with that version, or run the study again"
        )
    files = sorted((path / CASES).glob("*.parquet"))
    if not files:
        raise StudyError(f"{path} has no cases yet; run the study's command again")
    table: pd.DataFrame = read_parts(files, "study").to_pandas()
    return table.sort_values("case", ignore_index=True)


def read_parts(files: Sequence[Path], what: str, options: str = "none") -> Any:
    """Table of the rows in files of cases, of which there is one at least.

    Parameters
    ----------
    files : sequence of Path
    what : str
        What they are of, whose command repeats cases that are not there.
    options : str
        How columns that differ are put together, as in pyarrow.

    Raises
    ------
    StudyError
        A file is damaged, or has other columns than the first one.
    """
    import pyarrow as pa

    tables = [_read_part(file, what) for file in files]
    try:
        return pa.concat_tables(tables, promote_options=options)
    except pa.ArrowException as error:
        schemas = [table.schema for table in tables]
        other = next(k for k, schema in enumerate(schemas) if not schema.equals(schemas[0]))
        problem = f"its columns are others than those of {files[0].name}"
        raise _damaged(files[other], problem, what) from error


def _read_part(file: Path, what: str) -> Any:
    import pyarrow as pa
    import pyarrow.parquet as pq

    try:
        return pq.read_table(pa.BufferReader(read_checked(file)))
    except (OSError, ValueError, pa.ArrowException) as error:
        raise _damaged(file, reason(error), what) from error


def _damaged(file: Path, problem: str, what: str) -> StudyError:
    remedy = f"delete it and run the {what}'s command again, which repeats its cases"
    return StudyError(f"{file} is damaged ({problem}); {remedy}")
