"""Devices: cracks of long beams, safe lengths, charts and warnings; nothing for a configuration without devices."""


rule device_contact:
    input:
        unpack(surfaces_of_pair),
    output:
        "results/devices/contact/{pair}_{length}x{width}.nc",
    log:
        "results/logs/devices/contact/{pair}_{length}x{width}.log",
    resources:
        runtime=120,
        mem_mb=CONTACT,
    params:
        settings=lambda w: jobs.device_contact(plan, w.pair, w.length, w.width),
        code=code("device_contact.py"),
    message:
        "Contact of pair {wildcards.pair} on patches of {wildcards.length} x {wildcards.width} nm."
    script:
        "../scripts/device_contact.py"


use rule device_contact as tip_contact with:
    output:
        "results/devices/contact/tips/{pair}_{length}x{width}.nc",
    log:
        "results/logs/devices/contact/tips/{pair}_{length}x{width}.log",
    params:
        settings=lambda w: jobs.tip_contact(plan, w.pair, w.length, w.width),
        code=code("device_contact.py"),
    message:
        "Contact of pair {wildcards.pair} at the tips of beams, strips of {wildcards.length} x {wildcards.width} nm."


rule cracks:
    input:
        contact=strips_of,
    output:
        "results/devices/cracks/{case}.nc",
    log:
        "results/logs/devices/cracks/{case}.log",
    resources:
        runtime=120,
        mem_mb=SAMPLES,
    params:
        settings=lambda w: jobs.cracks(plan, w.case),
        code=code("cracks.py"),
    message:
        "Release long beams of {wildcards.case}."
    script:
        "../scripts/cracks.py"


rule safe_lengths:
    input:
        cracks="results/devices/cracks/{case}.nc",
        tips=tips_of,
    output:
        "results/devices/safe_lengths/{case}.nc",
    log:
        "results/logs/devices/safe_lengths/{case}.log",
    localrule: True
    resources:
        mem_mb=SAMPLES,
    params:
        settings=lambda w: jobs.safe_lengths(plan, w.case),
        code=code("safe_lengths.py"),
    message:
        "Safe lengths of {wildcards.case}."
    script:
        "../scripts/safe_lengths.py"


rule chart:
    input:
        contact=strips_of,
        tips=tips_of,
    output:
        "results/devices/chart/{case}.nc",
    log:
        "results/logs/devices/chart/{case}.log",
    resources:
        runtime=120,
        mem_mb=SAMPLES,
    params:
        settings=lambda w: jobs.chart(plan, w.case),
        code=code("chart.py"),
    message:
        "Chart of {wildcards.case}."
    script:
        "../scripts/chart.py"


rule table_safe_lengths:
    input:
        lengths=expand("results/devices/safe_lengths/{case}.nc", case=designs.cases),
        plasticity=expand("results/studies/plasticity/{pair}.nc", pair=designs.pressed_pairs),
    output:
        **table_files("safe_lengths", "lengths of beams that come free"),
    log:
        "results/logs/tables/safe_lengths.log",
    localrule: True
    params:
        settings=jobs.beyond_the_model(plan),
        code=code("table_safe_lengths.py"),
    message:
        "Safe lengths of all beams."
    script:
        "../scripts/table_safe_lengths.py"


rule figure_risk:
    input:
        lengths=expand("results/devices/safe_lengths/{case}.nc", case=designs.cases),
        plasticity=expand("results/studies/plasticity/{pair}.nc", pair=designs.pressed_pairs),
        style=STYLE,
    output:
        **figure_files("risk", ON_DEVICES, "share of stuck beams over their length"),
    log:
        "results/logs/figures/risk.log",
    localrule: True
    params:
        settings=jobs.beyond_the_model(plan),
        code=code("figure_risk.py"),
    message:
        "Share of stuck beams over their length."
    script:
        "../scripts/figure_risk.py"


rule table_chart:
    input:
        charts=CHARTS,
        plasticity=expand("results/studies/plasticity/{pair}.nc", pair=designs.pressed(*designs.charted)),
    output:
        **table_files("chart", "safe length over the relative humidity"),
    log:
        "results/logs/tables/chart.log",
    localrule: True
    params:
        settings=jobs.charts(plan),
        code=code("table_chart.py"),
    message:
        "Safe lengths along the axes of all charts."
    script:
        "../scripts/table_chart.py"


rule figure_chart:
    input:
        charts=CHARTS,
        plasticity=expand("results/studies/plasticity/{pair}.nc", pair=designs.pressed(*designs.charted)),
        style=STYLE,
    output:
        **figure_files("chart", ON_DEVICES, "safe length over the relative humidity"),
    log:
        "results/logs/figures/chart.log",
    localrule: True
    params:
        settings=jobs.charts(plan),
        code=code("figure_chart.py"),
    message:
        "Safe length over the relative humidity."
    script:
        "../scripts/figure_chart.py"


rule device_limits:
    input:
        lengths=expand("results/devices/safe_lengths/{case}.nc", case=designs.cases),
        charts=CHARTS,
        plasticity=expand("results/studies/plasticity/{pair}.nc", pair=designs.pressed(*designs.devices)),
    output:
        "results/devices/warnings.md",
    log:
        "results/logs/devices/warnings.log",
    localrule: True
    params:
        settings=jobs.device_limits(plan),
        code=code("device_limits.py"),
    message:
        "Where the results of devices are beyond the model."
    script:
        "../scripts/device_limits.py"


rule model_limits:
    input:
        beams=[f"results/beams/{case}_{model}.nc" for case, model in plan.outcomes],
        plasticity=expand("results/studies/plasticity/{pair}.nc", pair=plan.pressed_pairs),
    output:
        "results/warnings.md",
    log:
        "results/logs/model_limits.log",
    localrule: True
    params:
        settings=jobs.model_limits(plan),
        code=code("model_limits.py"),
    message:
        "Where the results of pairs are beyond the model."
    script:
        "../scripts/model_limits.py"
