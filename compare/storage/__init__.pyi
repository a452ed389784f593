from .claim import claimed as claimed
from .files import replace_files as replace_files
from .manifest import require_writable as require_writable
