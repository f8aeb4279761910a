"""Names of the files on which the results of devices depend."""

CONTACT = memory.of_contact(measured.view(config, preliminary))  # of the jobs that hold all samples they draw [MB]
CHARTS = [f"results/devices/chart/{case}.nc" for name in designs.charted for case in designs.chart_cases(name)]


def strips_of(wildcards):
    """Contact of the strips along a device: that of its pair in the main line if the strips are equal."""
    device = cases.pair_of(wildcards.case)
    if designs.has_strips_of_pair(device):
        return f"results/contact/{config['devices'][device]['pair']}_NG.nc"
    return f"results/devices/contact/{designs.strips(device).name}.nc"


def tips_of(wildcards):
    """Contact of the strips that hold the tips of a cantilever; nothing for a bridge."""
    device = cases.pair_of(wildcards.case)
    if config["devices"][device]["kind"] == "bridge":
        return []
    return f"results/devices/contact/tips/{designs.tips(device).name}.nc"


def ground_of(device):
    """Contact of the patch on which a device sticks: that of its pair in the main line if both are equal."""
    if designs.has_strips_of_pair(device):
        return f"results/contact/{config['devices'][device]['pair']}_NG.nc"
    return f"results/devices/contact/{designs.ground(device).name}.nc"


def surfaces_of_device(wildcards):
    """Datasets of the uncertain surfaces of a device, by stage."""
    names = dict.fromkeys(surface for surface, _ in designs.quantities(cases.pair_of(wildcards.case)))
    return {stage: expand("results/{stage}/{name}.nc", stage=stage, name=names) for stage in ("heights", "spectrum")}


def shifted_of(side):
    """Contacts of the patch of a device with less or more of every uncertain quantity of its surfaces."""

    def paths(wildcards):
        device = cases.pair_of(wildcards.case)
        pair, name = config["devices"][device]["pair"], designs.ground(device).name
        begin = f"results/devices/contact/slopes/{name}"
        if designs.has_strips_of_pair(device):
            begin = f"results/studies/slopes/contact/{pair}"
        return [f"{begin}_{surface}_{quantity}_{side}.nc" for surface, quantity in designs.quantities(device)]

    return paths


def modulus_of(wildcards):
    """Contacts of the patch of a device with less and with more of Young's modulus, if that is uncertain."""
    device = cases.pair_of(wildcards.case)
    if not config["devices"][device]["uncertainty"].get("young_modulus_GPa"):
        return []
    return expand(
        "results/devices/contact/modulus/{name}_{side}.nc", name=designs.ground(device).name, side=("less", "more")
    )


def choices_of(wildcards):
    """Contacts of the patch of a device under other choices of the model."""
    device = cases.pair_of(wildcards.case)
    chosen = plan.choices(config["devices"][device]["pair"])
    return [f"results/devices/contact/choices/{designs.ground(device).name}_{variant}.nc" for variant in chosen]


def summits_of_choice(wildcards):
    """Summits of the patch of a device under a choice of the model."""
    found = plan.summits_under(wildcards.pair, wildcards.variant)
    return f"results/devices/contact/summits/{wildcards.pair}_{wildcards.length}x{wildcards.width}_{found}.nc"


def results_of_device(wildcards):
    """Everything that the page of a device shows."""
    name = wildcards.device
    section = config["devices"][name]
    of_cases = [cases.case_id(name, humidity) for humidity in section["humidities"]]
    found = {"budgets": of_cases if name in designs.budgeted else [], "charts": [], "safe_lengths": [], "stoppers": []}
    if section["kind"] == "stopper":
        found["stoppers"] = [name]
    else:
        found["safe_lengths"] = of_cases
        found["charts"] = designs.chart_cases(name) if name in designs.charted else []
    folders = {"budgets": "budget", "charts": "chart"}
    paths = {
        kind: expand("results/devices/{folder}/{name}.nc", folder=folders.get(kind, kind), name=names)
        for kind, names in found.items()
    }
    return paths | {"plasticity": expand("results/studies/plasticity/{pair}.nc", pair=designs.pressed(name))}
