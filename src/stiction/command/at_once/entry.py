"""Entry of the command: an estimate at once needs few imports, everything else the whole command."""

import sys


def main() -> int:
    """Run the command."""
    if sys.argv[1:2] == ["estimate"]:
        from stiction.command.at_once import estimate

        return estimate.main(sys.argv[2:])
    from stiction.command import main as whole

    return whole.main()
