"""Run one job of a declared stage."""

import signal

from stiction.plan.running import run
from stiction.run.logs import logged

if __name__ == "__main__":
    # Ctrl-C ends a job at once: an exception could leave the lock of a library held, for which its end would wait.
    if signal.getsignal(signal.SIGINT) is not signal.SIG_IGN:  # as in the background of a shell
        signal.signal(signal.SIGINT, signal.SIG_DFL)
    with logged(snakemake.log[0], snakemake.output):
        run(snakemake)
