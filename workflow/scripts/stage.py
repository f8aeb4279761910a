"""Run one job of a declared stage."""

from stiction.plan.running import run
from stiction.run.logs import logged

if __name__ == "__main__":
    with logged(snakemake.log[0], snakemake.output):
        run(snakemake)
