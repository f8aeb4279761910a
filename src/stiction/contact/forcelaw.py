r"""Apparent adhesive contact force of one piece of surface and its parameters (Sec. III-B1).

Convention, as everywhere: a force per unit area ``f(d)`` [Pa] of the distance ``d`` [m] between mean planes is positive
where the surfaces repel and negative where they attract. Two row formats carry it through the package:

* a **vector** v = [e, f_max, d_max, d_limit] of Eq. (11), in J m⁻², Pa, m, m;
* a **law** [f_max, d_max, a_left, a_right] of Eq. (12), in Pa, m, m⁻¹, m⁻¹.

The threshold ``f_limit`` that defines ``d_limit`` is one number for all samples of a case.
"""

import numpy as np
from numba import njit

#: A curve has died out where it falls below this part of its depth; the energy cut off beyond is a similar part of e.
DEAD = 1e-4


# Sec. III-A: the curve of one sample


@njit(cache=True, nogil=True)
def _node(values, index, left):
    """Value at a node of a uniform grid: ``left`` before its first node, 0 behind its last."""
    if index < 0:
        return left
    return values[index] if index < values.size else 0.0


@njit(cache=True, nogil=True)
def _add_interpolated(values, offset, left, factor, out):
    """Add ``factor`` times a curve, linear between nodes, to ``out``, which starts ``offset`` steps into it."""
    first = int(np.floor(offset))
    weight = offset - first
    for i in range(out.size):
        here, ahead = _node(values, first + i, left), _node(values, first + i + 1, left)
        out[i] += factor * ((1 - weight) * here + weight * ahead)


@njit(cache=True, nogil=True)
def apparent_force(solid, bearing, starts, step, shift, tension, out):
    r"""Force of solid contact and water film, :math:`f(d) = p_s(d) - \sigma A(d - h_C)`, written to ``out``.

    Curves are linear between nodes. Behind its last node either input is zero, before its first the bearing area is 1.

    Parameters
    ----------
    solid : (n_s,) float64
        Pressure of the solids p_s [Pa].
    bearing : (n_b,) float64
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
    if offset < -1e-6:  # rounding of aligned grids is no node outside
        raise ValueError("the curve begins at a distance where the solid pressure is not known")
    out[:] = 0.0
    _add_interpolated(solid, offset, solid[0], 1.0, out)
    _add_interpolated(bearing, (starts[2] - shift - starts[1]) / step, 1.0, -tension, out)


def humid_curves(solid, bearing, starts, step, film):
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
        From the first node of ``solid`` to where neither input acts any more [m].
    curve : callable
        ``curve(k)`` is the force of sample k (n_d,) [Pa]; the next call overwrites it.
    """
    height, tension = film
    end = max(starts[0] + solid.shape[1] * step, starts[1] + bearing.shape[1] * step + height)
    distance = starts[0] + step * np.arange(int(np.ceil((end - starts[0]) / step)) + 1)
    out = np.empty(distance.size)

    def curve(k):
        inputs = np.asarray(solid[k], np.float64), np.asarray(bearing[k], np.float64)
        apparent_force(*inputs, (*starts, starts[0]), step, height, tension, out)
        return out

    return distance, curve


# Sec. III-B1: parameters of a curve


@njit(cache=True, nogil=True)
def _crossing(distance, force, index, level):
    """Distance at which the line between nodes ``index`` and ``index + 1`` takes the value ``level`` [m]."""
    part = (level - force[index]) / (force[index + 1] - force[index])
    return distance[index] + part * (distance[index + 1] - distance[index])


@njit(cache=True, nogil=True)
def _reach(force, start, level):
    """Last node before ``start`` where the force is at least ``level``."""
    for i in range(start - 1, -1, -1):
        if force[i] >= level:
            return i
    raise ValueError(
        "the force does not rise to zero or to f_limit on its grid: the air is too dry, or steps are too long"
    )


@njit(cache=True, nogil=True)
def extremum(distance, force):
    """Distance d_max [m] and size f_max [Pa] of the largest attraction, by a parabola through the lowest three nodes.

    Parameters
    ----------
    distance, force : (n_d,) float64
        Uniform grid [m] and the curve on it [Pa].

    Raises
    ------
    ValueError
        If the curve never attracts, or is lowest at an end of its grid.
    """
    i = np.argmin(force)
    if not force[i] < 0:
        raise ValueError("the force attracts nowhere")
    if i == 0 or i == force.size - 1:
        raise ValueError("the force is lowest at an end of its grid")
    slope = 0.5 * (force[i + 1] - force[i - 1])
    bend = force[i + 1] - 2 * force[i] + force[i - 1]
    offset = -slope / bend if bend > 0 else 0.0
    return distance[i] + offset * (distance[i + 1] - distance[i]), -(force[i] + 0.5 * slope * offset)


@njit(cache=True, nogil=True)
def _mean_attraction(left, right):
    """Mean of -f where it attracts, 0 elsewhere, over a step in which f is linear [Pa]."""
    if left * right < 0:
        return 0.5 * min(left, right) ** 2 / abs(left - right)
    return max(-0.5 * (left + right), 0.0)


@njit(cache=True, nogil=True)
def adhesion_energy(distance, force):
    """Energy e to separate: integral of the attraction from the zero crossing on, by trapezoids [J m⁻²].

    Parameters as in `extremum`.

    ASSUME: a lone high asperity can make the curve repel once more beyond its minimum (4 % of the samples of pair b at
    RH 0.44). Only the attractive parts count there: the net integral may be negative, and e must not (App. B).

    Raises
    ------
    ValueError
        If the curve never repels, or has not died out at the end of its grid.
    """
    lowest = np.argmin(force)
    if not abs(force[-1]) <= -DEAD * force[lowest]:
        raise ValueError("the force has not died out at the end of its grid")
    energy = 0.0
    for j in range(_reach(force, lowest, 0.0), force.size - 1):
        energy += _mean_attraction(force[j], force[j + 1]) * (distance[j + 1] - distance[j])
    return energy


@njit(cache=True, nogil=True)
def limit_distance(distance, force, limit):
    """Distance d_limit left of the minimum at which the force first reaches ``limit`` [m]; parameters as in `extremum`.

    Raises
    ------
    ValueError
        If it never does.
    """
    return _crossing(distance, force, _reach(force, np.argmin(force), limit), limit)


def _each_sample(evaluate, curve, samples):
    """Evaluate the curves one after the other; an error names the sample (samples, ...)."""
    rows = []
    for k in range(samples):
        force = curve(k)
        try:
            rows.append(evaluate(force))
        except ValueError as error:
            span = f"runs from {force.min():.3g} to {force.max():.3g} and ends at {force[-1]:.3g} Pa"
            raise ValueError(f"sample {k}: {error}; it {span}") from error
    return np.array(rows)


def parametrise(distance, curve, samples):
    """Parameters of all sampled curves, Eq. (11), each found between the grid points.

    The curves are asked for twice, because f_limit is only known after all have been seen: the memory needed does not
    grow with their number.

    Parameters
    ----------
    distance : (n_d,) float64
        Uniform grid [m].
    curve : callable
        ``curve(k)`` is the force of sample k on the grid, (n_d,) float64 [Pa]; may reuse its memory.
    samples : int
        Number of samples m.

    Returns
    -------
    vectors : (m, 4) float64
        Rows v = [e, f_max, d_max, d_limit].
    f_limit : float
        Largest f_max of all samples [Pa].

    Raises
    ------
    ValueError
        If a curve never attracts, is cut off by its grid or does not reach f_limit; names the sample.
    """
    wells = _each_sample(lambda f: (*extremum(distance, f), adhesion_energy(distance, f)), curve, samples)
    d_max, f_max, e = wells.T
    f_limit = float(f_max.max())
    d_limit = _each_sample(lambda f: limit_distance(distance, f, f_limit), curve, samples)
    return np.column_stack([e, f_max, d_max, d_limit]), f_limit


def adhesion_energies(distance, curve, samples):
    """Energies e of all sampled curves (m,) [J m⁻²]; parameters and errors as in `parametrise`."""
    return _each_sample(lambda f: adhesion_energy(distance, f), curve, samples)


# Eq. (12): the analytical force law


def _left_steepness(vectors, f_limit):
    """Coefficient a_left, from f(d_limit) = f_limit (n,) [m⁻¹]."""
    _, f_max, d_max, d_limit = vectors.T
    return np.log(1 + np.sqrt(1 + f_limit / f_max)) / (d_max - d_limit)


def _right_range(vectors, f_limit):
    """Share of e / f_max that is left to the branch d > d_max, equal to 1.5 / a_right (n,) [m]."""
    e, f_max, _, _ = vectors.T
    return e / f_max - 0.5 / _left_steepness(vectors, f_limit)


def admissible(vectors, f_limit):
    """Whether vectors (n, 4) have a law of Eq. (12), that is a_right > 0; (n,) bool.

    The branch d < d_max alone holds the energy 0.5 f_max / a_left; a vector whose e is smaller has no law.
    """
    return _right_range(vectors, f_limit) > 0


def coefficients(vectors, f_limit):
    r"""Coefficients of Eq. (12) that reproduce the vectors.

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
    reach = _right_range(vectors, f_limit)
    if not np.all(reach > 0):
        worst = int(np.argmin(reach))
        raise ValueError(
            f"vector {worst} has no law: e = {vectors[worst, 0]:.3g} J/m² is less than its left branch holds"
        )
    return np.column_stack([vectors[:, 1], vectors[:, 2], _left_steepness(vectors, f_limit), 1.5 / reach])


def pressure(law, distance):
    """Force per unit area of Eq. (12) [Pa]; laws (..., 4) and distance [m] broadcast."""
    f_max, d_max, a_left, a_right = np.moveaxis(np.asarray(law), -1, 0)
    separation = distance - d_max
    decay = np.exp(-np.where(separation < 0, a_left, a_right) * separation)
    return f_max * decay * (decay - 2)


def energy(law):
    """Integral e of the attraction of Eq. (12); laws (..., 4) [J m⁻²]."""
    f_max, _, a_left, a_right = np.moveaxis(np.asarray(law), -1, 0)
    return f_max * (1.5 / a_right + 0.5 / a_left)


def fit_errors(distance, curve, samples, vectors, f_limit):
    """Relative errors of Eq. (12) against the curves that it stands for.

    The energy e is one of the four numbers that fix a law: its error is rounding.

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
