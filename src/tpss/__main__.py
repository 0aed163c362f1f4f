"""Where ``tpss`` and ``python -m tpss`` begin: a Ctrl-C ends them quietly, even in the first imports."""

import sys


def main() -> None:
    """Run the command line."""
    try:
        from tpss.cli.main import main

        main()
    except KeyboardInterrupt:
        sys.exit(130)


if __name__ == "__main__":
    main()
