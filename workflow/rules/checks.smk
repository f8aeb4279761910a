"""The last rules: what was computed is checked against what must hold."""

PUBLISHED = {line.partition(",")[0] for line in Path(printed(3)).read_text(encoding="utf-8").splitlines()}
SKEWNESS = {pair: [config["surfaces"][config["pairs"][pair][side]]["skewness"] for side in SIDES] for pair in PAIRS}
# That negative skewness binds is a claim about the paper's own pairs: no surface skewed positively, one negatively.
SKEWED = [pair for pair in PAIRS if pair in PUBLISHED and max(SKEWNESS[pair]) <= 0 > min(SKEWNESS[pair])]


# Judges nothing: files of a failed rule are removed, and this report must outlive a failure.
rule checks:
    input:
        spectrum=expand("results/spectrum/{surface}.nc", surface=SURFACES),
        character=expand("results/character/{surface}_{model}.nc", surface=SURFACES, model=("NG", "G")),
        forces=[f"results/forces/{case}_{model}.nc" for case, model in LAWS],
        chaos=[f"results/chaos/{case}_{model}.nc" for case, model in LAWS],
        beams=[f"results/beams/{case}_{model}.nc" for case, model in OUTCOMES],
        resampling=[f"results/studies/resampling/{case}.nc" for case in CASES],
    output:
        csv="results/checks.csv",
        markdown="results/checks.md",
    log:
        "results/logs/checks.log",
    params:
        settings={
            "laws": keys_of(LAWS),
            "cases": keys_of(OUTCOMES),
            "resampled": keys_of((case, "NG") for case in CASES),
            "surfaces": [(surface, model) for surface in SURFACES for model in ("NG", "G")],
            "targets": {surface: chosen(config["surfaces"][surface], MOMENTS) for surface in SURFACES},
            "skewed": SKEWED,
            "sampling": STRIP,
        }
        | cantilever_settings(*PAIRS),
        code=code("checks.py"),
    message:
        "Check the results."
    script:
        "../scripts/checks.py"


rule verdict:
    input:
        "results/checks.csv",
    output:
        "results/verdict.txt",
    log:
        "results/logs/verdict.log",
    params:
        code=code("verdict.py"),
    message:
        "All checks must have passed."
    script:
        "../scripts/verdict.py"
