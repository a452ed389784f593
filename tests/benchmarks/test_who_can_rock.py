"""Page on who can rock: its table and sentences match the stored table."""

from __future__ import annotations

import math
import re
from pathlib import Path
from typing import Any

import pytest

from . import rock_worlds as worlds
from .who_can_rock import known, page

ROOT = Path(__file__).resolve().parents[2]
PUBLISHED = ROOT / "reports" / "published" / "simulators"
WORDS = " ".join((ROOT / "docs" / "published" / "simulators.md").read_text(encoding="utf-8").split())
PAIR = r"(\d+\.\d+)°(?: and regains?| and) (\d\.\d+)"  # a turn [deg] and a tilt over that of the release
PAIRS = set(re.findall(PAIR, WORDS))
EXACT = 203.909800  # [deg] tests/reference/finite_release.csv: h/b = 2, rolling rate 0.1 rad/s, flat ground
# of the scene in double precision (docs/guide/scenes/angle-of-turn.md)
TURN_ERROR, TILT_ERROR = 0.01, 1e-4


def row(simulator: str, settings: str) -> Any:
    table = known(PUBLISHED).set_index(["simulator", "settings"])
    return table.loc[(simulator, settings)]


def test_included_page_equals_the_stored_table() -> None:
    stored = (PUBLISHED / "simulators.md").read_text(encoding="utf-8")
    made = re.search(r"Made by `(.+)` on (.+)\.", stored)
    assert made is not None
    assert page(known(PUBLISHED), made[2], made[1]) == stored


def test_no_default_settings_pass_all_three_tests() -> None:
    table = known(PUBLISHED)
    default = table[(table["settings"] == "default") & table["turn"].notna()]
    does = (abs(default["turn"] - EXACT) < TURN_ERROR) & (abs(default["tilt"] - 1.0) < TILT_ERROR)
    assert not (does & (default["uplift"] == "holds")).any()
    assert "No default settings do all three" in WORDS


@pytest.mark.parametrize("corners", [32, 64])
def test_physx_matches_an_ideal_prism(corners: int) -> None:
    exact, mesh = row(f"prism-{corners}", "default"), row(f"physx-{corners}", "best")
    for each in (exact, mesh):
        assert (f"{each.turn:.2f}", f"{each.tilt:.3f}") in PAIRS
    cylinder, default = row("physx", "best"), row("physx", "default")
    assert (f"{cylinder.turn:.2f}", f"{cylinder.tilt:.3f}") in PAIRS
    assert "leans at 0.49 g" in default.uplift
    assert not any("leans at 0.49 g" in row(name, "best").uplift for name in ("physx", f"physx-{corners}"))


def test_prism_loss_halves_with_twice_the_corners() -> None:
    losses = [1.0 - row(f"prism-{corners}", "default").tilt for corners in (32, 64, 128)]
    assert "{:.1f} %, {:.1f} % and {:.1f} %".format(*(100 * loss for loss in losses)) in WORDS


def test_prism_simulation_matches_the_table() -> None:
    step = 1e-3  # an impact is detected up to a step late: 0.3 % of the tilt
    measured = worlds.turned(worlds.prism(step, False, 32), step)
    kept = row("prism-32", "default")
    assert measured["tilt"] == pytest.approx(kept.tilt, abs=0.01)
    assert math.radians(abs(measured["turn"] - kept.turn)) < 0.02


def test_simulators_that_move_no_rigid_body_are_named() -> None:
    table = known(PUBLISHED)
    cannot = table[table["remark"] == "RuntimeError: moves no rigid body"]["simulator"]
    assert sorted(cannot) == ["newton-mpm", "newton-style3d"]
    assert all(f"`{name}`" in WORDS for name in cannot)


def test_newton_uplifts_early_with_its_own_contacts() -> None:
    table = known(PUBLISHED)
    own = table[table["simulator"].str.startswith("newton-") & table["turn"].notna()]
    assert own["uplift"].str.contains("7 × leans at 0.49 g").all()
    assert row("mujoco", "default").uplift == "holds"
    cited = [
        ("newton-xpbd", "default"),
        ("newton-xpbd", "best"),
        ("newton-mujoco", "default"),
        ("mujoco", "default"),
    ]
    for simulator, settings in cited:
        each = row(simulator, settings)
        assert (f"{each.turn:.2f}", f"{each.tilt:.3f}") in PAIRS


def test_page_turns_and_tilts_are_in_the_table() -> None:
    table = known(PUBLISHED)
    stated = {(f"{turn:.2f}", f"{tilt:.3f}") for turn, tilt in zip(table["turn"], table["tilt"], strict=True)}
    assert len(PAIRS) >= 7
    assert stated >= PAIRS
