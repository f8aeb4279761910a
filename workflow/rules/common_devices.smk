"""Input functions of the rules for devices."""

CONTACT = memory.of_contact(VIEW)  # of the jobs that hold all samples they draw [MB]
CHARTS = [f"results/devices/chart/{case}.nc" for name in designs.charted for case in designs.chart_cases(name)]


def of_device(found):
    """Input function of a rule for the cases of a device, from a function of the name of the device."""
    return lambda wildcards: found(cases.pair_of(wildcards.case))


ground_of = paths.ground
strips_of, tips_of = of_device(paths.ground), of_device(paths.tips)
surfaces_of_device = of_device(paths.uncertain_surfaces)
contacts_of_budget, contacts_of_tip_budget = of_device(paths.contacts_of_budget), of_device(
    paths.contacts_of_tip_budget
)


def summits_of_choice(wildcards):
    """Summits of the patch of a device under a variant of the model."""
    return paths.summits_of_choice(wildcards.pair, f"{wildcards.length}x{wildcards.width}", wildcards.variant)


def results_of_device(wildcards):
    """Everything that the page of a device shows."""
    return paths.results(wildcards.device)
