"""Sec. III-B and App. B: force curves at a humidity, their parameters v and the chaos model of v."""


rule forces:
    input:
        contact=lambda w: paths.contact(w.case, w.model),
    output:
        "results/forces/{case}_{model}.nc",
    log:
        "results/logs/forces/{case}_{model}.log",
    localrule: True
    resources:
        mem_mb=SAMPLES,
    params:
        settings=lambda w: jobs.forces(plan, w.case),
        code=code("forces.py"),
    message:
        "Force curves of {wildcards.case}, {wildcards.model} (Sec. III-B1)."
    script:
        "../scripts/forces.py"


rule chaos:
    input:
        forces="results/forces/{case}_{model}.nc",
    output:
        "results/chaos/{case}_{model}.nc",
    log:
        "results/logs/chaos/{case}_{model}.log",
    localrule: True
    params:
        settings=jobs.chaos(plan),
        code=code("chaos.py"),
    message:
        "Chaos model of the force law of {wildcards.case}, {wildcards.model} (App. B)."
    script:
        "../scripts/chaos.py"


rule fit:
    input:
        contact=lambda w: paths.contact(w.case, w.model),
        forces="results/forces/{case}_{model}.nc",
    output:
        "results/fit/{case}_{model}.nc",
    log:
        "results/logs/fit/{case}_{model}.log",
    localrule: True
    resources:
        mem_mb=SAMPLES,
    params:
        settings=lambda w: jobs.forces(plan, w.case),
        code=code("fit.py"),
    message:
        "Errors of Eq. (12) in {wildcards.case}, {wildcards.model} (Sec. III-B1)."
    script:
        "../scripts/fit.py"


rule humidity:
    input:
        contact="results/contact/{pair}_{model}.nc",
    output:
        "results/humidity/{pair}_{model}.nc",
    log:
        "results/logs/humidity/{pair}_{model}.log",
    localrule: True
    resources:
        mem_mb=SAMPLES,
    params:
        settings=lambda w: jobs.humidity(plan, w.pair),
        code=code("humidity.py"),
    message:
        "Adhesion energy of {wildcards.model} surfaces of pair {wildcards.pair} over the relative humidity."
    script:
        "../scripts/humidity.py"
