"""Sec. II: height density, spectrum and statistics of every surface."""


rule heights:
    input:
        planned,
    output:
        "results/heights/{surface}.nc",
    log:
        "results/logs/heights/{surface}.log",
    wildcard_constraints:
        surface=one_of(set(config["surfaces"]) - set(plan.scanned)),
    localrule: True
    params:
        settings=lambda w: jobs.heights(plan, w.surface),
        code=code("heights.py"),
    message:
        "Maximum-entropy height density of {wildcards.surface} (Sec. II-A)."
    script:
        "../scripts/heights.py"


rule identification:
    input:
        heights="results/heights/{surface}.nc",
    output:
        "results/identification/{surface}.nc",
    log:
        "results/logs/identification/{surface}.log",
    resources:
        mem_mb=MEMORY,
    params:
        settings=lambda w: jobs.identification(plan, w.surface),
        code=code("identification.py"),
    message:
        "Identify the spectrum of {wildcards.surface} from its summits (Sec. II-C)."
    script:
        "../scripts/identification.py"


rule spectrum:
    input:
        heights="results/heights/{surface}.nc",
        identification=lambda w: paths.identification(w.surface),
    output:
        "results/spectrum/{surface}.nc",
    log:
        "results/logs/spectrum/{surface}.log",
    wildcard_constraints:
        surface=one_of(set(config["surfaces"]) - set(plan.scanned)),
    localrule: True
    params:
        settings=lambda w: jobs.spectrum(plan, w.surface),
        code=code("spectrum.py"),
    message:
        "Spectrum of {wildcards.surface} and of the underlying Gaussian field (Sec. II-B)."
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
    resources:
        mem_mb=MEMORY,
    params:
        settings=jobs.iteration(plan),
        code=code("iteration.py"),
    message:
        "Iterative spectrum of {wildcards.surface}, for comparison with the closed form (Fig. 4)."
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
    resources:
        mem_mb=MEMORY,
    params:
        settings=jobs.character(plan),
        code=code("character.py"),
    message:
        "Statistics of simulated {wildcards.model} surfaces {wildcards.surface} (Table I)."
    script:
        "../scripts/character.py"
