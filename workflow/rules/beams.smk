"""Sec. III-C and IV: Monte Carlo over cantilever beams."""


rule beams:
    input:
        lambda w: f"results/chaos/{w.case}_{'G' if w.model == 'G' else 'NG'}.nc",
    output:
        "results/beams/{case}_{model}.nc",
    log:
        "results/logs/beams/{case}_{model}.log",
    resources:
        runtime=20,
    params:
        settings=lambda w: section(
            "seed",
            "beam",
            gap_um=config["pairs"][keys.pair_of(w.case)]["gap_um"],
            young_modulus_GPa=config["solid"]["young_modulus_GPa"],
            strip_length_um=config["sampling"]["strip_length_um"],
        ),
        code=code("beams.py"),
    message:
        "Release the beams of {wildcards.case}, {wildcards.model} (Sec. III-C)."
    script:
        "../scripts/beams.py"
