"""Figures, drawn from datasets only: a change of style reruns only the figures."""


rule figure_05:
    input:
        forces=f"results/forces/{plan.figure_case}_NG.nc",
        fit=f"results/fit/{plan.figure_case}_NG.nc",
        style=STYLE,
    output:
        **figure_files("figure_05", ON_FORCES, "a force curve, its force law and its parameters"),
    log:
        "results/logs/figures/figure_05.log",
    localrule: True
    params:
        settings=jobs.figure_case(plan),
        code=code("figure_05.py"),
    message:
        "Figure 5: a force curve and its force law."
    script:
        "../scripts/figure_05.py"


rule figure_07:
    input:
        heights=expand("results/heights/{surface}.nc", surface=plan.surfaces),
        style=STYLE,
    output:
        **figure_files("figure_07", ON_SURFACES, "densities of the heights"),
    log:
        "results/logs/figures/figure_07.log",
    localrule: True
    params:
        settings={"surfaces": plan.surfaces},
        code=code("figure_07.py"),
    message:
        "Figure 7: densities of the heights."
    script:
        "../scripts/figure_07.py"


rule figure_08:
    input:
        characters=expand("results/character/{surface}_NG.nc", surface=plan.surfaces),
        style=STYLE,
    output:
        **figure_files("figure_08", ON_SURFACES, "simulated surfaces"),
    log:
        "results/logs/figures/figure_08.log",
    localrule: True
    params:
        settings={"surfaces": plan.surfaces},
        code=code("figure_08.py"),
    message:
        "Figure 8: simulated surfaces."
    script:
        "../scripts/figure_08.py"


rule figure_09:
    input:
        characters=expand("results/character/{surface}_{model}.nc", surface=plan.figure_surface, model=SURFACE_MODELS),
        style=STYLE,
    output:
        **figure_files("figure_09", ON_SURFACES, "Gaussian and non-Gaussian profile"),
    log:
        "results/logs/figures/figure_09.log",
    localrule: True
    params:
        settings={"surface": plan.figure_surface},
        code=code("figure_09.py"),
    message:
        "Figure 9: profiles of {params.settings[surface]}."
    script:
        "../scripts/figure_09.py"


rule figure_10:
    input:
        heights=expand("results/heights/{surface}.nc", surface=plan.surfaces),
        spectrum=expand("results/spectrum/{surface}.nc", surface=plan.surfaces),
        character=expand("results/character/{surface}_NG.nc", surface=plan.surfaces),
        iteration=expand("results/iteration/{surface}.nc", surface=plan.surfaces),
        style=STYLE,
    output:
        **figure_files("figure_10", ON_SURFACES, "spectra of simulated surfaces"),
    log:
        "results/logs/figures/figure_10.log",
    localrule: True
    params:
        settings={"surfaces": plan.surfaces},
        code=code("figure_10.py"),
    message:
        "Figure 10: spectra of simulated surfaces."
    script:
        "../scripts/figure_10.py"


rule figure_11:
    input:
        gaussian=expand("results/character/{surface}_G.nc", surface=plan.figure_surface),
        other=expand("results/character/{surface}_NG.nc", surface=plan.figure_surface),
        style=STYLE,
    output:
        **figure_files("figure_11", ON_SURFACES, "heights and radii of summits"),
    log:
        "results/logs/figures/figure_11.log",
    localrule: True
    params:
        settings={"surfaces": [plan.figure_surface]},
        code=code("figure_11.py"),
    message:
        "Figure 11: heights and radii of summits."
    script:
        "../scripts/figure_11.py"


use rule figure_11 as figure_11_supplement with:
    input:
        gaussian=expand("results/character/{surface}_G.nc", surface=plan.other_surfaces),
        other=expand("results/character/{surface}_NG.nc", surface=plan.other_surfaces),
        style=STYLE,
    output:
        **figure_files("figure_11_supplement", ON_SURFACES, "heights and radii of summits, other surfaces", "figure_11"),
    log:
        "results/logs/figures/figure_11_supplement.log",
    params:
        settings={"surfaces": plan.other_surfaces},
        code=code("figure_11.py"),
    message:
        "Figure 11, supplement: heights and radii of summits of the other surfaces."


rule figure_12:
    input:
        gaussian=expand("results/forces/{case}_G.nc", case=plan.figure_cases.values()),
        other=expand("results/forces/{case}_NG.nc", case=plan.figure_cases.values()),
        chaos=expand("results/chaos/{case}_NG.nc", case=plan.figure_cases.values()),
        style=STYLE,
    output:
        **figure_files("figure_12", ON_FORCES, "computed and generated force curves"),
    log:
        "results/logs/figures/figure_12.log",
    localrule: True
    params:
        settings={"seed": config["seed"], "cases": plan.figure_cases},
        code=code("figure_12.py"),
    message:
        "Figure 12: computed and generated force curves."
    script:
        "../scripts/figure_12.py"


rule figure_14:
    input:
        beams=f"results/beams/{plan.figure_case}_NG.nc",
        style=STYLE,
    output:
        **figure_files("figure_14", ON_BEAMS, "shapes and crack lengths of beams"),
    log:
        "results/logs/figures/figure_14.log",
    localrule: True
    params:
        settings=jobs.figure_case(plan),
        code=code("figure_14.py"),
    message:
        "Figure 14: shapes and crack lengths of beams."
    script:
        "../scripts/figure_14.py"


rule figure_15:
    input:
        beams=[f"results/beams/{case}_{model}.nc" for case, model in plan.outcomes],
        humidity=expand("results/humidity/{pair}_{model}.nc", pair=plan.pairs, model=SURFACE_MODELS),
        published=published("table_3"),
        style=STYLE,
    output:
        **figure_files("figure_15", ON_BEAMS, "adhesion energy over the relative humidity"),
    log:
        "results/logs/figures/figure_15.log",
    localrule: True
    params:
        settings=jobs.figure_15(plan),
        code=code("figure_15.py"),
    message:
        "Figure 15: adhesion energy over the relative humidity."
    script:
        "../scripts/figure_15.py"


rule figure_overview:
    input:
        character=f"results/character/{plan.figure_surface}_NG.nc",
        forces=f"results/forces/{plan.figure_case}_NG.nc",
        beams=f"results/beams/{plan.figure_case}_NG.nc",
        released=[f"results/beams/{case}_{model}.nc" for case, model in plan.figure_outcomes],
        published=published("table_3"),
        style=STYLE,
    output:
        **figure_files("overview", ON_BEAMS, "from surfaces to crack lengths"),
    log:
        "results/logs/figures/overview.log",
    localrule: True
    params:
        settings=jobs.figure_overview(plan),
        code=code("figure_overview.py"),
    message:
        "Overview of pair {params.settings[pair]}."
    script:
        "../scripts/figure_overview.py"


rule surface_sheet:
    input:
        estimate="results/estimate/{surface}.nc",
        spectrum="results/spectrum/{surface}.nc",
        style=STYLE,
    output:
        **figure_files("surface_sheet_{surface}", ON_SURFACES, "scans of {surface}", caption="surface_sheet"),
    log:
        "results/logs/figures/surface_sheet_{surface}.log",
    localrule: True
    params:
        settings=lambda w: {"surface": w.surface},
        code=code("surface_sheet.py"),
    message:
        "Sheet of the measured surface {wildcards.surface}."
    script:
        "../scripts/surface_sheet.py"


rule measured:
    input:
        expand("results/figures/surface_sheet_{surface}.{kind}", surface=plan.scanned, kind=("pdf", "png")),
        rules.table_3.output,
        rules.table_scans.output if plan.scanned else [],
        rules.table_scan_uncertainty.output if plan.scanned_pairs else [],
    localrule: True
    message:
        "Sheets and tables of the measured surfaces."


rule figures:
    input:
        expand("results/figures/figure_{name}.{kind}", name=["05", "07", "08", "09", "10", "11"], kind=("pdf", "png")),
        rules.figure_11_supplement.output if plan.other_surfaces else [],
        expand("results/figures/figure_{name}.{kind}", name=["12", "14", "15"], kind=("pdf", "png")),
        rules.figure_overview.output,
        rules.measured.input,
        rules.fit_quality.output,
        rules.study_figures.input,
    localrule: True
    message:
        "All figures."
