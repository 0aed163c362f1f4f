"""The folder of a plan's cases: files of rows in Parquet, each row one case, found by its digest."""

import hashlib
import io
import json
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import pandas as pd

from tpss.errors import StudyError
from tpss.files.checked import checked_name
from tpss.files.json_text import read_json_file
from tpss.files.refusals import ANOTHER, explained
from tpss.files.whole import UNFINISHED, write_file
from tpss.sweep.folder import CASES, LOCK, REMEDY, lock, read_parts
from tpss.sweep.versions import versions

MANIFEST = "cases.json"
"""Says which version simulated the cases of a folder."""

FORMAT_KEY, FORMAT = "cases_format", 1
"""Key and number of the format of the rows; it increases when a column changes its meaning."""

DIGEST = "case_digest"
"""Column by which a case is found."""


class CaseFolder:
    """Rows of finished cases in the folder of a plan, opened by one process at a time."""

    def __init__(self, path: Path) -> None:
        self.path = path

    @contextmanager
    def opened(self) -> Iterator[None]:
        """Make the folder, or continue it.

        Raises
        ------
        StudyError
            It is no folder of a plan, its cases are of another version, another process works in it, or
            it cannot be written.
        """
        with explained(self.path, REMEDY, StudyError, within=True):
            self._refuse_others()
            (self.path / CASES).mkdir(parents=True, exist_ok=True)
            with lock(self.path):
                self._begin()
                for leftover in (self.path / CASES).glob(f"*{UNFINISHED}"):
                    leftover.unlink()
                yield

    def _refuse_others(self) -> None:
        if not self.path.exists():
            return
        if not self.path.is_dir():
            raise StudyError(f"{self.path} is not a folder; {ANOTHER}")
        names = {entry.name for entry in self.path.iterdir()} - {CASES, LOCK}
        if names and not any(name.startswith(MANIFEST) for name in names):
            raise StudyError(f"{self.path} is not empty, nor the folder of a plan; {ANOTHER}")

    def _begin(self) -> None:
        place, own = self.path / MANIFEST, {FORMAT_KEY: FORMAT, **versions()}
        if not place.exists():
            write_file(place, json.dumps(own, indent=1).encode())
            return
        try:
            begun = dict(read_json_file(place))
        except ValueError as error:
            raise StudyError(f"{place} is damaged ({error}); {ANOTHER}") from error
        for key, value in own.items():
            if begun.get(key) != value:
                raise StudyError(
                    f"the cases of {self.path} were simulated by another version ({key} "
                    f"{begun.get(key)}, here {value}); finish it with that version, or {ANOTHER}"
                )

    def add(self, rows: Sequence[dict[str, Any]]) -> None:
        """Add the rows of some cases, all of them or none."""
        name = hashlib.sha256("".join(sorted(row[DIGEST] for row in rows)).encode()).hexdigest()
        content = as_parquet(rows)
        write_file(self.path / CASES / checked_name(name[:24], ".parquet", content), content)

    def table(self) -> pd.DataFrame:
        """All rows, by their digests; no case is in it twice.

        Raises
        ------
        StudyError
            A file is damaged.
        """
        files = sorted((self.path / CASES).glob("*.parquet"))
        if not files:
            return pd.DataFrame(index=pd.Index([], name=DIGEST, dtype=object))
        whole: pd.DataFrame = read_parts(files, "plan", "permissive").to_pandas()
        return whole.set_index(DIGEST)


def as_parquet(rows: Sequence[dict[str, Any]]) -> bytes:
    """Rows as a file of Parquet; what a row does not have is null."""
    import pyarrow as pa
    import pyarrow.parquet as pq

    names = dict.fromkeys(name for row in rows for name in row)
    columns = {name: pa.array([row.get(name) for row in rows], from_pandas=True) for name in names}
    file = io.BytesIO()
    pq.write_table(pa.table(columns), file, compression="zstd")
    return file.getvalue()
