"""Tables, each as CSV, as Markdown and as HTML for the report."""


rule table_1:
    input:
        estimates=expand("results/estimate/{surface}.nc", surface=plan.estimated),
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
        identifications=expand("results/identification/{surface}.nc", surface=plan.with_summits),
        spectra=expand("results/spectrum/{surface}.nc", surface=plan.with_summits),
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
        by_scans=expand("results/studies/scan_uncertainty/{pair}.nc", pair=plan.scanned_pairs),
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


rule table_scans:
    input:
        estimates=expand("results/estimate/{surface}.nc", surface=plan.scanned),
        spectra=expand("results/spectrum/{surface}.nc", surface=plan.scanned),
        scans=[f"results/scan/{surface}_{number}.nc" for surface in plan.scanned for number in plan.scan_files(surface)],
    output:
        **table_files("scans", "scans of the measured surfaces"),
    log:
        "results/logs/tables/scans.log",
    localrule: True
    params:
        settings=jobs.table_scans(plan),
        code=code("table_scans.py"),
    message:
        "Scans of the measured surfaces."
    script:
        "../scripts/table_scans.py"


rule table_scan_uncertainty:
    input:
        studies=expand("results/studies/scan_uncertainty/{pair}.nc", pair=plan.scanned_pairs),
    output:
        **table_files("scan_uncertainty", "uncertainty due to finite scans"),
    log:
        "results/logs/tables/scan_uncertainty.log",
    localrule: True
    params:
        settings={"pairs": plan.scanned_pairs},
        code=code("table_scan_uncertainty.py"),
    message:
        "Uncertainty of the adhesion energy due to finite scans."
    script:
        "../scripts/table_scan_uncertainty.py"


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
        studies=[f"results/studies/variants/{case}_{variant}.nc" for case, variant in plan.studied_cases],
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
        rules.table_2.output if plan.with_summits else [],
        rules.table_3.output,
        rules.table_scans.output if plan.scanned else [],
        rules.table_scan_uncertainty.output if plan.scanned_pairs else [],
    localrule: True
    message:
        "All tables."
