"""Figures, drawn from datasets only: a change of style reruns nothing but the drawing."""

OTHER_SURFACES = [surface for surface in SURFACES if surface != FIGURE_SURFACE]
DRAWN = ["05", "07", "08", "09", "10", "11", "12", "14", "15"] + ["11_supplement"] * bool(OTHER_SURFACES)
# Groups of the report.
ON_SURFACES, ON_FORCES, ON_BEAMS = "Surfaces (Sec. II)", "Contact forces (Sec. III)", "Beams (Secs. IV and V)"


rule figure_05:
    input:
        forces=f"results/forces/{FIGURE_CASE}_NG.nc",
        fit=f"results/fit/{FIGURE_CASE}_NG.nc",
        style=STYLE,
    output:
        pdf="results/figures/figure_05.pdf",
        png=report(
            "results/figures/figure_05.png",
            caption="../report/figure_05.rst",
            category=ON_FORCES,
            labels={"item": "Figure 5", "shows": "a force curve, its law and its parameters"},
        ),
    log:
        "results/logs/figures/figure_05.log",
    params:
        settings=FIGURE,
        code=code("figure_05.py"),
    message:
        "Figure 5: a force curve and its law."
    script:
        "../scripts/figure_05.py"


rule fit_quality:
    input:
        expand("results/fit/{case}_{model}.nc", case=CASES, model=("G", "NG")),
    output:
        **table_files("fit_quality", "fit of the force curves by Eq. (12)"),
    log:
        "results/logs/tables/fit_quality.log",
    params:
        settings={"keys": keys_of(LAWS)},
        code=code("fit_quality.py"),
    message:
        "Errors of Eq. (12) over all samples of every case."
    script:
        "../scripts/fit_quality.py"


rule figure_07:
    input:
        heights=expand("results/heights/{surface}.nc", surface=SURFACES),
        style=STYLE,
    output:
        pdf="results/figures/figure_07.pdf",
        png=report(
            "results/figures/figure_07.png",
            caption="../report/figure_07.rst",
            category=ON_SURFACES,
            labels={"item": "Figure 7", "shows": "densities of the heights"},
        ),
    log:
        "results/logs/figures/figure_07.log",
    params:
        settings={"surfaces": SURFACES},
        code=code("figure_07.py"),
    message:
        "Figure 7: densities of the heights."
    script:
        "../scripts/figure_07.py"


rule figure_08:
    input:
        characters=expand("results/character/{surface}_NG.nc", surface=SURFACES),
        style=STYLE,
    output:
        pdf="results/figures/figure_08.pdf",
        png=report(
            "results/figures/figure_08.png",
            caption="../report/figure_08.rst",
            category=ON_SURFACES,
            labels={"item": "Figure 8", "shows": "simulated surfaces"},
        ),
    log:
        "results/logs/figures/figure_08.log",
    params:
        settings={"surfaces": SURFACES},
        code=code("figure_08.py"),
    message:
        "Figure 8: simulated surfaces."
    script:
        "../scripts/figure_08.py"


rule figure_09:
    input:
        characters=[f"results/character/{FIGURE_SURFACE}_{model}.nc" for model in ("G", "NG")],
        style=STYLE,
    output:
        pdf="results/figures/figure_09.pdf",
        png=report(
            "results/figures/figure_09.png",
            caption="../report/figure_09.rst",
            category=ON_SURFACES,
            labels={"item": "Figure 9", "shows": "Gaussian and non-Gaussian profile"},
        ),
    log:
        "results/logs/figures/figure_09.log",
    params:
        settings={"surface": FIGURE_SURFACE},
        code=code("figure_09.py"),
    message:
        "Figure 9: profiles of {params.settings[surface]}."
    script:
        "../scripts/figure_09.py"


rule figure_10:
    input:
        heights=expand("results/heights/{surface}.nc", surface=SURFACES),
        spectrum=expand("results/spectrum/{surface}.nc", surface=SURFACES),
        character=expand("results/character/{surface}_NG.nc", surface=SURFACES),
        iteration=expand("results/iteration/{surface}.nc", surface=SURFACES),
        style=STYLE,
    output:
        pdf="results/figures/figure_10.pdf",
        png=report(
            "results/figures/figure_10.png",
            caption="../report/figure_10.rst",
            category=ON_SURFACES,
            labels={"item": "Figure 10", "shows": "spectra of simulated surfaces"},
        ),
    log:
        "results/logs/figures/figure_10.log",
    params:
        settings={"surfaces": SURFACES},
        code=code("figure_10.py"),
    message:
        "Figure 10: spectra of simulated surfaces."
    script:
        "../scripts/figure_10.py"


rule figure_11:
    input:
        gaussian=expand("results/character/{surface}_G.nc", surface=FIGURE_SURFACE),
        other=expand("results/character/{surface}_NG.nc", surface=FIGURE_SURFACE),
        style=STYLE,
    output:
        pdf="results/figures/figure_11.pdf",
        png=report(
            "results/figures/figure_11.png",
            caption="../report/figure_11.rst",
            category=ON_SURFACES,
            labels={"item": "Figure 11", "shows": "heights and radii of summits"},
        ),
    log:
        "results/logs/figures/figure_11.log",
    params:
        settings={"surfaces": [FIGURE_SURFACE]},
        code=code("figure_11.py"),
    message:
        "Figure 11: heights and radii of summits."
    script:
        "../scripts/figure_11.py"


use rule figure_11 as figure_11_supplement with:
    input:
        gaussian=expand("results/character/{surface}_G.nc", surface=OTHER_SURFACES),
        other=expand("results/character/{surface}_NG.nc", surface=OTHER_SURFACES),
        style=STYLE,
    output:
        pdf="results/figures/figure_11_supplement.pdf",
        png=report(
            "results/figures/figure_11_supplement.png",
            caption="../report/figure_11.rst",
            category=ON_SURFACES,
            labels={"item": "Figure 11, supplement", "shows": "heights and radii of summits, other surfaces"},
        ),
    log:
        "results/logs/figures/figure_11_supplement.log",
    params:
        settings={"surfaces": OTHER_SURFACES},
        code=code("figure_11.py"),
    message:
        "Figure 11, supplement: heights and radii of summits of the other surfaces."


rule figure_12:
    input:
        gaussian=expand("results/forces/{case}_G.nc", case=FIGURE_CASES),
        other=expand("results/forces/{case}_NG.nc", case=FIGURE_CASES),
        chaos=expand("results/chaos/{case}_NG.nc", case=FIGURE_CASES),
        style=STYLE,
    output:
        pdf="results/figures/figure_12.pdf",
        png=report(
            "results/figures/figure_12.png",
            caption="../report/figure_12.rst",
            category=ON_FORCES,
            labels={"item": "Figure 12", "shows": "computed and generated force curves"},
        ),
    log:
        "results/logs/figures/figure_12.log",
    params:
        settings=section("seed", cases=dict(zip(PAIRS, FIGURE_CASES))),
        code=code("figure_12.py"),
    message:
        "Figure 12: computed and generated force curves."
    script:
        "../scripts/figure_12.py"


rule figure_14:
    input:
        beams=f"results/beams/{FIGURE_CASE}_NG.nc",
        style=STYLE,
    output:
        pdf="results/figures/figure_14.pdf",
        png=report(
            "results/figures/figure_14.png",
            caption="../report/figure_14.rst",
            category=ON_BEAMS,
            labels={"item": "Figure 14", "shows": "shapes and crack lengths of beams"},
        ),
    log:
        "results/logs/figures/figure_14.log",
    params:
        settings=FIGURE,
        code=code("figure_14.py"),
    message:
        "Figure 14: shapes and crack lengths of beams."
    script:
        "../scripts/figure_14.py"


rule figure_15:
    input:
        beams=expand("results/beams/{case}_{model}.nc", case=CASES, model=MODELS),
        humidity=expand("results/humidity/{pair}_{model}.nc", pair=PAIRS, model=("G", "NG")),
        printed=printed(3),
        style=STYLE,
    output:
        pdf="results/figures/figure_15.pdf",
        png=report(
            "results/figures/figure_15.png",
            caption="../report/figure_15.rst",
            category=ON_BEAMS,
            labels={"item": "Figure 15", "shows": "adhesion energy over the humidity"},
        ),
    log:
        "results/logs/figures/figure_15.log",
    params:
        settings={
            "cases": keys_of(OUTCOMES),
            "bands": [(pair, model) for pair in PAIRS for model in ("G", "NG")],
        }
        | cantilever_settings(*PAIRS),
        code=code("figure_15.py"),
    message:
        "Figure 15: adhesion energy over the humidity."
    script:
        "../scripts/figure_15.py"


rule figures:
    input:
        expand("results/figures/figure_{name}.{kind}", name=DRAWN, kind=("pdf", "png")),
        rules.fit_quality.output,
        rules.study_figures.input,
    message:
        "All figures."
