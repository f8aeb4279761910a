"""Stoppers, dimples and landing tips: pull-off force of a patch, against its restoring force.

A patch touches everywhere at once, unlike a beam, and is pulled off by the largest attraction on its way. Its pull-off
force is therefore f_max times its area. Unlike the adhesion energy, f_max is largest below saturation: the wetter the
air, the larger the wetted area, and the weaker the tension in it.

ASSUME: the patch stays parallel to the substrate unless its tilt is stated. That is the safe side for patches with one
tilt each: as many of them hold any force at most. One and the same patch holds more at some tilts, where other summits
touch (`stiction.stages.devices.stoppers`): of 1500 patches of 3 x 3 µm of pair b at RH 0.67, 43 % do at 0.01°, one in
ten by 11 %, and one 3.8 times as much at 0.04°. If its tilt differs between landings, the largest force counts.
"""

from dataclasses import dataclass

import numpy as np

from stiction.devices.risk import CONFIDENCE, DECADE, VERIFIED, Basis, sampled_bound, samples_for, stuck_share
from stiction.devices.tail import fit_tail, scaled_errors
from stiction.estimates import jackknife


def pull_off_force(f_max: float | np.ndarray, area: float) -> float | np.ndarray:
    """Pull-off force of a patch [N], from f_max of surfaces drawn in its size [Pa] and its area [m²]."""
    return f_max * area


def stuck_patches(pull_off: np.ndarray, restoring_forces: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """P(stuck), the fraction of patches above a force (m,) [N], with a pointwise 95 % band, (m,) each [-].

    From the pull-off forces of sampled patches (n,) [N].
    """
    return stuck_share(-np.asarray(restoring_forces), -pull_off)


def safe_force(pull_off: np.ndarray, share: float) -> tuple[float, float, float]:
    """Smallest restoring force with a one-sided 95 % upper bound of P(stuck) of at most a fraction p.

    It is an order statistic of the sampled pull-off forces (n,) [N], without an assumption about their distribution.

    Returns
    -------
    force, estimate, error : float
        The safe force, the force with P(stuck) = p, and the standard error of the estimate [N].

    Raises
    ------
    ValueError
        If there are fewer than `stiction.devices.risk.samples_for` forces.
    """
    force, estimate, error = sampled_bound(-np.asarray(pull_off), share)
    return -force, -estimate, error


@dataclass(frozen=True)
class SafeForce:
    """Smallest restoring force with a one-sided 95 % upper bound of P(stuck) of at most a fraction p."""

    force: float  #: the safe force [N]
    estimate: float  #: force with P(stuck) = p [N]
    error: float  #: standard error of the estimate [N]
    basis: Basis


def safe_forces(pull_off: np.ndarray, share: float, rng: np.random.Generator) -> list[SafeForce]:
    """Safe force for a share p from each row of sampled pull-off forces (rows, n) [N].

    If there are enough patches (`stiction.devices.risk.samples_for`), it is that of `safe_force`. Otherwise a line is
    fitted through the logarithms of the largest 5 % of the forces over the normal score, as through the shortest
    lengths of beams. ASSUME: the end of the forces is lognormal. That is the safe side: of 110 000 patches of 1.5 µm
    side each, of the paper's pair b and of normal surfaces of 5 nm rms, in dry air and at RH 0.67, a share of 1e-3
    holds 1 to 4 % less than such lines say, and one of 1e-4 holds 2 to 13 % less.

    Raises
    ------
    ValueError
        If there are fewer patches than `stiction.devices.tail.fit_tail` needs, or too few of them hold any force.
    """
    samples = pull_off.shape[-1]
    if samples >= samples_for(share):
        return [SafeForce(*safe_force(row, share), Basis.SAMPLED) for row in pull_off]
    held = pull_off > 0
    inverse = np.divide(1.0, pull_off, out=np.full(pull_off.shape, np.inf), where=held)
    fits = [fit_tail(row) for row in inverse]
    errors, pivots = scaled_errors(samples, share, rng)
    high, scatter = np.quantile(pivots, CONFIDENCE), errors.std()
    basis = Basis.FITTED if share >= VERIFIED and samples * share >= DECADE else Basis.EXTRAPOLATED
    lines = [(1 / fit.length(share), fit.slope) for fit in fits]
    return [SafeForce(float(at * np.exp(high * slope)), at, float(at * scatter * slope), basis) for at, slope in lines]


def peak(x: np.ndarray, values: np.ndarray) -> float:
    """Place of the largest value, by a parabola through it and its neighbours, or an end of ``x`` if it is there.

    The places x increase, not necessarily evenly.
    """
    i = int(np.argmax(values))
    if i in (0, len(x) - 1):
        return float(x[i])
    before, after = x[i - 1] - x[i], x[i + 1] - x[i]
    rise, fall = (values[i - 1] - values[i]) / before, (values[i + 1] - values[i]) / after
    bend = (fall - rise) / (after - before)
    return float(x[i] - (rise - bend * before) / (2 * bend)) if bend < 0 else float(x[i])


def worst_humidity(humidities: np.ndarray, pull_off: np.ndarray) -> tuple[float, float]:
    """Humidity of the largest mean pull-off force, with its jackknife standard error [-].

    Along a fine axis, increasing (m,) [-]; row k of the forces (n, m) [N] is the same patch at all humidities.
    """
    worst, error = jackknife(lambda mean: peak(humidities, mean), pull_off)
    return float(worst), float(error)
