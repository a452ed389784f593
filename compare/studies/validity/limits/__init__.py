"""The limits of the model, one a module, each a function of the measured tables alone."""

from collections.abc import Callable

from .agreement_limit import horizon
from .distribution_limit import contrasts, distribution
from .friction_limit import friction
from .limit import Limit, Tables
from .loss_of_contact_limit import loss_of_contact
from .model_form_limit import model_form
from .peak_tilt_limit import peak_tilt
from .real_recess_limit import real_recess
from .restraining_moment_limit import couple
from .soft_contact_limit import soft_contact
from .vertical_limit import vertical

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
