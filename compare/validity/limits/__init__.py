"""The limits of the model, one a module, each a function of the measured tables alone."""

from collections.abc import Callable

from .couple import couple
from .distribution import contrasts, distribution
from .friction import friction
from .horizon import horizon
from .limit import Limit, Tables
from .loss_of_contact import loss_of_contact
from .model_form import model_form
from .peak_tilt import peak_tilt
from .real_recess import real_recess
from .soft_contact import soft_contact
from .vertical import vertical

LIMITS: tuple[Callable[[Tables], Limit], ...] = (
    peak_tilt,
    distribution,
    horizon,
    model_form,
    friction,
    loss_of_contact,
    couple,
    real_recess,
    soft_contact,
    vertical,
)


def limits_of(tables: Tables) -> list[Limit]:
    """Return all limits, those that matter most first.

    Parameters
    ----------
    tables : mapping of DataFrame
        Of each part by its name, as `measure_all` returns them.
    """
    return [limit(tables) for limit in LIMITS]


__all__ = [
    "LIMITS",
    "Limit",
    "Tables",
    "contrasts",
    "couple",
    "distribution",
    "friction",
    "horizon",
    "limits_of",
    "loss_of_contact",
    "model_form",
    "peak_tilt",
    "real_recess",
    "soft_contact",
    "vertical",
]
