"""Secs. III-C and IV: Monte Carlo over cantilever beams."""


rule beams:
    input:
        chaos=lambda w: f"results/chaos/{w.case}_{surface_model(w.model)}.nc",
    output:
        "results/beams/{case}_{model}.nc",
    log:
        "results/logs/beams/{case}_{model}.log",
    params:
        settings=lambda w: jobs.beams(plan, w.case, w.model),
        code=code("beams.py"),
    message:
        "Release the beams of {wildcards.case}, {wildcards.model} (Sec. III-C)."
    script:
        "../scripts/beams.py"
