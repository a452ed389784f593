"""Methods whose fragility is asked for: reduced models by name, engines as runs."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from rockwobble.models import Run
from rockwobble.models.number_checks import require_one_of

from ...runs.labels import run_labels

# The worse plane is no run of its own: of both planes, for each motion, the one that tilts more.
WORSE_PLANE = "worse-plane"
_PLANES = {"planar-x": 0.0, "planar-y": 0.5 * math.pi}
MODELS: Mapping[str, str] = {
    "recess": "recess model",
    "flat": "flat-ground model",
    "planar-x": "planar x",
    "planar-y": "planar y",
    WORSE_PLANE: "worse plane",
}


@dataclass(frozen=True, slots=True, kw_only=True)
class Method:
    """One method.

    Attributes
    ----------
    label : str
        Different for each method.
    run : Run or None
        None for what is made of others.
    of : tuple of str
        Labels of the methods of which it is the worse, motion by motion.
    """

    label: str
    run: Run | None
    of: tuple[str, ...] = ()

    @property
    def support(self) -> str:
        """What holds the cylinder: "recess", "flat", "ring" or "planar"."""
        if self.run is None or self.run.settings.get("plane") is not None:
            return "planar"
        return self.run.support


def methods_of(given: Iterable[str | Run], *, restitution: float | str = 1.0) -> tuple[Method, ...]:
    """Return the methods, in their order; both planes besides where the worse of them is asked for.

    Parameters
    ----------
    given : iterable of str or Run
        Names in `MODELS`, and runs of engines or of reduced models with settings.
    restitution : float or "momentum", optional
        Of the planar models, see `reduced.simulate`.

    Raises
    ------
    ValueError
        If a name is unknown, two methods are alike, or there is none.
    """
    chosen: list[str | Run] = []
    for method in given:
        if isinstance(method, str):
            require_one_of("a reduced model", method, MODELS)
        chosen += [plane for plane in _PLANES if method == WORSE_PLANE and plane not in chosen]
        if method not in chosen or not isinstance(method, str):
            chosen.append(method)
    if not chosen:
        raise ValueError("a fragility needs at least one method, got none")
    labels = iter(run_labels([method for method in chosen if isinstance(method, Run)]))
    found = [_method(method, restitution, labels) for method in chosen]
    names = [method.label for method in found]
    for name in names:
        if names.count(name) > 1:
            raise ValueError(f"the methods must differ, got {name!r} twice")
    return tuple(found)


def _method(given: str | Run, restitution: float | str, labels: Iterable[str]) -> Method:
    if isinstance(given, Run):
        return Method(label=next(iter(labels)), run=given)
    if given == WORSE_PLANE:
        return Method(label=MODELS[given], run=None, of=tuple(MODELS[plane] for plane in _PLANES))
    if given in _PLANES:
        loss: dict[str, Any] = {} if restitution == 1.0 else {"restitution": restitution}
        return Method(label=MODELS[given], run=Run(None, "recess", plane=_PLANES[given], **loss))
    return Method(label=MODELS[given], run=Run(None, given))


def own_model(method: Method, methods: Sequence[Method]) -> str:
    """Return the label of the reduced model of the support of an engine, if there is one among the methods.

    No reduced model knows the walls of a ring.
    """
    if method.run is None or method.run.engine is None:
        return ""
    return next(
        (
            other.label
            for other in methods
            if other.run is not None and other.run.engine is None and other.support == method.support
        ),
        "",
    )
