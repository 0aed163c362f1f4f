#!/usr/bin/env python3
"""Bring another version of plotly.js into the package, packed as pages hold it.

    python tools/renew_plotly.py 4.1.1

Its cartesian bundle has all that the figures are made of, and a third of the whole library's size.  It
comes from npm's registry, and is what that says it is, or nothing is written.
"""

import base64
import gzip
import hashlib
import io
import json
import sys
import tarfile
from pathlib import Path
from urllib.request import urlopen

NAME, SCRIPT = "plotly.js-cartesian-dist-min", "plotly-cartesian.min.js"
FOLDER = Path(__file__).parents[1] / "src" / "tpss" / "report" / "vendor"


def main(version: str) -> None:
    """Fetch a version, and write its script and its licence."""
    with urlopen(f"https://registry.npmjs.org/{NAME}/{version}") as answer:
        told = json.load(answer)["dist"]
    with urlopen(told["tarball"]) as answer:
        packed = answer.read()
    found = base64.b64encode(hashlib.sha512(packed).digest()).decode()
    if told["integrity"] != f"sha512-{found}":
        sys.exit(f"{told['tarball']} is not what the registry says it is: nothing is written")
    with tarfile.open(fileobj=io.BytesIO(packed)) as files:
        script = files.extractfile(f"package/{SCRIPT}").read()
        licence = files.extractfile("package/LICENSE").read()
    FOLDER.mkdir(exist_ok=True)
    (FOLDER / "plotly.js.gz").write_bytes(gzip.compress(script, 9, mtime=0))
    (FOLDER / "plotly.LICENSE").write_bytes(licence)


if __name__ == "__main__":
    main(*sys.argv[1:])
