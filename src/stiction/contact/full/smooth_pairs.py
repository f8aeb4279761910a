"""Forces on summits of smooth pairs in humid air, beside full elastic contact.

Attraction and water flatten gentle surfaces: a fifth to a half of them touch, not single summits. Forces then rest on
area that the sum over summits lacks, and the more so the less the water itself pulls, in wetter air.
"""

import numpy as np

#: Relative humidities of the table [-].
HUMIDITIES = np.array([0.67, 0.9, 0.97])
#: Rms roughness of the beams, which are like B2 [nm], and that of both surfaces together, on Sub1 [m].
OF_BEAMS = (0.5, 1.0, 1.7, 3.4)
RMS = 1e-9 * np.hypot(OF_BEAMS, 0.17)
#: Mean largest attraction f_max of full contact over that on summits, with attraction across gaps, by humidity and rms:
#: 4 to 22 strips of 1.5 x 4 and 8 µm each. ASSUME: beyond the table, the ratio is that at its end. In drier air
#: and on smoother pairs this is too large (1 nm, RH 0.44: 1.10 ± 0.02; 0.25 nm, RH 0.9: 1.17 ± 0.03), the safe side, in
#: wetter air perhaps too small. Steeper surfaces are flattened less: like B1, with 2.5 times the slope at the same
#: rms, it is 1.02 and 1.04 at 1 nm, RH 0.67 and 0.9.
RATIOS = np.array([[1.264, 1.139, 1.040, 0.938], [1.556, 1.320, 1.052, 1.009], [1.606, 1.804, 1.098, 1.006]])
#: Their standard errors.
ERRORS = np.array([[0.014, 0.009, 0.008, 0.05], [0.029, 0.022, 0.015, 0.006], [0.142, 0.105, 0.035, 0.006]])


def shortfall(rms: float, humidity: float) -> tuple[float, float]:
    """Fraction by which a force on summits is too small and its standard error [-], from the rms of the pair [m].

    Interpolated in rms and humidity.

    Examples
    --------
    >>> [round(part, 2) for part in shortfall(1.014e-9, 0.9)]
    [0.24, 0.01]
    """
    ratio, error = (
        float(np.interp(humidity, HUMIDITIES, [np.interp(rms, RMS, row) for row in table]))
        for table in (RATIOS, ERRORS)
    )
    return max(1 - 1 / ratio, 0.0), error / ratio**2


def in_wetter_air(ratio: float, computed_at: float, humidity: float) -> float:
    """Ratio of full contact to summits of a force in air wetter than where it was computed.

    ASSUME: a ratio above 1 grows as that of the pair of the table that has it where it was computed. One below 1 rises
    to 1 in saturated air, with a logarithm that is linear in the humidity. Both are the safe side.

    Examples
    --------
    >>> [round(in_wetter_air(ratio, 0.67, 0.9), 3) for ratio in (1.139, 0.8)]
    [1.32, 0.935]
    """
    if ratio <= 1:
        return ratio ** ((1 - humidity) / (1 - computed_at))
    drier, wetter = _of_pairs(computed_at), _of_pairs(humidity)
    like = float(np.interp(ratio, drier, np.arange(len(drier))))
    return ratio * float(np.interp(like, np.arange(len(drier)), wetter / drier))


def _of_pairs(humidity):
    """Ratios of the pairs of the table from the roughest on, 1 at humidity 0 and nowhere falling [-]."""
    table = np.vstack([np.ones(len(RMS)), RATIOS])[:, ::-1]
    rising = np.maximum.accumulate(np.maximum.accumulate(table, axis=0), axis=1)
    return np.array([np.interp(humidity, np.append(0.0, HUMIDITIES), column) for column in rising.T])


def largest_shortfall() -> float:
    """Largest shortfall of the table [-], two standard errors above its estimate.

    Examples
    --------
    >>> round(largest_shortfall(), 2)
    0.51
    """
    return max(short + 2 * error for short, error in (shortfall(rms, rh) for rms in RMS for rh in HUMIDITIES))
