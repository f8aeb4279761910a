"""Figures and tables of the studies beside the main line, from datasets only."""

# Group of the report.
ON_STUDIES = "Sensitivity, appendices, readings"
SENSITIVITIES = expand("results/studies/sensitivity/{pair}_{moment}.nc", pair=FIGURE_PAIR, moment=SHIFTED)
STUDY_FIGURES = ["figure_13", "figure_17", "figure_18", "figure_19", "readings"] + ["figure_16"] * bool(PRESSED_PAIRS)


rule figure_13:
    input:
        studies=SENSITIVITIES,
        printed=str(BASE / "workflow" / "resources" / "sensitivity.csv"),
        style=STYLE,
    output:
        pdf="results/figures/figure_13.pdf",
        png=report(
            "results/figures/figure_13.png",
            caption="../report/figure_13.rst",
            category=ON_STUDIES,
            labels={"item": "Figure 13", "shows": "sensitivity to the moments of a surface"},
        ),
    log:
        "results/logs/figures/figure_13.log",
    params:
        settings={"pair": FIGURE_PAIR, "moments": SHIFTED},
        code=code("figure_13.py"),
    message:
        "Figure 13: sensitivity to the moments of a surface."
    script:
        "../scripts/figure_13.py"


rule table_sensitivity:
    input:
        studies=SENSITIVITIES,
        printed=str(BASE / "workflow" / "resources" / "sensitivity.csv"),
    output:
        **table_files("sensitivity", "sensitivity to the moments of a surface"),
    log:
        "results/logs/tables/sensitivity.log",
    params:
        settings={"pair": FIGURE_PAIR, "moments": SHIFTED},
        code=code("table_sensitivity.py"),
    message:
        "Figure 13 in numbers."
    script:
        "../scripts/table_sensitivity.py"


rule figure_16:
    input:
        studies=expand("results/studies/plasticity/{pair}.nc", pair=PRESSED_PAIRS),
        style=STYLE,
    output:
        pdf="results/figures/figure_16.pdf",
        png=report(
            "results/figures/figure_16.png",
            caption="../report/figure_16.rst",
            category=ON_STUDIES,
            labels={"item": "Figure 16", "shows": "stress of the touching summits"},
        ),
    log:
        "results/logs/figures/figure_16.log",
    params:
        settings={"pairs": PRESSED_PAIRS},
        code=code("figure_16.py"),
    message:
        "Figure 16: stress of the touching summits."
    script:
        "../scripts/figure_16.py"


rule figure_17:
    input:
        sizes="results/studies/sample_sizes.nc",
        chaos=expand("results/chaos/{case}_NG.nc", case=CASES),
        style=STYLE,
    output:
        pdf="results/figures/figure_17.pdf",
        png=report(
            "results/figures/figure_17.png",
            caption="../report/figure_17.rst",
            category=ON_STUDIES,
            labels={"item": "Figure 17", "shows": "convergence in samples and coordinates"},
        ),
    log:
        "results/logs/figures/figure_17.log",
    params:
        settings={
            "cases": [(keys.pair_of(c), keys.humidity_of(c)) for c in CASES],
            "tolerance": config["chaos"]["dimension_tolerance"],
        }
        | FIGURE,
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
        pdf="results/figures/figure_18.pdf",
        png=report(
            "results/figures/figure_18.png",
            caption="../report/figure_18.rst",
            category=ON_STUDIES,
            labels={"item": "Figure 18", "shows": "convergence in the order of the polynomials"},
        ),
    log:
        "results/logs/figures/figure_18.log",
    params:
        settings=FIGURE,
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
        pdf="results/figures/figure_19.pdf",
        png=report(
            "results/figures/figure_19.png",
            caption="../report/figure_19.rst",
            category=ON_STUDIES,
            labels={"item": "Figure 19", "shows": "convergence of the mesh, autocorrelation"},
        ),
    log:
        "results/logs/figures/figure_19.log",
    params:
        settings=FIGURE,
        code=code("figure_19.py"),
    message:
        "Figure 19: convergence of the mesh, autocorrelation."
    script:
        "../scripts/figure_19.py"


rule figure_readings:
    input:
        studies=[f"results/studies/readings/{pair}_{reading}.nc" for pair, reading in STUDIED],
        printed=printed(3),
        style=STYLE,
    output:
        pdf="results/figures/readings.pdf",
        png=report(
            "results/figures/readings.png",
            caption="../report/readings.rst",
            category=ON_STUDIES,
            labels={"item": "Readings", "shows": "Table III under other readings of the paper"},
        ),
    log:
        "results/logs/figures/readings.log",
    params:
        settings={"keys": STUDIED},
        code=code("figure_readings.py"),
    message:
        "Crack lengths under other readings of the paper."
    script:
        "../scripts/figure_readings.py"


rule table_readings:
    input:
        studies=[f"results/studies/readings/{pair}_{reading}.nc" for pair, reading in STUDIED],
        printed=printed(3),
    output:
        **table_files("readings", "Table III under other readings of the paper"),
    log:
        "results/logs/tables/readings.log",
    params:
        settings={"keys": STUDIED},
        code=code("table_readings.py"),
    message:
        "Table III under other readings of the paper."
    script:
        "../scripts/table_readings.py"


rule table_resampling:
    input:
        beams=expand("results/beams/{case}_NG.nc", case=CASES),
        resampled=expand("results/studies/resampling/{case}.nc", case=CASES),
    output:
        **table_files("resampling", "what the chaos model does to the crack length"),
    log:
        "results/logs/tables/resampling.log",
    params:
        settings={"keys": [(keys.pair_of(case), keys.humidity_of(case)) for case in CASES]},
        code=code("table_resampling.py"),
    message:
        "Crack lengths on laws of the chaos model and of the samples."
    script:
        "../scripts/table_resampling.py"


rule study_figures:
    input:
        expand("results/figures/{name}.{kind}", name=STUDY_FIGURES, kind=("pdf", "png")),
        rules.table_sensitivity.output,
        rules.table_readings.output,
        rules.table_resampling.output,
    message:
        "Figures and tables of the studies beside the main line."
