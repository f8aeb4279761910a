"""Effect of a voltage on a device in contact."""

from collections.abc import Mapping

import numpy as np
import xarray as xr

from stiction.config.cases import Air
from stiction.config.units import from_si
from stiction.devices.risk import Basis, one_in, sampled_bound
from stiction.estimates import mean_with_error
from stiction.life import freeing, holding
from stiction.stages.devices.safe_lengths import chosen_share
from stiction.stages.life.answers import AT_VOLTAGE, FIELD, FREE, FREEING, HOLD, VOLTAGE_ENERGY, Answer
from stiction.stages.life.inputs import OfBeam, OfStopper
from stiction.stages.life.lengths import least_safe

_SOURCE = "stage at_voltage, stiction.life.holding"
#: Relative step of a length for the derivative of the one at a voltage.
_STEP = 1e-4


def beam_at_voltage(
    of: OfBeam, safe: tuple[float, float, str], biased: Mapping[float, xr.Dataset] | None
) -> list[Answer]:
    """Effect of a voltage, and the length safe with it, from the safe length without it and its error [m].

    On flats in contact, and on rough surfaces from the safe lengths at the voltage by humidity, if there are any.
    """
    if not of.capacitor:
        return []
    added = holding.energy_of_voltage(of.capacitor, of.device.gap)
    distance = from_si(of.dielectric.distance, "nm")
    form = f"mean over samples (at least); Γ_V = ε₀ V² / 2 (1 / D - 1 / (D + h)), D = {distance:.3g} nm (at most)"
    gained = [(float(one.voltage_energy), float(one.voltage_error)) for one in (biased or {}).values()]
    low, error = max(gained, default=(np.nan, np.nan))
    what = f"adhesion energy that {of.potential:g} V add"
    numbers = min(low, added), added, error
    answers = [Answer(VOLTAGE_ENERGY, HOLD, what, *numbers, "J m-2", form, _SOURCE), _field(of)]
    numbers = _shorter(of, added, safe, [least_safe(one, chosen_share(one)) for one in (biased or {}).values()])
    if np.isnan(numbers).all():
        return answers
    what = f"simulated limit while {of.potential:g} V are on"
    form = "(L / L_V)³ = 1 + 8 Γ_V L_V L³ / (3 E t³ h²), flats (at least); gaps of rough surfaces, L (at most)"
    return [*answers, Answer(AT_VOLTAGE, HOLD, what, *numbers, "m", form, _SOURCE)]


def _shorter(of, added, safe, rough):
    """Safe length at a voltage [m]: on flats, on rough surfaces, and an error of the first, or of the latter alone.

    NaN for bridges on flats, and on rough surfaces that were not computed. Tips are held at steeper slopes by more of
    their surfaces, so that rough ones can have the least length. A voltage holds more, so that no length is longer than
    without it, as far as bounds of other fits say so.
    """
    length, flat, error = safe[0], np.nan, np.nan
    high, high_error, _ = min(safe, *rough) if rough else (np.nan, np.nan, "")
    if of.device.opening.has_tip and 0 < length < np.inf:
        flat, longer = (holding.tip_length_at_voltage(by * length, of.beam(1.0), added) for by in (1, 1 + _STEP))
        error = safe[1] * (longer - flat) / (_STEP * length)
    if high < flat:
        return high, high, high_error
    return flat, high, high_error if np.isnan(flat) else error


def stopper_at_voltage(stopper: xr.Dataset, of: OfStopper, biased: xr.Dataset | None) -> list[Answer]:
    """Force of a voltage in addition to that on a stopper, and the fraction stuck while it is on."""
    flat = of.capacitor.largest_pressure * of.contact[0] * of.contact[1]
    low, error, sticking = np.nan, np.nan, []
    if biased is not None:
        gained = [mean_with_error(row) for row in (biased.pull_off - stopper.pull_off).values]
        low, error = max(gained)
        stuck = np.maximum(biased.stuck, stopper.stuck)
        worst = stuck.isel(humidity=int(stuck.sel(bound="estimate").argmax("humidity")))
        what = f"probability of sticking while {of.potential:g} V are on, {Air(float(worst.humidity)).where}"
        numbers = *map(float, worst.sel(bound=["low", "high"])), np.nan
        sticking = [Answer("stuck_at_voltage", HOLD, what, *numbers, "1", "as without voltage", _SOURCE)]
    what, form = f"force that {of.potential:g} V add", "mean of rough patches (at least); ε₀ V² A / (2 D²) (at most)"
    added = Answer(AT_VOLTAGE, HOLD, what, min(low, flat), flat, error, "N", form, _SOURCE)
    return [added, *sticking, _field(of), *_freeing_voltage(stopper, of, biased)]


def _freeing_voltage(stopper, of, biased):
    """Voltage below which the spring frees all but a small fraction: of flats, and of rough patches if there are any.

    An offset adds to the voltage, so that the voltage is lower by as much.
    """
    bounded = [float(share) for share in stopper.share[stopper.basis == Basis.SAMPLED]]
    if not bounded:
        return []
    share, area = min(bounded), of.contact[0] * of.contact[1]
    at = stopper.safe_force.sel(share=share)
    held, error = map(float, at.isel(humidity=int(at.sel(part="safe").argmax("humidity"))).sel(part=["safe", "error"]))
    low, high = freeing.freeing_potential_of_flats(of.restoring_force - held, of.capacitor, area), np.nan
    if biased is not None:
        high = min(sampled_bound(row, share)[0] for row in biased.freeing_potential.values)
    spread = error / (2 * low * area * of.capacitor.per_volt.largest_pressure) if low else np.nan
    numbers = *(max(potential - abs(of.offset), 0.0) for potential in (low, high)), spread
    what = f"voltage below which its spring frees all but {one_in(share)}"
    form = "V² = (F - F_hold) 2 D² / (ε₀ A), flats (at least); V² = min (p - f) / g of rough patches (at most)"
    return [Answer(FREEING, FREE, what, *numbers, "V", form, _SOURCE)]


def _field(of):
    """Field in the dielectric of a device whose surfaces touch."""
    what, form = "field in the dielectric in contact", "V / t; thin oxides break down near 1 V/nm"
    return Answer(FIELD, HOLD, what, np.nan, of.capacitor.field, np.nan, "V m-1", form, "stiction.contact.voltage")
