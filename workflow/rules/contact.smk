"""Sec. III-A: adhesive contact of surface pairs, independent of humidity."""


rule contact_chunk:
    input:
        unpack(surfaces_of_pair),
    output:
        temp("results/contact/{pair}_{model}/{chunk}-of-{number}.nc"),
    log:
        "results/logs/contact/{pair}_{model}/{chunk}-of-{number}.log",
    resources:
        runtime=30,
        mem_mb=memory.of_drawn(VIEW, config["contact"]["samples"] / config["contact"]["chunks"]),
    params:
        settings=lambda w: jobs.contact(plan, w.pair),
        code=code("contact_chunk.py"),
    message:
        "Contact of {wildcards.model} surfaces of pair {wildcards.pair}, chunk {wildcards.chunk} of {wildcards.number}."
    script:
        "../scripts/contact_chunk.py"


rule contact:
    input:
        expand(
            "results/contact/{{pair}}_{{model}}/{chunk}-of-{number}.nc",
            chunk=range(config["contact"]["chunks"]),
            number=config["contact"]["chunks"],
        ),
    output:
        "results/contact/{pair}_{model}.nc",
    log:
        "results/logs/contact/{pair}_{model}.log",
    localrule: True
    resources:
        mem_mb=SAMPLES,
    params:
        settings=lambda w: jobs.contact(plan, w.pair),
        code=code("contact.py") | code("contact_chunk.py"),
    message:
        "Join the contact of {wildcards.model} surfaces of pair {wildcards.pair} (Sec. III-A)."
    script:
        "../scripts/contact.py"
