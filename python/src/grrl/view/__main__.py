"""python -m grrl.view"""

import sys

from .command import main

sys.exit(main())
