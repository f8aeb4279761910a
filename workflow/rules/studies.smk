"""Studies beside the main line: Fig. 13, Appendices A to C and other readings of what the paper leaves open."""


wildcard_constraints:
    moment="rms|skewness|kurtosis",
    reading="base|[a-z_]+_[a-z0-9.-]+",


rule sensitivity:
    input:
        unpack(surfaces_of_pair),
    output:
        "results/studies/sensitivity/{pair}_{moment}.nc",
    log:
        "results/logs/studies/sensitivity/{pair}_{moment}.log",
    resources:
        mem_mb=800,
        runtime=30,
    params:
        settings=lambda w: section(
            "seed",
            "sampling",
            "solid",
            "van_der_waals",
            "water",
            **meeting(w),
            contact=CONTACT | {"samples": STUDIES["sensitivity"]["samples"]},
            humidities=config["pairs"][w.pair]["humidities"],
            step=STUDIES["sensitivity"]["step"],
        ),
        code=code("sensitivity.py"),
    message:
        "Adhesion of pair {wildcards.pair} with more and less {wildcards.moment} (Fig. 13)."
    script:
        "../scripts/sensitivity.py"


rule plasticity:
    input:
        unpack(surfaces_of_pair),
    output:
        "results/studies/plasticity/{pair}.nc",
    log:
        "results/logs/studies/plasticity/{pair}.log",
    resources:
        mem_mb=700,
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
    resources:
        mem_mb=700,
        runtime=10,
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
    resources:
        mem_mb=700,
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
    resources:
        mem_mb=700,
        runtime=10,
    params:
        settings=section(
            "solid",
            beam={key: config["beam"][key] for key in ("length_um", "width_um", "thickness_um", "elements")},
            mesh=STUDIES["mesh"],
            case=FIGURE_CASE,
            pair=FIGURE_PAIR,
            pairs={FIGURE_PAIR: {"gap_um": config["pairs"][FIGURE_PAIR]["gap_um"]}},
        ),
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
    resources:
        mem_mb=700,
        runtime=10,
    params:
        settings={"surfaces": SURFACES},
        code=code("correlation.py"),
    message:
        "Autocorrelation of the surfaces (App. C)."
    script:
        "../scripts/correlation.py"


rule reading:
    input:
        lambda w: expand("results/identification/{surface}.nc", surface=identified_under(w)),
    output:
        "results/studies/readings/{pair}_{reading}.nc",
    log:
        "results/logs/studies/readings/{pair}_{reading}.log",
    resources:
        mem_mb=800,
        runtime=30,
    params:
        settings=reading_settings,
        code=code("reading.py"),
    message:
        "Crack lengths of pair {wildcards.pair} under reading {wildcards.reading}."
    script:
        "../scripts/reading.py"
