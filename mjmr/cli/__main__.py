"""``python -m mjmr.cli`` is ``mjmr``."""

import sys

from mjmr.cli import main

sys.exit(main())
