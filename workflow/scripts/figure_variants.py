"""Crack lengths of Table III under other model choices."""

from stiction.report import published
from stiction.report.figures_studies import variants
from stiction.report.style import save
from stiction.run.logs import logged
from stiction.stages.named import key_of, load_named
from stiction.variants.beams import by_pair


def main(job):
    """Draw all pairs and variants."""
    loaded = by_pair(load_named(job.input.studies, "variant", key_of))
    pairs, names = (dict.fromkeys(parts) for parts in zip(*loaded, strict=True))
    # Variants that change nothing for a pair are left out of the plan; for that pair they equal the base.
    whole = {(pair, name): loaded.get((pair, name), loaded[pair, "base"]) for pair in pairs for name in names}
    known = published.of_paper(published.read(job.input.published), job.params.settings["of_paper"])
    save(variants(whole, known), *job.output)


if __name__ == "__main__":
    with logged(snakemake.log[0], snakemake.output):
        main(snakemake)
