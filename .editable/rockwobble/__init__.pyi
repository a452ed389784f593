import rockwobble.compare.comparison.driver as _driver

from . import models as models
from . import multibody as multibody
from . import reduced as reduced
from . import reports as reports
from .compare.check import check as check
from .compare.comparison.comparison import Comparison as Comparison
from .compare.external.trajectory import External as External
from .compare.runs.execution import simulate as simulate
from .compare.studies.advice.advice import advise as advise
from .compare.studies.ensemble import ensemble as ensemble
from .compare.studies.fragility.study import fragility as fragility
from .compare.studies.grid import Grid as Grid
from .compare.studies.spectrum.study import spectrum as spectrum
from .compare.studies.sweep import sweep as sweep
from .models import Case as Case
from .models import Cylinder as Cylinder
from .models import Diagnostic as Diagnostic
from .models import GroundMotion as GroundMotion
from .models import HazardCurve as HazardCurve
from .models import InitialState as InitialState
from .models import Run as Run
from .models import Suite as Suite
from .models import Tendon as Tendon
from .models import Trace as Trace
from .models import WobblingFrame as WobblingFrame
from .models import el_centro_1940 as el_centro_1940
from .models import far_field_motions as far_field_motions
from .models import p695_far_field as p695_far_field
from .models import perturbed_copies as perturbed_copies
from .models import pulse as pulse
from .models import read_hazard as read_hazard
from .models import read_record as read_record
from .models import read_records as read_records
from .models import read_records_by_level as read_records_by_level
from .models import read_suite as read_suite
from .models import shipped_suites as shipped_suites
from .models import synthetic_motions as synthetic_motions
from .models import with_motions as with_motions

__version__: str
compare = _driver.compare  # when the program runs, the package of that name, which may be called
