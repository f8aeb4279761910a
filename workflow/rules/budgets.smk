"""Stoppers, budgets of devices, and a page for each device; nothing for a configuration without devices."""


use rule slope_contact as device_slope_contact with:
    output:
        expand(
            "results/devices/contact/slopes/{{pair}}_{{length}}x{{width}}_{{surface}}_{{quantity}}_{side}.nc",
            side=SHIFTED,
        ),
    log:
        "results/logs/devices/contact/slopes/{pair}_{length}x{width}_{surface}_{quantity}.log",
    resources:
        runtime=120,
        mem_mb=memory.of_contact(VIEW, contacts=len(SHIFTED)),
    params:
        settings=lambda w: jobs.device_slope_contact(plan, w.pair, w.length, w.width),
        code=code("slope_contact.py"),
    message:
        "Contact of pair {wildcards.pair}, {wildcards.length} x {wildcards.width} nm, with less and more "
        "{wildcards.quantity} of {wildcards.surface}."


use rule device_contact as solid_contact with:
    output:
        "results/devices/contact/{solid_property}/{pair}_{length}x{width}_{side}.nc",
    log:
        "results/logs/devices/contact/{solid_property}/{pair}_{length}x{width}_{side}.log",
    params:
        settings=lambda w: jobs.solid_contact(plan, w.pair, w.length, w.width, w.solid_property, w.side),
        code=code("device_contact.py"),
    message:
        "Contact of pair {wildcards.pair}, {wildcards.length} x {wildcards.width} nm, with {wildcards.side} "
        "{wildcards.solid_property} of the solids."


use rule device_slope_contact as tip_slope_contact with:
    output:
        expand(
            "results/devices/contact/tips/slopes/{{pair}}_{{length}}x{{width}}_{{surface}}_{{quantity}}_{side}.nc",
            side=SHIFTED,
        ),
    log:
        "results/logs/devices/contact/tips/slopes/{pair}_{length}x{width}_{surface}_{quantity}.log",
    resources:
        runtime=120,
        mem_mb=memory.of_contact(VIEW, contacts=len(SHIFTED)),
    params:
        settings=lambda w: jobs.tip_contact(plan, w.pair, w.length, w.width),
        code=code("slope_contact.py"),
    message:
        "Contact of pair {wildcards.pair} at the tips of beams, with less and more {wildcards.quantity} of "
        "{wildcards.surface}."


use rule solid_contact as tip_solid_contact with:
    output:
        "results/devices/contact/tips/{solid_property}/{pair}_{length}x{width}_{side}.nc",
    log:
        "results/logs/devices/contact/tips/{solid_property}/{pair}_{length}x{width}_{side}.log",
    params:
        settings=lambda w: jobs.tip_solid_contact(plan, w.pair, w.length, w.width, w.solid_property, w.side),
        code=code("device_contact.py"),
    message:
        "Contact of pair {wildcards.pair} at the tips of beams, with {wildcards.side} {wildcards.solid_property} of "
        "the solids."


use rule device_contact as tip_choice_contact with:
    output:
        "results/devices/contact/tips/choices/{pair}_{length}x{width}_{variant}.nc",
    log:
        "results/logs/devices/contact/tips/choices/{pair}_{length}x{width}_{variant}.log",
    params:
        settings=lambda w: jobs.tip_choice_contact(plan, w.pair, w.length, w.width, w.variant),
        code=code("device_contact.py"),
    message:
        "Contact of pair {wildcards.pair} at the tips of beams, under variant {wildcards.variant}."


use rule variant_summits as device_choice_summits with:
    output:
        "results/devices/contact/summits/{pair}_{length}x{width}_{variant}.nc",
    log:
        "results/logs/devices/contact/summits/{pair}_{length}x{width}_{variant}.log",
    resources:
        runtime=120,
        mem_mb=MEMORY,
    params:
        settings=lambda w: jobs.device_choice_summits(plan, w.pair, w.length, w.width, w.variant),
        code=code("variant_summits.py"),
    message:
        "Summits of pair {wildcards.pair}, {wildcards.length} x {wildcards.width} nm, under variant {wildcards.variant}."


use rule variant_contact as device_choice_contact with:
    input:
        summits=summits_of_choice,
    output:
        "results/devices/contact/choices/{pair}_{length}x{width}_{variant}.nc",
    log:
        "results/logs/devices/contact/choices/{pair}_{length}x{width}_{variant}.log",
    message:
        "Contact of pair {wildcards.pair}, {wildcards.length} x {wildcards.width} nm, under variant {wildcards.variant}."


rule stoppers:
    input:
        contact=lambda w: ground_of(w.device),
    output:
        "results/devices/stoppers/{device}.nc",
    log:
        "results/logs/devices/stoppers/{device}.log",
    localrule: True
    resources:
        mem_mb=SAMPLES,
    params:
        settings=lambda w: jobs.stoppers(plan, w.device),
        code=code("stoppers.py"),
    message:
        "Pull-off force of stopper {wildcards.device}."
    script:
        "../scripts/stoppers.py"


rule budget:
    input:
        unpack(surfaces_of_device),
        unpack(contacts_of_budget),
    output:
        "results/devices/budget/{case}.nc",
    log:
        "results/logs/devices/budget/{case}.log",
    resources:
        runtime=120,
        mem_mb=lambda w, input: memory.of_budget(VIEW, len(input)),
    params:
        settings=lambda w: jobs.budget(plan, w.case),
        code=code("budget.py"),
    message:
        "Budget of {wildcards.case}."
    script:
        "../scripts/budget.py"


use rule budget as tip_budget with:
    input:
        unpack(surfaces_of_device),
        unpack(contacts_of_tip_budget),
    output:
        "results/devices/budget/{case}_tip.nc",
    log:
        "results/logs/devices/budget/{case}_tip.log",
    params:
        settings=lambda w: jobs.tip_budget(plan, w.case),
        code=code("budget.py"),
    message:
        "Budget of the tips of {wildcards.case}."


rule table_stoppers:
    input:
        stoppers=expand("results/devices/stoppers/{device}.nc", device=designs.stoppers),
        plasticity=expand("results/studies/plasticity/{pair}.nc", pair=designs.pressed(*designs.stoppers)),
    output:
        **table_files("stoppers", "P(stuck) of stoppers"),
    log:
        "results/logs/tables/stoppers.log",
    localrule: True
    params:
        settings=jobs.beyond_stoppers(plan),
        code=code("table_stoppers.py"),
    message:
        "P(stuck) of all stoppers."
    script:
        "../scripts/table_stoppers.py"


rule figure_stoppers:
    input:
        stoppers=expand("results/devices/stoppers/{device}.nc", device=designs.stoppers),
        plasticity=expand("results/studies/plasticity/{pair}.nc", pair=designs.pressed(*designs.stoppers)),
        style=STYLE,
    output:
        **figure_files("stoppers", ON_DEVICES, "pull-off force of stoppers"),
    log:
        "results/logs/figures/stoppers.log",
    localrule: True
    params:
        settings=jobs.beyond_stoppers(plan),
        code=code("figure_stoppers.py"),
    message:
        "Pull-off force of all stoppers."
    script:
        "../scripts/figure_stoppers.py"


rule table_budget:
    input:
        budgets=expand("results/devices/budget/{name}.nc", name=designs.budgets()),
    output:
        **table_files("budget", "uncertainty of devices, and what to measure better"),
    log:
        "results/logs/tables/budget.log",
    localrule: True
    params:
        settings={"budgets": designs.budgets()},
        code=code("table_budget.py"),
    message:
        "Uncertainty of all devices."
    script:
        "../scripts/table_budget.py"


rule figure_budget:
    input:
        budgets=lambda w: expand("results/devices/budget/{name}.nc", name=designs.budgets(w.device)),
        style=STYLE,
    output:
        **figure_files("budget_{device}", ON_DEVICES, "uncertainty of {device}", caption="budget"),
    log:
        "results/logs/figures/budget_{device}.log",
    localrule: True
    params:
        settings=lambda w: {"budgets": designs.budgets(w.device)},
        code=code("figure_budget.py"),
    message:
        "Uncertainty of device {wildcards.device}."
    script:
        "../scripts/figure_budget.py"


rule device_page:
    input:
        unpack(results_of_device),
        style=STYLE,
    output:
        report("results/devices/{device}.html", category=ON_DEVICES, labels={"shows": "{device}: what to build"}),
    log:
        "results/logs/devices/{device}.log",
    localrule: True
    params:
        settings=lambda w: jobs.page(plan, w.device),
        code=code("device_page.py"),
    message:
        "Page of device {wildcards.device}."
    script:
        "../scripts/device_page.py"


rule devices:
    input:
        [rules.table_safe_lengths.output, rules.figure_risk.output] if designs.cases else [],
        [rules.table_chart.output, rules.figure_chart.output] if designs.charted else [],
        [rules.table_stoppers.output, rules.figure_stoppers.output] if designs.stoppers else [],
        rules.table_budget.output if designs.budgeted else [],
        expand("results/figures/budget_{device}.{kind}", device=designs.budgeted, kind=("pdf", "png")),
        expand("results/devices/{device}.html", device=designs.devices),
        rules.device_limits.output if designs.devices else [],
    localrule: True
    message:
        "Tables, figures and pages of the devices."
