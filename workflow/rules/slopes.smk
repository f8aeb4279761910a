"""Effect of the measured quantities of a surface on a pair, with common random numbers; for scans and budgets."""


rule slope_contact:
    input:
        unpack(surfaces_of_pair),
        # Modes are those of the measured heights, which the surface may not have.
        estimates=lambda w: ["results/estimate/{surface}.nc"] if w.quantity in OF_MEASURED[1:] else [],
    output:
        expand("results/studies/slopes/contact/{{pair}}_{{surface}}_{{quantity}}_{side}.nc", side=SHIFTED),
    log:
        "results/logs/studies/slopes/contact/{pair}_{surface}_{quantity}.log",
    resources:
        mem_mb=memory.of_drawn(VIEW, config["studies"]["slopes"]["samples"], contacts=len(SHIFTED)),
    params:
        settings=lambda w: jobs.slope_contact(plan, w.pair),
        code=code("slope_contact.py"),
    message:
        "Contact of pair {wildcards.pair} with less and more {wildcards.quantity} of {wildcards.surface}."
    script:
        "../scripts/slope_contact.py"


rule slopes:
    input:
        unpack(lambda w: paths.shifted_contacts(w.pair, w.surface)),
    output:
        "results/studies/slopes/{pair}_{surface}.nc",
    log:
        "results/logs/studies/slopes/{pair}_{surface}.log",
    localrule: True
    params:
        settings=lambda w: jobs.sensitivity(plan, w.pair),
        code=code("slopes.py"),
    message:
        "Slopes of the adhesion of pair {wildcards.pair} to the quantities of {wildcards.surface}."
    script:
        "../scripts/slopes.py"


# Measured surfaces


rule choice_contact:
    input:
        unpack(surfaces_of_pair),
        estimates=lambda w: paths.estimates(w.pair),
    output:
        "results/studies/choices/{pair}_{choice}.nc",
    log:
        "results/logs/studies/choices/{pair}_{choice}.log",
    resources:
        mem_mb=memory.of_drawn(VIEW, config["studies"]["slopes"]["samples"]),
    params:
        settings=lambda w: jobs.choice_contact(plan, w.pair),
        code=code("choice_contact.py"),
    message:
        "Contact of pair {wildcards.pair} with the other value of {wildcards.choice}."
    script:
        "../scripts/choice_contact.py"


rule scan_uncertainty:
    input:
        slopes=lambda w: expand(
            "results/studies/slopes/{pair}_{surface}.nc", pair=w.pair, surface=plan.scanned_sides(w.pair)
        ),
        estimates=lambda w: paths.estimates(w.pair),
        base="results/contact/{pair}_NG.nc",
        choices=expand("results/studies/choices/{{pair}}_{choice}.nc", choice=ALTERNATIVES_OF_SCANS),
    output:
        "results/studies/scan_uncertainty/{pair}.nc",
    log:
        "results/logs/studies/scan_uncertainty/{pair}.log",
    localrule: True
    params:
        settings=lambda w: jobs.sensitivity(plan, w.pair),
        code=code("scan_uncertainty.py"),
    message:
        "Uncertainty of the adhesion of pair {wildcards.pair} due to finite scans."
    script:
        "../scripts/scan_uncertainty.py"
