"""Sec. II: height density, spectrum and statistics of every surface."""


rule heights:
    output:
        "results/heights/{surface}.nc",
    log:
        "results/logs/heights/{surface}.log",
    params:
        settings=lambda w: chosen(config["surfaces"][w.surface], MOMENTS),
        code=code("heights.py"),
    message:
        "Maximum-entropy height density of {wildcards.surface} (Sec. II-A)."
    script:
        "../scripts/heights.py"


rule identify:
    input:
        heights="results/heights/{surface}.nc",
    output:
        "results/identification/{surface}.nc",
    log:
        "results/logs/identification/{surface}.log",
    threads: 1
    resources:
        mem_mb=800,
        runtime=10,
    params:
        settings=lambda w: section("seed", "identification")
        | {
            "spacing_nm": config["sampling"]["spacing_nm"],
            "target_spacing_nm": config["character"]["spacing_nm"],
            "target": chosen(config["surfaces"][w.surface], SUMMITS),
        },
        code=code("identify.py"),
    message:
        "Identify the spectrum of {wildcards.surface} from its summits (Sec. II-C)."
    script:
        "../scripts/identify.py"


rule spectrum:
    input:
        unpack(spectrum_source),
        heights="results/heights/{surface}.nc",
    output:
        "results/spectrum/{surface}.nc",
    log:
        "results/logs/spectrum/{surface}.log",
    params:
        settings=lambda w: {
            "spacing_nm": config["sampling"]["spacing_nm"],
            "psd": (
                config["surfaces"][w.surface]["published_psd"]
                if config["surfaces"][w.surface]["psd"] == "published"
                else "identified"
            ),
        },
        code=code("spectrum.py"),
    message:
        "Spectrum of {wildcards.surface} and of the Gaussian field behind it (Sec. II-B)."
    script:
        "../scripts/spectrum.py"


rule iteration:
    input:
        heights="results/heights/{surface}.nc",
        spectrum="results/spectrum/{surface}.nc",
    output:
        "results/iteration/{surface}.nc",
    log:
        "results/logs/iteration/{surface}.log",
    threads: 1
    resources:
        mem_mb=800,
        runtime=10,
    params:
        settings=lambda w: section(
            "seed", iteration=config["studies"]["iteration"], spacing_nm=config["sampling"]["spacing_nm"]
        ),
        code=code("iteration.py"),
    message:
        "Iterative spectrum of {wildcards.surface}, beside the closed form (Fig. 4)."
    script:
        "../scripts/iteration.py"


rule character:
    input:
        heights="results/heights/{surface}.nc",
        spectrum="results/spectrum/{surface}.nc",
    output:
        "results/character/{surface}_{model}.nc",
    log:
        "results/logs/character/{surface}_{model}.log",
    threads: 1
    resources:
        mem_mb=800,
        runtime=10,
    params:
        settings=lambda w: section("seed", "sampling", "character", beam={"width_um": config["beam"]["width_um"]}),
        code=code("character.py"),
    message:
        "Statistics of simulated {wildcards.model} surfaces {wildcards.surface} (Table I)."
    script:
        "../scripts/character.py"
