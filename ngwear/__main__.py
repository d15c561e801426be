"""``python -m ngwear``: the command line."""

import sys

from ngwear.cli import main

if __name__ == "__main__":  # a spawned process of a run imports this file, too, and must not run it
    sys.exit(main())
