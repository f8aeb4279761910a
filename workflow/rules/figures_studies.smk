"""Figures of the studies, drawn from datasets only."""


rule figure_13:
    input:
        studies=expand(
            "results/studies/sensitivity/{pair}_{moment}.nc", pair=plan.figure_pair, moment=plan.shifted_moments
        ),
        published=published("sensitivity"),
        style=STYLE,
    output:
        **figure_files("figure_13", ON_STUDIES, "sensitivity to the moments of a surface"),
    log:
        "results/logs/figures/figure_13.log",
    localrule: True
    params:
        settings=jobs.figure_13(plan),
        code=code("figure_13.py"),
    message:
        "Figure 13: sensitivity to the moments of a surface."
    script:
        "../scripts/figure_13.py"


rule figure_16:
    input:
        studies=expand("results/studies/plasticity/{pair}.nc", pair=plan.pressed_pairs),
        style=STYLE,
    output:
        **figure_files("figure_16", ON_STUDIES, "stress of the touching summits"),
    log:
        "results/logs/figures/figure_16.log",
    localrule: True
    params:
        settings={"pairs": plan.pressed_pairs},
        code=code("figure_16.py"),
    message:
        "Figure 16: stress of the touching summits."
    script:
        "../scripts/figure_16.py"


rule figure_17:
    input:
        sizes="results/studies/sample_sizes.nc",
        chaos=expand("results/chaos/{case}_NG.nc", case=plan.cases),
        style=STYLE,
    output:
        **figure_files("figure_17", ON_STUDIES, "convergence in samples and coordinates"),
    log:
        "results/logs/figures/figure_17.log",
    localrule: True
    params:
        settings=jobs.figure_17(plan),
        code=code("figure_17.py"),
    message:
        "Figure 17: convergence in samples and coordinates."
    script:
        "../scripts/figure_17.py"


rule figure_18:
    input:
        orders="results/studies/orders.nc",
        style=STYLE,
    output:
        **figure_files("figure_18", ON_STUDIES, "convergence in the order of the polynomials"),
    log:
        "results/logs/figures/figure_18.log",
    localrule: True
    params:
        settings=jobs.figure_case(plan),
        code=code("figure_18.py"),
    message:
        "Figure 18: convergence in the order of the polynomials."
    script:
        "../scripts/figure_18.py"


rule figure_19:
    input:
        mesh="results/studies/mesh.nc",
        correlation="results/studies/correlation.nc",
        style=STYLE,
    output:
        **figure_files("figure_19", ON_STUDIES, "convergence of the mesh, autocorrelation"),
    log:
        "results/logs/figures/figure_19.log",
    localrule: True
    params:
        settings=jobs.figure_case(plan),
        code=code("figure_19.py"),
    message:
        "Figure 19: convergence of the mesh, autocorrelation."
    script:
        "../scripts/figure_19.py"


rule figure_variants:
    input:
        studies=[f"results/studies/variants/{case}_{variant}.nc" for case, variant in plan.studied_cases],
        published=published("table_3"),
        style=STYLE,
    output:
        **figure_files("variants", ON_STUDIES, "Table III under other model choices"),
    log:
        "results/logs/figures/variants.log",
    localrule: True
    params:
        settings=jobs.table_variants(plan),
        code=code("figure_variants.py"),
    message:
        "Crack lengths under other model choices."
    script:
        "../scripts/figure_variants.py"


rule study_figures:
    input:
        rules.figure_13.output,
        rules.figure_16.output if plan.pressed_pairs else [],
        rules.figure_17.output,
        rules.figure_18.output,
        rules.figure_19.output,
        rules.figure_variants.output,
        rules.table_sensitivity.output,
        rules.table_variants.output,
        rules.table_resampling.output,
    localrule: True
    message:
        "Figures and tables of the studies."
