r"""Apparent adhesive contact force of one sample and its parameters (Sec. III-B1).

Convention: a force per unit area ``f(d)`` [Pa] at the distance ``d`` [m] between mean planes is positive in repulsion
and negative in attraction. The package uses two row formats:

* a **vector** v = [e, f_max, d_max, d_limit] of Eq. (11), in J m⁻², Pa, m, m;
* a **force law**, or law, [f_max, d_max, a_left, a_right] of Eq. (12), in Pa, m, m⁻¹, m⁻¹.

The threshold ``f_limit`` that defines ``d_limit`` is one number for all samples of a case.
"""

from collections.abc import Callable, Sequence
from contextlib import contextmanager

import numpy as np

from stiction.kernels import kernel

#: A curve has decayed where it is below this share of its depth; the energy neglected beyond is a similar share of e.
DECAYED = 1e-4


# Sec. III-A: the curve of one sample


@kernel
def _node(values, index, before):
    """Value at a node of a uniform grid: ``before`` before its first node, 0 beyond its last."""
    if index < 0:
        return before
    return values[index] if index < values.size else 0.0


@kernel
def _add_interpolated(values, offset, before, factor, out):
    """Add ``factor`` times a curve, linear between nodes, to ``out``, from ``offset`` steps into the curve."""
    first = int(np.floor(offset))
    weight = offset - first
    for i in range(out.size):
        behind, ahead = _node(values, first + i, before), _node(values, first + i + 1, before)
        out[i] += factor * ((1 - weight) * behind + weight * ahead)


@kernel
def apparent_force(
    solid: np.ndarray,
    bearing: np.ndarray,
    starts: tuple[float, float, float],
    step: float,
    shift: float,
    tension: float,
    out: np.ndarray,
) -> None:
    r"""Force of solid contact and water film, :math:`f(d) = p_s(d) - \sigma A(d - h_C)`, written to ``out``.

    Curves are linear between nodes. Either input is zero beyond its last node; the bearing area is 1 before its first.
    Inputs in single precision give the same bits as their copies in double precision.

    Parameters
    ----------
    solid : (n_s,) float32 or float64
        Pressure of the solids p_s [Pa].
    bearing : (n_b,) float32 or float64
        Bearing area fraction A [-].
    starts : tuple of 3 floats
        Distance at the first node of ``solid``, ``bearing`` and ``out`` [m].
    step : float
        Common spacing of the three grids [m].
    shift, tension : float
        Height h_C of the film [m] and tension σ = -ΔP in it [Pa].
    out : (n_d,) float64
        Receives f [Pa].

    Raises
    ------
    ValueError
        If ``out`` begins before ``solid``, whose pressure is unknown there.
    """
    offset = (starts[2] - starts[0]) / step
    if offset < -1e-6:  # aligned grids may differ by rounding
        raise ValueError("the curve begins at a distance where the solid pressure is not known")
    out[:] = 0.0
    _add_interpolated(solid, offset, solid[0], 1.0, out)
    _add_interpolated(bearing, (starts[2] - shift - starts[1]) / step, 1.0, -tension, out)


def humid_curves(
    solid: np.ndarray, bearing: np.ndarray, starts: tuple[float, float], step: float, film: tuple[float, float]
) -> tuple[np.ndarray, Callable[[int], np.ndarray]]:
    """Curves f(d) of all samples under one water film.

    Parameters
    ----------
    solid, bearing : (m, n_s) and (m, n_b) arrays
        Pressure of the solids p_s [Pa] and bearing area fraction A [-].
    starts : tuple of 2 floats
        Distance at the first node of ``solid`` and of ``bearing`` [m].
    step : float
        Common spacing of the grids [m].
    film : tuple of 2 floats
        Height h_C and tension of the water [m], [Pa].

    Returns
    -------
    distance : (n_d,) float64
        From the first node of ``solid`` to where both inputs have vanished [m].
    curve : callable
        ``curve(k)`` is the force of sample k (n_d,) [Pa]; the next call overwrites it.
    """
    height, tension = film
    end = max(starts[0] + solid.shape[1] * step, starts[1] + bearing.shape[1] * step + height)
    distance = starts[0] + step * np.arange(int(np.ceil((end - starts[0]) / step)) + 1)
    out = np.empty(distance.size)

    def curve(k):
        """Force curve of sample k [Pa], in a common array."""
        apparent_force(solid[k], bearing[k], (*starts, starts[0]), step, height, tension, out)
        return out

    return distance, curve


# Tilted tips of beams


@kernel
def largest_attractions(
    solid: np.ndarray, bearing: np.ndarray, starts: tuple[float, float], step: float, film: tuple[float, float]
) -> np.ndarray:
    """Largest attraction of every strip at every slope under one water film, per area of the strip (m, n_slopes) [Pa].

    Parameters
    ----------
    solid, bearing : (m, n_slopes, n_s) and (m, n_slopes, n_b) arrays
        Pressure of the solids p_s [Pa] and bearing area [-].
    starts : tuple of 2 floats
        Distance at the first node of ``solid`` and of ``bearing`` [m].
    step : float
        Common spacing of the grids [m].
    film : tuple of 2 floats
        Height h_C and tension of the water [m], [Pa].

    Where a curve attracts most at its first node, because too few summits stop the tip, it is the force there.
    """
    samples, slopes, points = solid.shape
    largest, force = np.empty((samples, slopes)), np.empty(points)
    for k in range(samples):
        for i in range(slopes):
            ends = (starts[0], starts[1], starts[0])
            apparent_force(solid[k, i], bearing[k, i], ends, step, film[0], film[1], force)
            largest[k, i] = _deepest(force)
    return largest


@kernel
def _deepest(force):
    """Largest attraction of a curve, by a parabola through its lowest three nodes, or a node's at its ends."""
    i = np.argmin(force)
    if i == 0 or i == force.size - 1:
        return -force[i]
    slope = 0.5 * (force[i + 1] - force[i - 1])
    bend = force[i + 1] - 2 * force[i] + force[i - 1]
    return -force[i] + 0.5 * slope * slope / bend if bend > 0 else -force[i]


# Sec. III-B1: parameters of a curve


@kernel
def _crossing(distance, force, index, level):
    """Distance of the value ``level`` on the line between nodes ``index`` and ``index + 1`` [m]."""
    fraction = (level - force[index]) / (force[index + 1] - force[index])
    return distance[index] + fraction * (distance[index + 1] - distance[index])


@kernel
def _reach(force, start, level):
    """Last node before ``start`` with a force of at least ``level``."""
    for i in range(start - 1, -1, -1):
        if force[i] >= level:
            return i
    raise ValueError(
        "the force does not rise to zero or to f_limit at any distance between the mean planes: the surfaces are too "
        "smooth or the solid is too soft to resist the adhesion, the air is too dry, or the patch of surface is too "
        "small, so that a sample has too few summits"
    )


@kernel
def extremum(distance: np.ndarray, force: np.ndarray) -> tuple[float, float]:
    """Distance d_max [m] and size f_max [Pa] of the largest attraction, by a parabola through the lowest three nodes.

    Parameters
    ----------
    distance, force : (n_d,) float64
        Uniform grid [m] and the curve on it [Pa].

    Raises
    ------
    ValueError
        If the curve has no attraction, or its minimum is at an end of its grid.
    """
    i = np.argmin(force)
    if not force[i] < 0:
        raise ValueError("the force is nowhere attractive")
    if i == 0 or i == force.size - 1:
        raise ValueError("the minimum of the force is at an end of its grid")
    slope = 0.5 * (force[i + 1] - force[i - 1])
    bend = force[i + 1] - 2 * force[i] + force[i - 1]
    offset = -slope / bend if bend > 0 else 0.0
    return distance[i] + offset * (distance[i + 1] - distance[i]), -(force[i] + 0.5 * slope * offset)


@kernel
def _mean_attraction(left, right):
    """Mean of max(-f, 0) over a step with linear f [Pa]."""
    if left * right < 0:
        return 0.5 * min(left, right) ** 2 / abs(left - right)
    return max(-0.5 * (left + right), 0.0)


@kernel
def adhesion_energy(distance: np.ndarray, force: np.ndarray, beyond: float = 0.0) -> float:
    """Adhesion energy e (work of separation): integral of the attraction beyond the zero crossing [J m⁻²].

    Parameters as in `extremum`; ``beyond`` is the part of the integral beyond the grid [J m⁻²], where it is known.

    ASSUME: a single high asperity can make the curve repulsive again beyond its minimum (4 % of the samples of pair b
    at RH 0.44). Only the attractive parts are integrated: the net integral may be negative, and e must not (App. B).

    Raises
    ------
    ValueError
        If the curve has no repulsion, or has not decayed at the end of its grid and nothing is known beyond.
    """
    lowest = np.argmin(force)
    if not (beyond > 0 or abs(force[-1]) <= -DECAYED * force[lowest]):
        raise ValueError("the force has not decayed at the end of its grid")
    energy = beyond
    for j in range(_reach(force, lowest, 0.0), force.size - 1):
        energy += _mean_attraction(force[j], force[j + 1]) * (distance[j + 1] - distance[j])
    return energy


@kernel
def limit_distance(distance: np.ndarray, force: np.ndarray, limit: float) -> float:
    """Distance d_limit left of the minimum, at the first force of ``limit`` [m]. Parameters as in `extremum`.

    Raises
    ------
    ValueError
        If the force does not reach it.
    """
    return _crossing(distance, force, _reach(force, np.argmin(force), limit), limit)


def _each_sample(evaluate, curve, samples):
    """``evaluate(force, k)`` of the curves one by one (samples, ...). An error contains the number of the sample."""
    rows = []
    for k in range(samples):
        force = curve(k)
        try:
            rows.append(evaluate(force, k))
        except ValueError as error:
            span = f"runs from {force.min():.3g} to {force.max():.3g} and ends at {force[-1]:.3g} Pa"
            raise ValueError(f"sample {k}: {error}; it {span}") from error
    return np.array(rows)


def repulsions(forces: np.ndarray) -> np.ndarray:
    """Largest force of each curve (n, n_d) at smaller distances than its largest attraction (n,) [Pa]."""
    return np.array([force[: force.argmin()].max(initial=-np.inf) for force in forces])


def together(forces: np.ndarray, force: float) -> int | None:
    """Number of areas for resistance, as far as samples show: every mean curve of them rises to a force [Pa].

    Curves (n, n_d) [Pa]; the least power of two, ``None`` if not even the mean of most samples rises.
    """
    for size in (2**k for k in range(len(forces).bit_length())):
        groups = len(forces) // size
        if np.all(repulsions(forces[: groups * size].reshape(groups, size, -1).mean(axis=1)) > force):
            return size
    return None


@contextmanager
def _remedy(curve, samples):
    """Add the size of a sufficient patch to an error about curves without resistance to the adhesion."""
    try:
        yield
    except ValueError as error:
        forces = np.array([curve(k).copy() for k in range(samples)])
        if (times := together(forces, -forces.min()) or 1) > 1:
            error.add_note(f"As far as these samples show, {times} times the area of the patch would do.")
        raise


def resists(force: np.ndarray) -> bool:
    """Whether the summits of a sample stop the surfaces: its curve (n_d,) rises to zero as they approach [Pa]."""
    return bool(repulsions(force[None])[0] >= 0)


def share_flat(curve: Callable[[int], np.ndarray], samples: int) -> float:
    """Fraction of sampled curves without resistance to the adhesion, counted as flat surfaces in contact [-]."""
    return float(np.mean([not resists(curve(k)) for k in range(samples)]))


def parametrise(
    distance: np.ndarray,
    curve: Callable[[int], np.ndarray],
    samples: int,
    beyond: np.ndarray | None = None,
    flat: tuple[float, float] | None = None,
) -> tuple[np.ndarray, float]:
    """Parameters of all sampled curves, Eq. (11), interpolated between the grid points.

    Every curve is computed twice, because f_limit depends on all curves; the memory thus does not grow with their
    number.

    Parameters
    ----------
    distance : (n_d,) float64
        Uniform grid [m].
    curve : callable
        ``curve(k)`` is the force of sample k on the grid, (n_d,) float64 [Pa]; the memory may be reused.
    samples : int
        Number of samples m.
    beyond : (m,) float64, optional
        Energy of the attraction of each sample beyond the grid [J m⁻²]; without it, the curves have decayed there.
    flat : tuple of 2 floats, optional
        Upper bounds of e [J m⁻²] and f_max [Pa] of any surfaces. ASSUME: samples that do not resist the adhesion have
        these, the safe side, and where a curve rises less than to f_limit, its law does as steeply as at zero.

    Returns
    -------
    vectors : (m, 4) float64
        Rows v = [e, f_max, d_max, d_limit].
    f_limit : float
        Largest f_max of all samples that resist the adhesion [Pa].

    Raises
    ------
    ValueError
        If a curve has no attraction, is truncated by its grid or, without ``flat``, does not reach f_limit; the message
        contains the number of the sample.
    """
    beyond = np.zeros(samples) if beyond is None else beyond
    with _remedy(curve, samples):
        wells = _each_sample(lambda f, k: _well(distance, f, beyond[k], flat), curve, samples)
        d_max, f_max, e = wells.T
        attracts = np.isfinite(d_max)
        f_limit = float(f_max[attracts if attracts.any() else ~attracts].max())
        d_limit = _each_sample(lambda f, _: _limit(distance, f, f_limit, flat), curve, samples)
    if not attracts.all():
        d_max[~attracts] = distance[0]
        d_limit[~attracts] = distance[0] - _rise(f_limit / flat[1]) * flat[0] / (2 * flat[1])
    return np.column_stack([e, f_max, d_max, d_limit]), f_limit


def _well(distance, force, beyond, flat):
    """Place and size of the largest attraction and its energy. Flat surfaces have no place."""
    if flat is not None and not resists(force):
        return np.nan, flat[1], flat[0]
    return *extremum(distance, force), adhesion_energy(distance, force, beyond)


def _limit(distance, force, limit, flat):
    """Limit d_limit of a curve, NaN of a flat one."""
    if flat is None or repulsions(force[None])[0] >= limit:
        return limit_distance(distance, force, limit)
    if not resists(force):
        return np.nan
    d_max, f_max = extremum(distance, force)
    return d_max - (d_max - limit_distance(distance, force, 0.0)) * _rise(limit / f_max) / np.log(2)


def adhesion_energies(
    distance: np.ndarray,
    curve: Callable[[int], np.ndarray],
    samples: int,
    beyond: np.ndarray | None = None,
    flat: tuple[float, float] | None = None,
) -> np.ndarray:
    """Energies e of all sampled curves (m,) [J m⁻²]. Parameters of `parametrise`, errors of `adhesion_energy`."""
    beyond = np.zeros(samples) if beyond is None else beyond

    def energy_of(force, k):
        """Adhesion energy of curve k [J m⁻²], the flat surfaces' if it does not resist."""
        return adhesion_energy(distance, force, beyond[k]) if flat is None or resists(force) else flat[0]

    return _each_sample(energy_of, curve, samples)


def pull_offs(
    distance: np.ndarray, curve: Callable[[int], np.ndarray], samples: int, flat: tuple[float, float] | None = None
) -> np.ndarray:
    """Largest attraction f_max of all sampled curves (m,) [Pa]. Parameters of `parametrise`, errors of `extremum`."""

    def pull_off(force, _):
        """Largest attraction of a curve [Pa], the flat surfaces' if it does not resist."""
        return extremum(distance, force)[1] if flat is None or resists(force) else flat[1]

    return _each_sample(pull_off, curve, samples)


# Eq. (12): the analytical force law


def _rise(ratio):
    """Distance, in lengths 1/a_left, of the rise of a law from its minimum to a multiple of f_max."""
    return np.log(1 + np.sqrt(1 + ratio))


def _left_steepness(vectors, f_limit):
    """Coefficient a_left, from f(d_limit) = f_limit (n,) [m⁻¹]."""
    _, f_max, d_max, d_limit = vectors.T
    return _rise(f_limit / f_max) / (d_max - d_limit)


def _right_range(vectors, a_left):
    """Contribution of the branch d > d_max to e / f_max, equal to 1.5 / a_right (n,) [m]."""
    e, f_max, _, _ = vectors.T
    return e / f_max - 0.5 / a_left


def admissible(vectors: np.ndarray, f_limit: float) -> np.ndarray:
    """Mark vectors (n, 4) with a force law of Eq. (12), i.e. a_right > 0, (n,) bool.

    The branch d < d_max alone has the energy 0.5 f_max / a_left; a vector with smaller e has no force law.
    """
    return _right_range(vectors, _left_steepness(vectors, f_limit)) > 0


def coefficients(vectors: np.ndarray, f_limit: float) -> np.ndarray:
    r"""Coefficients of Eq. (12) for the vectors.

    .. math:: a_\mathrm{left} = \frac{\ln(1 + \sqrt{1 + f_\mathrm{limit} / f_\mathrm{max}})}
        {d_\mathrm{max} - d_\mathrm{limit}}, \quad
        e = f_\mathrm{max} \Bigl(\frac{3}{2 a_\mathrm{right}} + \frac{1}{2 a_\mathrm{left}}\Bigr)

    Parameters
    ----------
    vectors : (n, 4) float64
        Rows [e, f_max, d_max, d_limit].
    f_limit : float
        Pressure at d_limit [Pa].

    Returns
    -------
    (n, 4) float64
        Laws [f_max, d_max, a_left, a_right].

    Raises
    ------
    ValueError
        If a vector is not `admissible`.

    Examples
    --------
    >>> law = coefficients(np.array([[7e-3, 2e6, 8e-9, 6.5e-9]]), 3e6)
    >>> [round(float(a) * 1e-9, 3) for a in law[0, 2:]]  # nm⁻¹
    [0.632, 0.554]
    """
    laws, lawful = coefficients_where_lawful(vectors, f_limit)
    if not lawful.all():
        first = int(np.argmin(lawful))
        f_max, _, a_left, _ = laws[first]
        raise ValueError(
            f"vector {first} has no law: its energy e = {vectors[first, 0]:.3g} J/m² must be above that of its left "
            f"branch alone, f_max / (2 a_left) = {f_max / (2 * a_left):.3g} J/m²"
        )
    return laws


def coefficients_where_lawful(vectors: np.ndarray, f_limit: float) -> tuple[np.ndarray, np.ndarray]:
    """Coefficients of vectors, with a_right <= 0 or infinite unless `admissible`, and whether they are (n,)."""
    a_left = _left_steepness(vectors, f_limit)
    reach = _right_range(vectors, a_left)
    with np.errstate(divide="ignore"):
        return np.column_stack([vectors[:, 1], vectors[:, 2], a_left, 1.5 / reach]), reach > 0


def pressure(law: np.ndarray, distance: float | np.ndarray) -> float | np.ndarray:
    """Force per unit area of Eq. (12) [Pa]. Laws (..., 4) and distance [m] broadcast."""
    f_max, d_max, a_left, a_right = np.moveaxis(np.asarray(law), -1, 0)
    separation = distance - d_max
    decay = np.exp(-np.where(separation < 0, a_left, a_right) * separation)
    return f_max * decay * (decay - 2)


def energy(law: np.ndarray) -> float | np.ndarray:
    """Adhesion energy e of Eq. (12), the integral of its attraction. Laws (..., 4) [J m⁻²]."""
    f_max, _, a_left, a_right = np.moveaxis(np.asarray(law), -1, 0)
    return f_max * (1.5 / a_right + 0.5 / a_left)


def mean_law(laws: np.ndarray) -> np.ndarray:
    """Law (4,) of the mean energy, largest attraction and its distance of laws (n, 4), of their mean asymmetry."""
    law = np.mean(laws, axis=0)
    law[2:] *= energy(law) / np.mean(energy(laws))
    return law


def fit_errors(
    distance: np.ndarray,
    curve: Callable[[int], np.ndarray],
    samples: Sequence[int],
    vectors: np.ndarray,
    f_limit: float,
) -> tuple[np.ndarray, np.ndarray]:
    """Relative errors of Eq. (12) with respect to the curves.

    The energy e is one of the four parameters of a law, so that its error is due to rounding.

    Parameters
    ----------
    distance, curve
        As in `parametrise`.
    samples : (n,) int
        Numbers of the curves.
    vectors : (n, 4) float64
        Their vectors, all `admissible`.
    f_limit : float
        [Pa]

    Returns
    -------
    curve_error : (n,) float64
        Root of ∫ (φ - f)² over that of ∫ f², both for d >= d_limit [-].
    energy_error : (n,) float64
        Of e [-].
    """
    laws = coefficients(vectors, f_limit)
    rows = zip(samples, laws, vectors[:, 3], strict=True)
    curve_error = [_curve_error(distance, curve(k), law, d_limit) for k, law, d_limit in rows]
    return np.array(curve_error), np.abs(energy(laws) / vectors[:, 0] - 1)


def _curve_error(distance, force, law, d_limit):
    """Relative distance between a curve and its law for d >= d_limit [-]."""
    used = distance >= d_limit
    difference = pressure(law, distance[used]) - force[used]
    return np.sqrt(np.sum(difference**2) / np.sum(force[used] ** 2))
