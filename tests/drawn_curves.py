"""Devices over a process, a roughness and a voltage, by formulas in place of simulations."""

import numpy as np

from stiction.analysis.process_law import fit, grid
from stiction.contact.environment import Water
from stiction.stages.axes import law, recommended, requirement
from stiction.stages.axes import margins as of_process
from stiction.stages.axes import roughness as of_roughness
from stiction.stages.devices import stoppers

SETTINGS, VARIABLE, SHARE = np.array([30.0, 60.0, 90.0, 120.0]), "etch_time_s", 0.01
#: Required force [N] and length [m].
REQUIRED = {False: 28e-6, True: 300e-6}
DEVICE = {"pair": "b", "humidities": [0.8, 0.6], "requirement": {"share": SHARE}}
STOPPER = DEVICE | {"kind": "stopper", "contact_um": [3, 3], "restoring_force_uN": 28}
OXIDE = {"voltage_V": 5, "offset_V": 0.5, "dielectric": {"thickness_nm": 100, "permittivity": 4}}
BEAM = DEVICE | {"kind": "bridge", "thickness_um": 2, "gap_um": 2, "width_um": 30, "residual_stress_MPa": 20}


def law_of(settings=SETTINGS, variable=VARIABLE, surface="B2"):
    """Law of the rms of a surface, with errors of 2 %."""
    values, errors = np.log(3e-9 + 1e-11 * settings)[:, None], np.full((len(settings), 1, 1), 0.02**2)
    settings_of_law = law.Settings(variable, surface, tuple(settings), ("rms",))
    return law.layout(fit(settings, values, errors), values, errors, settings_of_law)


def _point(margin, refused, is_beam, **coords):
    """Point of a curve with these margins at two humidities."""
    common = {"seed": 1, "water": Water(300.0), "humidities": (0.8, 0.6), "share": SHARE}
    settings = requirement.RequiredStopper(**common, contact=(3e-6, 3e-6), restoring_force=REQUIRED[False])
    rows = []
    for logarithm in margin:
        size, risky = (
            REQUIRED[is_beam] * np.exp(logarithm if is_beam else -logarithm),
            np.nan if refused else 1 / (1 + np.exp(20 * logarithm)),
        )
        safe = size * np.exp(-0.08 if is_beam else 0.08)
        rows.append([requirement.Response(safe, size, 0.05 * size, np.nan, (risky, 0.8 * risky, 1.2 * risky))])
    flags = {"flagged": ("humidity", [""] * 2), "refused": ("humidity", [refused] * 2)}
    point = requirement.layout(rows, 400, settings).assign(flags)
    required = point.required.copy(data=REQUIRED[is_beam]).assign_attrs(units="m" if is_beam else "N")
    return point.assign(required=required, **coords)


def _margin(value, tilt=0.0):
    """Margins at both humidities at a setting, the largest one inside."""
    return np.array([0.2, 0.35]) - ((value - 80 - tilt) / 60) ** 2


def etched(is_beam=False, unknown=()):
    """Datasets of stages process_curve and process_settings; points at some values could not be computed."""
    slopes = {"slopes": (("humidity", "shape", "law_quantity"), np.full((2, 1, 1), 0.5))}
    points = [
        _point(
            _margin(value) + (np.nan if value in unknown else 0), "smooth" * (value in unknown), is_beam, value=value
        )
        for value in map(float, grid(SETTINGS))
    ]
    etch_law = law_of()
    curve = of_process.compute([point.assign(slopes) for point in points], [etch_law], [VARIABLE], ["etch"], ["B2"])
    return curve, recommended.compute({"D": curve}, {"etch": etch_law}, VARIABLE, 1)


def mapped():
    """Datasets of stages process_map and process_pairs of a stopper."""
    seconds = np.array([5.0, 20.0])
    laws = [law_of(), law_of(seconds, "bake_min", "Sub1")]
    slopes = {"slopes": (("humidity", "shape", "law_quantity"), np.full((2, 1, 2), 0.5))}
    points = [
        _point(_margin(value, second), "", False, value=value, second=second).assign(slopes)
        for second in map(float, grid(seconds, 4))
        for value in map(float, grid(SETTINGS))
    ]
    process_map = of_process.compute(points, laws, [VARIABLE, "bake_min"], ["etch", "bake"], ["B2", "Sub1"])
    return process_map, recommended.of_pairs(process_map, laws, "D", 1)


def rough(is_beam=False, unknown=(), others=()):
    """Dataset of stage roughness, over the rms of B2 from 1 to 8 nm, perhaps also over its skewness."""
    values = [*np.geomspace(1e-9, 8e-9, of_roughness.POINTS - 1), 3.4e-9]
    points = [
        _point(np.array([0.5, 0.6]) * np.log(value / 4e-9) + other + (np.nan if k in unknown else 0), "", is_beam)
        .assign(roughness=value, kurtosis=3.0)
        .assign({"other": other, "other_given": 0.0} if others else {})
        for other in others or (0.0,)
        for k, value in enumerate(values)
    ]
    return of_roughness.curve_or_map(points, "B2", "rms_nm", "skewness" if others else "")


def biased():
    """Dataset of stage stoppers_at_voltage, some of whose patches no spring frees, not even without voltage."""
    forces = 28e-6 * np.exp(0.2 * np.random.default_rng(4).normal(-2, 1, size=(2, 400)))
    settings = stoppers.Settings(1, Water(300.0), (3e-6, 3e-6), (0.8, 0.6), (0.5, 0.9), restoring_force=REQUIRED[False])
    dataset = stoppers.layout(settings, forces, np.array([0.5, 0.7, 0.9]), np.tile(forces[:1], (3, 1)))
    potentials = 10 * np.sqrt(np.maximum(1 - forces / 28e-6, 0))
    return dataset.assign(freeing_potential=(("humidity", "sample"), potentials))
