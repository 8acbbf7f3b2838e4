"""``python -m trum_sym.console``."""

import sys

from trum_sym.console import main

sys.exit(main())
