"""`python -m rockwobble` is the command line."""

from rockwobble.reports.cli.main import main

if __name__ == "__main__":
    main()
