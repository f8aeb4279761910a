"""Tables, each as CSV, as Markdown and as HTML for the report."""


rule table_1:
    input:
        heights=expand("results/heights/{surface}.nc", surface=plan.surfaces),
        characters=expand("results/character/{surface}_{model}.nc", surface=plan.surfaces, model=SURFACE_MODELS[::-1]),
        published=published("table_1"),
    output:
        **table_files("table_1", "statistics of the surfaces"),
    log:
        "results/logs/tables/table_1.log",
    localrule: True
    params:
        settings=jobs.table_1(plan),
        code=code("table_1.py"),
    message:
        "Table I: statistics of the simulated surfaces."
    script:
        "../scripts/table_1.py"


rule table_2:
    input:
        identifications=expand("results/identification/{surface}.nc", surface=plan.measured),
        spectra=expand("results/spectrum/{surface}.nc", surface=plan.measured),
        published=published("table_2"),
    output:
        **table_files("table_2", "spectra and their identification"),
    log:
        "results/logs/tables/table_2.log",
    localrule: True
    params:
        settings=jobs.table_2(plan),
        code=code("table_2.py"),
    message:
        "Table II: published and identified spectra."
    script:
        "../scripts/table_2.py"


rule table_3:
    input:
        beams=[f"results/beams/{case}_{model}.nc" for case, model in plan.outcomes],
        forces=[f"results/forces/{case}_{model}.nc" for case, model in plan.laws],
        published=published("table_3"),
    output:
        **table_files("table_3", "crack lengths and adhesion energies"),
    log:
        "results/logs/tables/table_3.log",
    localrule: True
    params:
        settings=jobs.table_3(plan),
        code=code("table_3.py"),
    message:
        "Table III: crack lengths and adhesion energies."
    script:
        "../scripts/table_3.py"


rule fit_quality:
    input:
        fits=[f"results/fit/{case}_{model}.nc" for case, model in plan.laws],
    output:
        **table_files("fit_quality", "fit of the force curves by Eq. (12)"),
    log:
        "results/logs/tables/fit_quality.log",
    localrule: True
    params:
        settings={"laws": plan.laws},
        code=code("fit_quality.py"),
    message:
        "Errors of Eq. (12) over all samples of every case."
    script:
        "../scripts/fit_quality.py"


rule table_sensitivity:
    input:
        studies=expand(
            "results/studies/sensitivity/{pair}_{moment}.nc", pair=plan.figure_pair, moment=plan.shifted_moments
        ),
        published=published("sensitivity"),
    output:
        **table_files("sensitivity", "sensitivity to the moments of a surface"),
    log:
        "results/logs/tables/sensitivity.log",
    localrule: True
    params:
        settings=jobs.figure_13(plan),
        code=code("table_sensitivity.py"),
    message:
        "Figure 13 in numbers."
    script:
        "../scripts/table_sensitivity.py"


rule table_variants:
    input:
        studies=[f"results/studies/variants/{pair}_{variant}.nc" for pair, variant in plan.studied],
        published=published("table_3"),
    output:
        **table_files("variants", "Table III under other model choices"),
    log:
        "results/logs/tables/variants.log",
    localrule: True
    params:
        settings=jobs.table_variants(plan),
        code=code("table_variants.py"),
    message:
        "Table III under other model choices."
    script:
        "../scripts/table_variants.py"


rule table_resampling:
    input:
        beams=expand("results/beams/{case}_NG.nc", case=plan.cases),
        resampled=expand("results/studies/resampling/{case}.nc", case=plan.cases),
    output:
        **table_files("resampling", "effect of the chaos model on the crack length"),
    log:
        "results/logs/tables/resampling.log",
    localrule: True
    params:
        settings={"cases": plan.cases},
        code=code("table_resampling.py"),
    message:
        "Crack lengths on force laws of the chaos model and on resampled force laws."
    script:
        "../scripts/table_resampling.py"


rule tables:
    input:
        rules.table_1.output,
        rules.table_2.output if plan.measured else [],
        rules.table_3.output,
    localrule: True
    message:
        "All tables."
