"""Files of public repositories, which tests fetch because they may not be handed on with this one.

Each is fetched from its public address at a fixed commit, and is the file that its checksum tells.  A
folder of copies saves the way: that of the environment variable PUBLIC_FILES, or ../shared/public_files.
"""

import hashlib
import os
import urllib.error
import urllib.request
from pathlib import Path
from typing import NamedTuple

import pytest

from conftest import SHARED

PATIENCE_S = 5.0
"""So long a test waits for the network. [s]"""

COPIES = Path(os.environ.get("PUBLIC_FILES", SHARED / "public_files"))

_unreachable: list[str] = []
"""Why the network could not be reached: the tests that follow do not wait for it again."""


class PublicFile(NamedTuple):
    """A file of a repository on GitHub at a commit."""

    repository: str
    commit: str
    path: str
    sha256: str

    @property
    def address(self) -> str:
        """Where it is."""
        return f"https://raw.githubusercontent.com/{self.repository}/{self.commit}/{self.path}"

    def copied_to(self, folder: Path) -> Path:
        """A copy in a folder; the test is skipped, with the reason, if the file cannot be had."""
        folder.mkdir(parents=True, exist_ok=True)
        copy = folder / Path(self.path).name
        copy.write_bytes(self._content())
        return copy

    def _content(self) -> bytes:
        kept = COPIES / self.sha256
        content = kept.read_bytes() if kept.is_file() else self._fetched()
        found = hashlib.sha256(content).hexdigest()
        assert found == self.sha256, f"{self.address} is another file: {found}"
        return content

    def _fetched(self) -> bytes:
        if _unreachable:
            pytest.skip(_unreachable[0])
        try:
            with urllib.request.urlopen(self.address, timeout=PATIENCE_S) as answer:
                content: bytes = answer.read()
        except urllib.error.HTTPError as error:
            pytest.skip(f"{self.address} cannot be had: {error}")
        except OSError as error:
            _unreachable.append(f"no network: {self.address} cannot be reached: {error}")
            pytest.skip(_unreachable[0])
        return content
