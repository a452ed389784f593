"""Stated effects of a small loss match the stored tables."""

from __future__ import annotations

from pathlib import Path

from benchmarks.loss_effects import SHARES, by_length, main, stored

PAGE = Path(__file__).parents[2] / "docs" / "theory" / "energy-loss.md"


def test_stated_loss_effects_match_the_tables() -> None:
    words = " ".join(PAGE.read_text(encoding="utf-8").split())
    table = stored("fragility")
    table = table[table["limit"] == "overturned"]
    for method, form in (
        ("recess model", "from {} to {}, {} and {} g tan α in the recess"),
        ("flat-ground model", "from {} to {}, {} and {} on flat ground"),
    ):
        medians = table[table["method"] == method].set_index("delta_b")["median"]
        assert form.format(*(f"{medians[share]:.2f}" for share in SHARES)) in words
    assert not table["failed"].any()
    form = "{:.2f} ({:.2f} to {:.2f})"
    for share, rows in table.groupby("delta_b"):
        cells = [form.format(*row) for row in rows[["median", "median_low", "median_high"]].to_numpy()]
        assert f"| {share:g} | {cells[0]} | {cells[1]} |" in words
    ratios = table.pivot(index="delta_b", columns="method", values="median")
    rises = {share: (100.0 * (ratios.loc[share] / ratios.loc[0.0] - 1.0)).round() for share in SHARES}
    assert [sorted(rises[share]) for share in SHARES[1:]] == [[1, 1], [8, 10], [21, 25]]
    agreements = by_length(stored("agreement")).set_index(["trial", "delta_b"])
    medians = agreements.loc["1 %"]["median"]
    assert "medians {}, {}, {} and {} s after".format(*(f"{medians[share]:.1f}" for share in SHARES)) in words
    assert (agreements.loc["1 %"]["diverged"] == 12).all()
    for trial, form in (("1e-6", "in {}, {}, {} and {} of 12"), ("mujoco", "in {}, {}, {} and {} of 3")):
        assert form.format(*(agreements.loc[trial]["diverged"][share] for share in SHARES)) in words


def test_loss_effects_command_prints_the_tables() -> None:
    assert main([]) == 0
