"""The command `rockwobble`, and `python -m rockwobble`."""

import atexit
import gc
import sys


def main() -> None:
    """Run the command line; an interrupt while it is being imported ends as cleanly as any later one."""
    # no run leaves cycles behind: walking through what the libraries hold takes a sixth of a short command
    gc.set_threshold(500_000)
    atexit.register(gc.freeze)  # nor does the interpreter need to, at its end
    try:
        from rockwobble.reports.cli.main import main as command_line
    except KeyboardInterrupt:
        print("rockwobble: interrupted", file=sys.stderr)
        sys.exit(130)
    command_line()


if __name__ == "__main__":
    main()
