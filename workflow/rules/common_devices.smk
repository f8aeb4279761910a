"""Names of the files on which the results of devices depend."""


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
    """Datasets of the uncertain surfaces of a device, by stage; estimates of those described by scans."""
    device = cases.pair_of(wildcards.case)
    names = dict.fromkeys(surface for surface, _ in designs.quantities(device))
    scanned = plan.scanned_sides(config["devices"][device]["pair"])
    return datasets_of(names) | {"estimates": [f"results/estimate/{name}.nc" for name in scanned]}


def contacts_of_budget(wildcards):
    """Contact of the patch of a device, with less and more of every uncertain input, and under other choices."""
    device = cases.pair_of(wildcards.case)
    pair, folder = config["devices"][device]["pair"], "results/devices/contact"
    shared, name = designs.has_strips_of_pair(device), designs.ground(device).name
    slopes = f"results/studies/slopes/contact/{pair}" if shared else f"{folder}/slopes/{name}"
    return {"contact": ground_of(device)} | changed_contacts(device, slopes, folder, name, plan.choices(pair))


def contacts_of_tip_budget(wildcards):
    """As `contacts_of_budget`, of the tips of a cantilever."""
    device, folder = cases.pair_of(wildcards.case), "results/devices/contact/tips"
    tips = designs.tips(device)
    found = changed_contacts(
        device, f"{folder}/slopes/{tips.name}", folder, tips.name, plan.choices_of_solids(tips.pair)
    )
    return {"contact": f"{folder}/{tips.name}.nc"} | found


def changed_contacts(device, slopes, folder, name, choices):
    """Contacts of a patch with less and more of every uncertain input of a device, and under choices of the model."""
    quantities = [f"{slopes}_{surface}_{quantity}" for surface, quantity in designs.quantities(device)]
    stated = config["devices"][device].get("uncertainty", {}).get("young_modulus_GPa")
    sides = ("less", "more")
    return {side: [f"{start}_{side}.nc" for start in quantities] for side in sides} | {
        "modulus": [f"{folder}/modulus/{name}_{side}.nc" for side in sides] if stated else [],
        "choices": [f"{folder}/choices/{name}_{variant}.nc" for variant in choices],
    }


def summits_of_choice(wildcards):
    """Summits of the patch of a device under a choice of the model."""
    found = plan.summits_under(wildcards.pair, wildcards.variant)
    return f"results/devices/contact/summits/{wildcards.pair}_{wildcards.length}x{wildcards.width}_{found}.nc"


def results_of_device(wildcards):
    """Everything that the page of a device shows."""
    name = wildcards.device
    section = config["devices"][name]
    budgets = designs.budgets(name) if name in designs.budgeted else []
    found = {"budgets": budgets, "charts": [], "safe_lengths": [], "stoppers": []}
    if section["kind"] == "stopper":
        found["stoppers"] = [name]
    else:
        found["safe_lengths"] = [cases.case_id(name, humidity) for humidity in section["humidities"]]
        found["charts"] = designs.chart_cases(name) if name in designs.charted else []
    folders = {"budgets": "budget", "charts": "chart"}
    paths = {
        kind: expand("results/devices/{folder}/{name}.nc", folder=folders.get(kind, kind), name=names)
        for kind, names in found.items()
    }
    return paths | {"plasticity": expand("results/studies/plasticity/{pair}.nc", pair=designs.pressed(name))}
