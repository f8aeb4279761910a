"""From two rough surfaces to crack lengths: the rules of the paper, each after the rules that it reads.

surface: a rough surface, such as B2 · pair: two surfaces, such as b · case: a pair at one relative humidity, such as
b_rh067 · model: the model of the surfaces, or of the beams · chunk, number: a part of the samples, and the number of
parts.

Written by docs/rules.py from the declarations of the stages: change these, then run make numbers.
"""


rule heights:
    input:
        unpack(inputs_of("heights")),
    output:
        dataset="results/heights/{surface}.nc",
    log:
        "results/logs/heights/{surface}.log",
    wildcard_constraints:
        **DECLARED["heights"]["constraints"],
    localrule: True
    resources:
        **resources_of("heights"),
    params:
        **params_of("heights"),
    message:
        "Maximum-entropy height density of {wildcards.surface} (Sec. II-A)."
    script:
        "../scripts/stage.py"


rule identification:
    input:
        # heights: results/heights/{surface}.nc
        unpack(inputs_of("identification")),
    output:
        dataset="results/identification/{surface}.nc",
    log:
        "results/logs/identification/{surface}.log",
    resources:
        **resources_of("identification"),
    params:
        **params_of("identification"),
    message:
        "Identify the spectrum of {wildcards.surface} from its summits (Sec. II-C)."
    script:
        "../scripts/stage.py"


rule spectrum:
    input:
        # heights: results/heights/{surface}.nc
        # identification: results/identification/{surface}.nc
        unpack(inputs_of("spectrum")),
    output:
        dataset="results/spectrum/{surface}.nc",
    log:
        "results/logs/spectrum/{surface}.log",
    wildcard_constraints:
        **DECLARED["spectrum"]["constraints"],
    localrule: True
    resources:
        **resources_of("spectrum"),
    params:
        **params_of("spectrum"),
    message:
        "Spectrum of {wildcards.surface} and of the underlying Gaussian field (Sec. II-B)."
    script:
        "../scripts/stage.py"


rule contact_chunk:
    input:
        # heights: results/heights/{surface}.nc, …
        # spectrum: results/spectrum/{surface}.nc, …
        unpack(inputs_of("contact_chunk")),
    output:
        dataset=temp("results/contact/{pair}_{model}/{chunk}-of-{number}.nc"),
    log:
        "results/logs/contact/{pair}_{model}/{chunk}-of-{number}.log",
    priority: 1
    resources:
        **resources_of("contact_chunk"),
    params:
        **params_of("contact_chunk"),
    message:
        "Contact of {wildcards.model} surfaces of pair {wildcards.pair}, chunk {wildcards.chunk} of {wildcards.number} (Sec. III-A)."
    script:
        "../scripts/stage.py"


rule contact:
    input:
        # chunks: results/contact/{pair}_{model}/{chunk}-of-{number}.nc, …
        unpack(inputs_of("contact")),
    output:
        dataset="results/contact/{pair}_{model}.nc",
    log:
        "results/logs/contact/{pair}_{model}.log",
    priority: 1
    localrule: True
    resources:
        **resources_of("contact"),
    params:
        **params_of("contact"),
    message:
        "Join the contact of {wildcards.model} surfaces of pair {wildcards.pair} (Sec. III-A)."
    script:
        "../scripts/stage.py"


rule forces:
    input:
        # contact: results/contact/{pair}_{model}.nc
        unpack(inputs_of("forces")),
    output:
        dataset="results/forces/{case}_{model}.nc",
    log:
        "results/logs/forces/{case}_{model}.log",
    localrule: True
    resources:
        **resources_of("forces"),
    params:
        **params_of("forces"),
    message:
        "Force curves of {wildcards.case}, {wildcards.model} (Sec. III-B1)."
    script:
        "../scripts/stage.py"


rule chaos:
    input:
        # forces: results/forces/{case}_{model}.nc
        unpack(inputs_of("chaos")),
    output:
        dataset="results/chaos/{case}_{model}.nc",
    log:
        "results/logs/chaos/{case}_{model}.log",
    localrule: True
    resources:
        **resources_of("chaos"),
    params:
        **params_of("chaos"),
    message:
        "Chaos model of the force law of {wildcards.case}, {wildcards.model} (App. B)."
    script:
        "../scripts/stage.py"


rule beams:
    input:
        # chaos: results/chaos/{case}_{model}.nc
        unpack(inputs_of("beams")),
    output:
        dataset="results/beams/{case}_{model}.nc",
    log:
        "results/logs/beams/{case}_{model}.log",
    resources:
        **resources_of("beams"),
    params:
        **params_of("beams"),
    message:
        "Release the beams of {wildcards.case}, {wildcards.model} (Sec. III-C)."
    script:
        "../scripts/stage.py"
