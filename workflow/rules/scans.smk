"""Measured surfaces: from the files of a microscope to the height density and spectrum of the surface."""


rule scan:
    input:
        planned,
        # The content of the file is among the settings; its time does not matter.
        file=lambda w: ancient(paths.scan(w.surface, w.number)),
    output:
        "results/scan/{surface}_{number}.nc",
    log:
        "results/logs/scan/{surface}_{number}.log",
    localrule: True
    params:
        settings=lambda w: jobs.scan(plan, w.surface, w.number),
        code=code("scan.py") | {"SurfaceTopography": provenance.version_of("SurfaceTopography")},
    message:
        "Read scan {wildcards.number} of surface {wildcards.surface}."
    script:
        "../scripts/scan.py"


rule estimate:
    input:
        lambda w: expand("results/scan/{surface}_{number}.nc", surface=w.surface, number=plan.scan_files(w.surface)),
    output:
        "results/estimate/{surface}.nc",
    log:
        "results/logs/estimate/{surface}.log",
    resources:
        mem_mb=lambda w: memory.of_estimate(preliminary[w.surface], len(plan.scan_files(w.surface))),
    params:
        settings=lambda w: jobs.estimate(plan, w.surface),
        code=code("estimate.py"),
    message:
        "Estimate surface {wildcards.surface} from its scans."
    script:
        "../scripts/estimate.py"


rule heights_of_scans:
    input:
        estimate="results/estimate/{surface}.nc",
    output:
        "results/heights/{surface}.nc",
    log:
        "results/logs/heights/{surface}.log",
    wildcard_constraints:
        surface=one_of(plan.scanned),
    localrule: True
    params:
        settings=lambda w: jobs.heights_of_scans(plan, w.surface),
        code=code("heights_of_scans.py"),
    message:
        "Height density of measured surface {wildcards.surface} (Sec. II-A)."
    script:
        "../scripts/heights_of_scans.py"


rule spectrum_of_scans:
    input:
        estimate="results/estimate/{surface}.nc",
        heights="results/heights/{surface}.nc",
    output:
        "results/spectrum/{surface}.nc",
    log:
        "results/logs/spectrum/{surface}.log",
    wildcard_constraints:
        surface=one_of(plan.scanned),
    localrule: True
    params:
        settings=lambda w: jobs.spectrum_of_scans(plan, w.surface),
        code=code("spectrum_of_scans.py"),
    message:
        "Spectrum of measured surface {wildcards.surface} and of the underlying Gaussian field (Sec. II-B)."
    script:
        "../scripts/spectrum_of_scans.py"
