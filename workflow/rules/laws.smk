"""Sec. III-B and App. B: force curves at a humidity, their parameters and the chaos model of these."""


rule forces:
    input:
        lambda w: f"results/contact/{keys.pair_of(w.case)}_{w.model}.nc",
    output:
        "results/forces/{case}_{model}.nc",
    log:
        "results/logs/forces/{case}_{model}.log",
    params:
        settings=lambda w: section("water", humidity=keys.humidity_of(w.case)),
        code=code("forces.py"),
    message:
        "Force curves of {wildcards.case}, {wildcards.model} (Sec. III-B1)."
    script:
        "../scripts/forces.py"


rule chaos:
    input:
        "results/forces/{case}_{model}.nc",
    output:
        "results/chaos/{case}_{model}.nc",
    log:
        "results/logs/chaos/{case}_{model}.log",
    params:
        settings=lambda w: section("chaos", "seed"),
        code=code("chaos.py"),
    message:
        "Chaos model of the force law of {wildcards.case}, {wildcards.model} (App. B)."
    script:
        "../scripts/chaos.py"


rule fit:
    input:
        contact=lambda w: f"results/contact/{keys.pair_of(w.case)}_{w.model}.nc",
        forces="results/forces/{case}_{model}.nc",
    output:
        "results/fit/{case}_{model}.nc",
    log:
        "results/logs/fit/{case}_{model}.log",
    params:
        settings=lambda w: section("water", humidity=keys.humidity_of(w.case)),
        code=code("fit.py"),
    message:
        "Errors of Eq. (12) in {wildcards.case}, {wildcards.model} (Sec. III-B1)."
    script:
        "../scripts/fit.py"


rule humidity:
    input:
        "results/contact/{pair}_{model}.nc",
    output:
        "results/humidity/{pair}_{model}.nc",
    log:
        "results/logs/humidity/{pair}_{model}.log",
    params:
        settings=lambda w: section(
            "water",
            points=config["figures"]["humidity_points"],
            range=[bound(config["pairs"][w.pair]["humidities"]) for bound in (min, max)],
        ),
        code=code("humidity.py"),
    message:
        "Adhesion energy of {wildcards.model} surfaces of pair {wildcards.pair} along the humidity."
    script:
        "../scripts/humidity.py"
