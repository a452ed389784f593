"""Values for the part of a fragility page on the annual frequency of overturning."""

from __future__ import annotations

from rockwobble.studies import Fragility
from rockwobble.studies.fragility.risk import TARGET
from rockwobble.studies.fragility.tables import OVERTURNED, rows_of

from ..figures.risk import risk_pictures
from .wording import sentence

_MAIN = ("risk.frequency", "risk.none")
_UNIT = 1e4  # frequencies in 1e-4 a year


def risk_values(results: Fragility) -> dict[str, object] | None:
    """Return the values of the template of the risk; None without a hazard."""
    if "risk" not in results.tables:
        return None
    rows = rows_of(results.tables["risk"])
    scaled = [name for name in rows[0] if name.startswith("annual_frequency")]
    reference, said = str(rows[0]["method"]), results.findings().of("risk")
    return {
        "hazard": {"limit": OVERTURNED, "target": TARGET, "source": ""} | results.facts["hazard"],
        "rows": [{**row, **{name: _UNIT * row[name] for name in scaled}} for row in rows],
        "main": [sentence(each) for each in said if each.key in _MAIN],
        "reference": reference,
        "remarks": [
            f"{each.runs}: {sentence(each)}".removeprefix(": ") for each in said if each.key not in _MAIN
        ],
        "pictures": [picture.name for picture in risk_pictures(results)],
    }
