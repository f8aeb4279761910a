"""Input functions of the rules for devices."""

CONTACT = memory.of_contact(measured.view(config, preliminary))  # of the jobs that hold all samples they draw [MB]
CHARTS = [f"results/devices/chart/{case}.nc" for name in designs.charted for case in designs.chart_cases(name)]


def of_device(found):
    """Input function of a rule for the cases of a device, from a function of the name of the device."""
    return lambda wildcards: found(cases.pair_of(wildcards.case))


ground_of = paths.ground
strips_of, tips_of = of_device(paths.ground), of_device(paths.tips)
surfaces_of_device = of_device(paths.uncertain_surfaces)
modulus_of, choices_of = of_device(paths.shifted_modulus), of_device(paths.choices)


def shifted_of(side):
    """Input function for the contacts of a device with ``less`` or ``more`` of every uncertain quantity."""
    return of_device(lambda device: paths.shifted_ground(device, side))


def summits_of_choice(wildcards):
    """Summits of the patch of a device under a choice of the model."""
    return paths.summits_of_choice(wildcards.pair, f"{wildcards.length}x{wildcards.width}", wildcards.variant)


def results_of_device(wildcards):
    """Everything that the page of a device shows."""
    return paths.results(wildcards.device)
