"""The command line: `python -m tabletop`."""

import signal
import sys

from ._tabletop import main as run


def main() -> None:
    """Carries out the arguments of this process, and ends it with the exit code of the command."""
    # The program ends at Ctrl-C, as it does outside Python.
    signal.signal(signal.SIGINT, signal.SIG_DFL)
    sys.exit(run(["tabletop", *sys.argv[1:]]))


if __name__ == "__main__":
    main()
