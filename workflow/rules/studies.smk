"""Studies outside the main line: Fig. 13, Appendices A to C and variants (model choices that the paper leaves open)."""


rule sensitivity_contact:
    input:
        unpack(surfaces_of_pair),
    output:
        expand(
            "results/studies/sensitivity/contact/{{pair}}_{moment}_{side}.nc",
            moment=plan.shifted_moments,
            side=SHIFTED,
        ),
    log:
        "results/logs/studies/sensitivity/contact/{pair}.log",
    # The longest job; it begins early, so that no core waits for it at the end.
    priority: 1
    resources:
        runtime=30,
        mem_mb=memory.of_drawn(
            VIEW, config["studies"]["sensitivity"]["samples"], contacts=len(plan.shifted_moments) * len(SHIFTED)
        ),
    params:
        settings=lambda w: jobs.sensitivity_contact(plan, w.pair),
        code=code("sensitivity_contact.py"),
    message:
        "Contact of pair {wildcards.pair} with less and more of each moment (Fig. 13)."
    script:
        "../scripts/sensitivity_contact.py"


rule sensitivity:
    input:
        contacts=expand("results/studies/sensitivity/contact/{{pair}}_{{moment}}_{side}.nc", side=SHIFTED),
    output:
        "results/studies/sensitivity/{pair}_{moment}.nc",
    log:
        "results/logs/studies/sensitivity/{pair}_{moment}.log",
    localrule: True
    params:
        settings=lambda w: jobs.sensitivity(plan, w.pair),
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
        mem_mb=MEMORY,
    params:
        settings=lambda w: jobs.plasticity(plan, w.pair),
        code=code("plasticity.py"),
    message:
        "Stress of the touching summits of pair {wildcards.pair} (App. A)."
    script:
        "../scripts/plasticity.py"


rule sample_sizes:
    input:
        forces=f"results/forces/{plan.figure_case}_NG.nc",
    output:
        "results/studies/sample_sizes.nc",
    log:
        "results/logs/studies/sample_sizes.log",
    localrule: True
    params:
        settings=jobs.sample_sizes(plan),
        code=code("sample_sizes.py"),
    message:
        "Convergence of the adhesion energy in the number of samples (App. B)."
    script:
        "../scripts/sample_sizes.py"


rule orders:
    input:
        forces=f"results/forces/{plan.figure_case}_NG.nc",
        chaos=f"results/chaos/{plan.figure_case}_NG.nc",
    output:
        "results/studies/orders.nc",
    log:
        "results/logs/studies/orders.log",
    params:
        settings=jobs.orders(plan),
        code=code("orders.py"),
    message:
        "Convergence of the chaos model in the order of its polynomials (App. B)."
    script:
        "../scripts/orders.py"


rule mesh:
    input:
        forces=f"results/forces/{plan.figure_case}_NG.nc",
    output:
        "results/studies/mesh.nc",
    log:
        "results/logs/studies/mesh.log",
    localrule: True
    params:
        settings=jobs.mesh(plan),
        code=code("mesh.py"),
    message:
        "Convergence of the crack length in the mesh of the beam (App. C)."
    script:
        "../scripts/mesh.py"


rule correlation:
    input:
        spectra=expand("results/spectrum/{surface}.nc", surface=plan.surfaces),
    output:
        "results/studies/correlation.nc",
    log:
        "results/logs/studies/correlation.log",
    localrule: True
    params:
        settings={"surfaces": plan.surfaces},
        code=code("correlation.py"),
    message:
        "Autocorrelation of the surfaces (App. C)."
    script:
        "../scripts/correlation.py"


rule variant_summits:
    input:
        unpack(lambda w: paths.measured_surfaces(w.pair)),
        identifications=lambda w: expand(
            "results/identification/{surface}.nc", surface=plan.variant_summits(w.pair, w.variant)["identified"]
        ),
    output:
        "results/studies/variants/summits/{pair}_{variant}.nc",
    log:
        "results/logs/studies/variants/summits/{pair}_{variant}.log",
    resources:
        runtime=30,
        mem_mb=MEMORY,
    params:
        settings=lambda w: plan.variant_summits(w.pair, w.variant),
        code=code("variant_summits.py"),
    message:
        "Summits of pair {wildcards.pair} under variant {wildcards.variant}."
    script:
        "../scripts/variant_summits.py"


rule variant_contact:
    input:
        summits=lambda w: paths.summits_of_variant(w.pair, w.variant),
    output:
        "results/studies/variants/contact/{pair}_{variant}.nc",
    log:
        "results/logs/studies/variants/contact/{pair}_{variant}.log",
    localrule: True
    params:
        settings=lambda w: plan.variant_contact(w.pair, w.variant),
        code=code("variant_contact.py"),
    message:
        "Contact of pair {wildcards.pair} under variant {wildcards.variant}."
    script:
        "../scripts/variant_contact.py"


rule variant:
    input:
        contact=lambda w: paths.contact_of_variant(w.case, w.variant),
    output:
        "results/studies/variants/{case}_{variant}.nc",
    log:
        "results/logs/studies/variants/{case}_{variant}.log",
    localrule: True
    params:
        settings=lambda w: jobs.variant(plan, w.case, w.variant),
        code=code("variant.py"),
    message:
        "Crack lengths of {wildcards.case} under variant {wildcards.variant}."
    script:
        "../scripts/variant.py"


rule resampling:
    input:
        forces="results/forces/{case}_NG.nc",
    output:
        "results/studies/resampling/{case}.nc",
    log:
        "results/logs/studies/resampling/{case}.log",
    params:
        settings=lambda w: jobs.resampling(plan, w.case),
        code=code("resampling.py"),
    message:
        "Release the beams of {wildcards.case} on force laws resampled from the contact samples (App. B)."
    script:
        "../scripts/resampling.py"
