"""Tables I, II and III, each as CSV and as Markdown for reading."""


rule table_1:
    input:
        characters=expand("results/character/{surface}_{model}.nc", surface=SURFACES, model=("NG", "G")),
        printed=printed(1),
    output:
        **table_files("table_1", "statistics of the surfaces"),
    log:
        "results/logs/tables/table_1.log",
    params:
        settings={
            "keys": [(s, m) for s in SURFACES for m in ("NG", "G")],
            "measured": {s: chosen(config["surfaces"][s], (*MOMENTS, *SUMMITS)) for s in SURFACES},
        },
        code=code("table_1.py"),
    message:
        "Table I: statistics of the simulated surfaces."
    script:
        "../scripts/table_1.py"


rule table_2:
    input:
        identifications=expand("results/identification/{surface}.nc", surface=MEASURED),
        spectra=expand("results/spectrum/{surface}.nc", surface=MEASURED),
        printed=printed(2),
    output:
        **table_files("table_2", "spectra and their identification"),
    log:
        "results/logs/tables/table_2.log",
    params:
        settings={"surfaces": MEASURED},
        code=code("table_2.py"),
    message:
        "Table II: published and identified spectra."
    script:
        "../scripts/table_2.py"


rule table_3:
    input:
        beams=expand("results/beams/{case}_{model}.nc", case=CASES, model=MODELS),
        forces=expand("results/forces/{case}_{model}.nc", case=CASES, model=("G", "NG", "NG")),
        printed=printed(3),
    output:
        **table_files("table_3", "crack lengths and adhesion energies"),
    log:
        "results/logs/tables/table_3.log",
    params:
        settings={"keys": keys_of(OUTCOMES)},
        code=code("table_3.py"),
    message:
        "Table III: crack lengths and adhesion energies."
    script:
        "../scripts/table_3.py"


rule tables:
    input:
        rules.table_1.output,
        rules.table_2.output if MEASURED else [],
        rules.table_3.output,
    message:
        "All tables."
