from .advice.advice import Advice as Advice
from .ensemble import Ensemble as Ensemble
from .fragility.intensity import MEASURES as MEASURES
from .fragility.study import Fragility as Fragility
from .fragility.tables import LIMITS as LIMITS
from .grid import Grid as Grid
from .spectrum.study import OverturningSpectrum as OverturningSpectrum
from .sweep import Sweep as Sweep
