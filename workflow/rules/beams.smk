"""Sec. III-C and IV: Monte Carlo over cantilever beams."""


rule beams:
    input:
        lambda w: "results/chaos/{}_{}.nc".format(w.case, "G" if w.model == "G" else "NG"),
    output:
        "results/beams/{case}_{model}.nc",
    log:
        "results/logs/beams/{case}_{model}.log",
    threads: 1
    resources:
        mem_mb=800,
        runtime=10,
    params:
        settings=lambda w: section(
            "seed",
            **cantilever_settings(keys.pair_of(w.case)),
            sampling=STRIP,
            samples=config["beam"]["samples"],
            scatter=config["beam"]["scatter"] if w.model == "GEO" else 0,
        ),
        code=code("beams.py"),
    message:
        "Release the beams of {wildcards.case}, {wildcards.model} (Sec. III-C)."
    script:
        "../scripts/beams.py"
