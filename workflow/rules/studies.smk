"""Studies beside the main line: Fig. 13, Appendices A to C and other readings of what the paper leaves open."""


wildcard_constraints:
    moment="rms|skewness|kurtosis",
    side="less|more",
    reading="base|[a-z_]+_[a-z0-9.-]+",


rule sensitivity_contact:
    input:
        unpack(surfaces_of_pair),
    output:
        "results/studies/sensitivity/contact/{pair}_{moment}_{side}.nc",
    log:
        "results/logs/studies/sensitivity/contact/{pair}_{moment}_{side}.log",
    threads: 1
    resources:
        mem_mb=800,
        runtime=30,
    params:
        settings=lambda w: section(
            "seed",
            "sampling",
            "solid",
            "van_der_waals",
            **meeting(w),
            contact=CONTACT | {"samples": STUDIES["sensitivity"]["samples"]},
            step=STUDIES["sensitivity"]["step"],
        ),
        code=code("sensitivity_contact.py"),
    message:
        "Contact of pair {wildcards.pair} with {wildcards.side} {wildcards.moment} (Fig. 13)."
    script:
        "../scripts/sensitivity_contact.py"


rule sensitivity:
    input:
        expand("results/studies/sensitivity/contact/{{pair}}_{{moment}}_{side}.nc", side=("less", "more")),
    output:
        "results/studies/sensitivity/{pair}_{moment}.nc",
    log:
        "results/logs/studies/sensitivity/{pair}_{moment}.log",
    params:
        settings=lambda w: section("water", humidities=config["pairs"][w.pair]["humidities"]),
        code=code("sensitivity.py"),
    message:
        "Sensitivity of the adhesion of pair {wildcards.pair} to {wildcards.moment} (Fig. 13)."
    script:
        "../scripts/sensitivity.py"


rule plasticity:
    input:
        unpack(surfaces_of_pair),
    output:
        "results/studies/plasticity/{pair}.nc",
    log:
        "results/logs/studies/plasticity/{pair}.log",
    threads: 1
    resources:
        mem_mb=800,
        runtime=10,
    params:
        settings=lambda w: section(
            "seed",
            "sampling",
            "solid",
            "van_der_waals",
            **meeting(w),
            contact=CONTACT,
            strips=STUDIES["plasticity"]["strips"],
            distance_nm=STUDIES["plasticity"]["distance_nm"][w.pair],
        ),
        code=code("plasticity.py"),
    message:
        "Stress of the touching summits of pair {wildcards.pair} (App. A)."
    script:
        "../scripts/plasticity.py"


rule sample_sizes:
    input:
        f"results/forces/{FIGURE_CASE}_NG.nc",
    output:
        "results/studies/sample_sizes.nc",
    log:
        "results/logs/studies/sample_sizes.log",
    params:
        settings={"shares": STUDIES["sample_shares"], "case": FIGURE_CASE},
        code=code("sample_sizes.py"),
    message:
        "Convergence of the adhesion energy in the number of samples (App. B)."
    script:
        "../scripts/sample_sizes.py"


rule orders:
    input:
        forces=f"results/forces/{FIGURE_CASE}_NG.nc",
        model=f"results/chaos/{FIGURE_CASE}_NG.nc",
    output:
        "results/studies/orders.nc",
    log:
        "results/logs/studies/orders.log",
    threads: 1
    resources:
        mem_mb=800,
        runtime=10,
    params:
        settings=section("seed", draws=STUDIES["orders"]["draws"], case=FIGURE_CASE),
        code=code("orders.py"),
    message:
        "Convergence of the chaos model in the order of its polynomials (App. B)."
    script:
        "../scripts/orders.py"


rule mesh:
    input:
        f"results/forces/{FIGURE_CASE}_NG.nc",
    output:
        "results/studies/mesh.nc",
    log:
        "results/logs/studies/mesh.log",
    params:
        settings={"mesh": STUDIES["mesh"], "case": FIGURE_CASE, "pair": FIGURE_PAIR} | cantilever_settings(FIGURE_PAIR),
        code=code("mesh.py"),
    message:
        "Convergence of the crack length in the mesh of the beam (App. C)."
    script:
        "../scripts/mesh.py"


rule correlation:
    input:
        expand("results/spectrum/{surface}.nc", surface=SURFACES),
    output:
        "results/studies/correlation.nc",
    log:
        "results/logs/studies/correlation.log",
    params:
        settings={"surfaces": SURFACES},
        code=code("correlation.py"),
    message:
        "Autocorrelation of the surfaces (App. C)."
    script:
        "../scripts/correlation.py"


rule reading_contact:
    input:
        lambda w: expand(
            "results/identification/{surface}.nc", surface=reading_contact_settings(w.pair, w.reading)["identified"]
        ),
    output:
        "results/studies/readings/contact/{pair}_{reading}.nc",
    log:
        "results/logs/studies/readings/contact/{pair}_{reading}.log",
    threads: 1
    resources:
        mem_mb=800,
        runtime=30,
    params:
        settings=lambda w: reading_contact_settings(w.pair, w.reading),
        code=code("reading_contact.py"),
    message:
        "Contact of pair {wildcards.pair} under reading {wildcards.reading}."
    script:
        "../scripts/reading_contact.py"


rule reading:
    input:
        contact_of_reading,
    output:
        "results/studies/readings/{pair}_{reading}.nc",
    log:
        "results/logs/studies/readings/{pair}_{reading}.log",
    threads: 1
    resources:
        mem_mb=800,
        runtime=10,
    params:
        settings=reading_settings,
        code=code("reading.py"),
    message:
        "Crack lengths of pair {wildcards.pair} under reading {wildcards.reading}."
    script:
        "../scripts/reading.py"


rule resampling:
    input:
        "results/forces/{case}_NG.nc",
    output:
        "results/studies/resampling/{case}.nc",
    log:
        "results/logs/studies/resampling/{case}.log",
    threads: 1
    resources:
        mem_mb=800,
        runtime=10,
    params:
        settings=lambda w: section(
            "seed",
            **cantilever_settings(keys.pair_of(w.case)),
            sampling=STRIP,
            beams=STUDIES["resampling"]["beams"],
        ),
        code=code("resampling.py"),
    message:
        "Release the beams of {wildcards.case} on laws of the samples themselves (App. B)."
    script:
        "../scripts/resampling.py"
