"""Documents of railML of any version: names, numbers, and what is wrong with them."""

import math
from pathlib import Path
from xml.etree.ElementTree import Element

from tpss.errors import Finding, ScenarioError
from tpss.importers.documents import MOST_FINDINGS
from tpss.importers.xml_tree import REMEDY, read_xml

SYSTEMS = {
    (25.0, 50.0): "25kV-50Hz",
    (15.0, 16.7): "15kV-16.7Hz",
    (3.0, 0.0): "DC-3kV",
    (1.5, 0.0): "DC-1.5kV",
    (0.75, 0.0): "DC-0.75kV",
}
"""Systems of the library, by voltage [kV] and frequency [Hz] in one decimal."""


ROOTS = (("railml", "2."), ("railml", "3."), ("railML", "3."))
"""Names of root elements, and versions: early files of version 3 have the name of version 2."""


class RailmlFile:
    """A document, and the faults found in it so far."""

    def __init__(self, path: Path) -> None:
        self.path = path
        self.root = read_xml(path)
        self.findings: list[Finding] = []
        if (self.root.tag, self.version[:2]) not in ROOTS:
            found = f"{self.root.tag} {self.version}".rstrip()
            problem = f"not railML 2 or 3, but {found}"
            raise ScenarioError([Finding(str(path), "version", self.version, problem, REMEDY)])

    @property
    def version(self) -> str:
        """Version of railML, such as 3.2."""
        return self.root.get("version", "")

    def blame(
        self, element: Element, problem: str, key: str = "", remedy: str = "correct the file there"
    ) -> None:
        """Note a fault of an element, or of an attribute of it."""
        place = f"{element.tag} {element.get('id', '')}".rstrip()
        value = element.get(key, "") if key else ""
        self.findings.append(
            Finding(str(self.path), f"{place}, {key}" if key else place, value, problem, remedy)
        )

    def refuse_faults(self) -> None:
        """Refuse the document if it has faults.

        Raises
        ------
        ScenarioError
            With the faults found, as far as they tell something new.
        """
        if self.findings:
            raise ScenarioError(self.findings[:MOST_FINDINGS])

    def number(self, element: Element, *keys: str) -> float | None:
        """Value of the first of some attributes that an element has; None without any.

        One that is no finite number is noted as a fault, and is 0.
        """
        key = next((key for key in keys if element.get(key) is not None), None)
        if key is None:
            return None
        try:
            value = float(element.get(key, ""))
        except ValueError:
            value = math.nan
        if not math.isfinite(value):
            self.blame(element, "not a number", key, "write a number with a decimal point")
            return 0.0
        return value

    def count(self, *tags: str) -> int:
        """Number of elements of some kinds."""
        return sum(1 for tag in tags for _ in self.root.iter(tag))


def name_of(element: Element) -> str:
    """Name of an element: an English one, the first one, that of a register, or its id."""
    names = [each for each in element if each.tag == "name" and each.get("name", "").strip()]
    english = [each for each in names if each.get("language", "").lower().startswith("en")]
    entries = [each.get("entry", "") for each in element if each.tag == "designator"]
    found = [each.get("name", "") for each in (*english, *names)]
    found += [element.get("name", ""), *entries, element.get("code", ""), element.get("id", "")]
    return next((text for each in found if (text := " ".join(each.split()))), "unnamed")


def system_of(voltage_v: float, frequency_hz: float) -> str:
    """System of the library of a voltage and a frequency, or nothing."""
    return SYSTEMS.get((round(voltage_v / 1e3, 3), round(frequency_hz, 1)), "")


def counted(counts: dict[str, int]) -> str:
    """Numbers with what they count, such as "2 signals, 1 balises"; nothing of what there is none."""
    return ", ".join(f"{number} {words}" for words, number in counts.items() if number)
