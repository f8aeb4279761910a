"""Studies beside the main line: Fig. 13, Appendices A to C and other readings of what the paper leaves open."""


wildcard_constraints:
    moment="rms|skewness|kurtosis",
    side="less|more",
    reading="base|[a-z_]+_[a-z0-9.-]+",


def sides_of(pair):
    """Names of the surfaces of a pair, the beam's first."""
    return [config["pairs"][pair][side] for side in SIDES]


def psd_under(reading, surface):
    """Source of the spectrum of a surface under a reading: the one it asks for, where that is known."""
    entry = config["surfaces"][surface]
    known = {"published": "published_psd" in entry, "identified": surface in MEASURED}
    wanted = READINGS[reading].get("psd", entry["psd"])
    return wanted if known[wanted] else entry["psd"]


def surface_under(reading, surface):
    """What a surface is drawn from under a reading."""
    entry, psd = config["surfaces"][surface], psd_under(reading, surface)
    keys = ["rms_nm", "skewness", "kurtosis"] + ["published_psd"] * (psd == "published")
    return {key: entry[key] for key in keys} | {"psd": psd}


def changes_something(reading, pair):
    """Whether a reading differs from the base; that of a spectrum does only where another is known."""
    differs = (surface_under(reading, name) != surface_under("base", name) for name in sides_of(pair))
    return reading == "base" or "psd" not in READINGS[reading] or any(differs)


def identified_under(wildcards):
    """Surfaces of a pair whose spectrum is an identified one under a reading."""
    names = sorted(set(sides_of(wildcards.pair)))
    return [name for name in names if psd_under(wildcards.reading, name) == "identified"]


def reading_contact_settings(wildcards):
    """What the contact under a reading starts from, and what the reading changes."""
    pair, reading = wildcards.pair, wildcards.reading
    base = section(
        "seed",
        "sampling",
        "solid",
        "van_der_waals",
        contact=CONTACT | {"samples": STUDIES["readings"]["samples"]},
        beam={"width_um": config["beam"]["width_um"]},
        pairs={pair: dict(zip(SIDES, sides_of(pair)))},
        surfaces={name: surface_under(reading, name) for name in sides_of(pair)},
    )
    changes = {key: change for key, change in READINGS[reading].items() if key != "psd"}
    return {"base": base, "changes": changes, "identified": identified_under(wildcards)}


def cantilever_settings(pair, **of_pair):
    """Sections from which `stiction.study` makes the nominal beam of a pair and counts its force laws."""
    dimensions = ("length_um", "width_um", "thickness_um", "elements")
    return {
        "seed": config["seed"],
        "solid": {"young_modulus_GPa": config["solid"]["young_modulus_GPa"]},
        "sampling": {"strip_length_um": config["sampling"]["strip_length_um"]},
        "beam": {key: config["beam"][key] for key in dimensions},
        "pairs": {pair: {"gap_um": config["pairs"][pair]["gap_um"]} | of_pair},
    }


def reading_settings(wildcards):
    """What follows the contact under a reading: water, force laws and beams without scatter, at all humidities."""
    pair = wildcards.pair
    settings = cantilever_settings(pair, humidities=config["pairs"][pair]["humidities"])
    settings["beam"]["samples"] = STUDIES["readings"]["beams"]
    return settings | section("water", "chaos")


rule sensitivity_contact:
    input:
        unpack(surfaces_of_pair),
    output:
        "results/studies/sensitivity/contact/{pair}_{moment}_{side}.nc",
    log:
        "results/logs/studies/sensitivity/{pair}_{moment}_{side}.log",
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
    resources:
        mem_mb=800,
        runtime=10,
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


rule reading_contact:
    input:
        lambda w: expand("results/identification/{surface}.nc", surface=identified_under(w)),
    output:
        "results/studies/readings/contact/{pair}_{reading}.nc",
    log:
        "results/logs/studies/readings/contact/{pair}_{reading}.log",
    resources:
        mem_mb=800,
        runtime=30,
    params:
        settings=reading_contact_settings,
        code=code("reading_contact.py"),
    message:
        "Contact of pair {wildcards.pair} under reading {wildcards.reading}."
    script:
        "../scripts/reading_contact.py"


rule reading:
    input:
        "results/studies/readings/contact/{pair}_{reading}.nc",
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


rule resampling:
    input:
        "results/forces/{case}_NG.nc",
    output:
        "results/studies/resampling/{case}.nc",
    log:
        "results/logs/studies/resampling/{case}.log",
    resources:
        mem_mb=600,
        runtime=30,
    params:
        settings=lambda w: cantilever_settings(keys.pair_of(w.case)) | {"beams": STUDIES["resampling"]["beams"]},
        code=code("resampling.py"),
    message:
        "Release the beams of {wildcards.case} on laws of the samples themselves (App. B)."
    script:
        "../scripts/resampling.py"
