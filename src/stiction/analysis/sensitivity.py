r"""Sensitivity of the adhesion energy to the moments of a surface (Sec. IV-B, Fig. 13).

A sensitivity of y to x is normalised as :math:`(|x|/y) \, dy/dx`: the relative change of y per relative
increase of x. An increase of a negative skewness brings it closer to zero.
"""

from collections.abc import Sequence

import numpy as np

from stiction.estimates import jackknife


def shifted(moment: float, step: float) -> tuple[float, float]:
    """Values of a moment decreased and increased by the relative ``step``, (2,)."""
    return moment - abs(moment) * step, moment + abs(moment) * step


def normalised_slope(values: Sequence[np.ndarray], at: Sequence[float]) -> np.ndarray:
    """Central difference of ln y over ln |x|, with the sign of an increase of x [-]. Exact for a power law.

    Parameters
    ----------
    values : sequence of two arrays of one shape
        y at the two values of x; positive.
    at : sequence of two floats
        The two values of x, of one sign.

    Raises
    ------
    ValueError
        If zero is between the values of x, so that it has no relative change.

    Examples
    --------
    >>> round(float(normalised_slope((1.1**3, 0.9**3), (-1.1, -0.9))), 3)  # y = |x|³ at x = -1
    -3.0
    """
    if not at[0] * at[1] > 0:
        raise ValueError(f"a sensitivity to a moment between {at[0]:.3g} and {at[1]:.3g} cannot be normalised")
    return np.sign(at[0]) * np.log(values[1] / values[0]) / np.log(at[1] / at[0])


def one_sided(energies: np.ndarray, base: np.ndarray, at: Sequence[float]) -> tuple[np.ndarray, np.ndarray]:
    """Normalised differences of the mean energy to less and to more of a moment, with jackknife errors, (2, ...) [-].

    Energies (2, n, ...) are those of n samples at two values of a moment and ``base`` (n, ...) in their middle [J m⁻²];
    sample k has the same random numbers in all. A difference is (|x|/y) Δy/Δx, straight in y. Of a curved dependence,
    such as an exponential one, both differ from the slope of `normalised_slope`.
    """
    middle = np.mean(at)
    steps = (np.asarray(at) - middle) / abs(middle)
    samples = np.stack([*energies, base], axis=1).astype(float)

    def differences(means):
        """Both differences from the mean energies [-]."""
        *changed, unchanged = means.reshape(samples.shape[1:])
        return np.array([(energy / unchanged - 1) / step for energy, step in zip(changed, steps, strict=True)])

    return jackknife(differences, samples.reshape(len(samples), -1))


def energy_sensitivity(energies: np.ndarray, at: Sequence[float]) -> tuple[np.ndarray, np.ndarray]:
    """Normalised sensitivity of mean and standard deviation of the adhesion energy, with jackknife standard errors.

    Energies (2, n, ...) are those of n samples at two values of a moment [J m⁻²]; sample k of both has the same random
    numbers. Slopes and errors of the mean and of the standard deviation are (2, ...) each [-].
    """
    energies = np.asarray(energies, float)
    powers = np.stack([energies, energies**2])
    samples = np.moveaxis(powers, 2, 0)

    def slopes(means):
        """Normalised slopes of mean and standard deviation, from first and second moments [-]."""
        first, second = means.reshape(samples.shape[1:])
        statistics = np.stack([first, np.sqrt(second - first**2)], axis=1)
        return normalised_slope(statistics, at)

    return jackknife(slopes, samples.reshape(len(samples), -1))
