"""Last rules: checks of the results."""


# Succeeds even if checks fail: Snakemake removes the files of a failed rule, and this report must remain.
rule checks:
    input:
        heights=expand("results/heights/{surface}.nc", surface=plan.surfaces),
        spectrum=expand("results/spectrum/{surface}.nc", surface=plan.surfaces),
        identification=expand("results/identification/{surface}.nc", surface=plan.with_summits),
        character=expand("results/character/{surface}_{model}.nc", surface=plan.surfaces, model=SURFACE_MODELS[::-1]),
        forces=[f"results/forces/{case}_{model}.nc" for case, model in plan.laws],
        chaos=[f"results/chaos/{case}_{model}.nc" for case, model in plan.laws],
        beams=[f"results/beams/{case}_{model}.nc" for case, model in plan.outcomes],
        resampling=[f"results/studies/resampling/{case}.nc" for case in plan.cases],
    output:
        csv="results/checks.csv",
        markdown="results/checks.md",
    log:
        "results/logs/checks.log",
    localrule: True
    params:
        settings=jobs.checks(plan),
        code=code("checks.py"),
    message:
        "Check the results."
    script:
        "../scripts/checks.py"


rule verdict:
    input:
        checks="results/checks.csv",
    output:
        "results/verdict.txt",
    log:
        "results/logs/verdict.log",
    localrule: True
    params:
        settings={},
        code=code("verdict.py"),
    message:
        "Stop if a check has failed."
    script:
        "../scripts/verdict.py"
