"""The part of a comparison that belongs to one case, in the order in which it is drawn."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

from rockwobble.models import Case

from .palette import Style, model_style, run_styles

if TYPE_CHECKING:
    import pandas as pd

    from rockwobble.compare import Comparison, ErrorBudget


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class CaseView:
    """One case: its traces and its rows of the summary.

    Parameters
    ----------
    case : Case
    responses : dict
        Response of each reduced model.
    trajectories : dict
        Trajectory of each run, by label.
    rows : DataFrame
        Rows of the summary, with the label of the run as an additional column "run".
    styles : dict
        Style of each run, by label.
    budgets : dict
        Error budget for each label of a run and reduced model, where there is one.
    """

    case: Case
    responses: Mapping[str, Any]
    trajectories: Mapping[str, Any]
    rows: pd.DataFrame
    styles: Mapping[str, Style]
    budgets: Mapping[tuple[str, str], ErrorBudget] = field(default_factory=dict)

    def lines(self) -> Iterator[tuple[str, Any, Style]]:
        """Yield label, trace and style of everything there is: the runs, then the models on top."""
        for label, trace in self.trajectories.items():
            yield label, trace, self.styles[label]
        for model, trace in self.responses.items():
            yield f"{model} model", trace, model_style(model)

    def start(self, model: str) -> float:
        """Return uplift or release of a model [s], 0 where there is none."""
        time = float(self.responses[model].uplift_time)
        return time if time == time else 0.0


def case_views(comparison: Comparison) -> list[CaseView]:
    """Return the view of each case of a comparison."""
    views = []
    for name, case in comparison.cases.items():
        rows = comparison.summary[comparison.summary["case"] == name]
        trajectories = {run: trace for (of, run), trace in comparison.trajectories.items() if of == name}
        views.append(
            CaseView(
                case=case,
                responses={model: trace for (of, model), trace in comparison.responses.items() if of == name},
                trajectories=trajectories,
                rows=rows,
                styles=run_styles(list(trajectories)),
                budgets={
                    (run, model): budget
                    for (of, run, model), budget in comparison.budgets.items()
                    if of == name
                },
            )
        )
    return views
