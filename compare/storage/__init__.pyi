from .claim import claim_folder as claim_folder
from .files import replace_files as replace_files
from .manifest import require_writable as require_writable
