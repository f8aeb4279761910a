"""Labelled datasets of the studies beside the main line: Figs. 4, 5, 13, 15 to 19, choices of the model."""

import numpy as np
import xarray as xr

from stiction.estimates import mean_with_error

STATISTICS = ("mean", "standard deviation")


def sensitivity(energies, at, estimate, humidities):
    """Adhesion energies at two values of one moment, and what follows for their mean and standard deviation.

    Parameters
    ----------
    energies : (2, n_rh, m) array
        [J m⁻²].
    at : (2,) array
        The values of the moment [SI].
    estimate : tuple
        Normalised slopes and standard errors, (2, n_rh) each [-].
    humidities : sequence
        [-]
    """
    slopes, errors = estimate
    return xr.Dataset(
        {
            "adhesion_energy": (("moment", "humidity", "sample"), energies, {"units": "J m-2"}),
            "slope": (("statistic", "humidity"), slopes, {"units": "1", "long_name": "(|x|/y) dy/dx"}),
            "standard_error": (("statistic", "humidity"), errors, {"units": "1"}),
        },
        coords={"moment": list(at), "humidity": list(humidities), "statistic": list(STATISTICS)},
    )


def plasticity(summits, share, distance):
    """Stress of every touching summit and the share of the contact area that yields.

    Parameters
    ----------
    summits : dict
        interference [m], radius [m], stress [Pa], strip, (n,) each.
    share : tuple
        A_P / A and its standard error [-].
    distance : float
        Between the mean planes [m].
    """
    units = {"interference": "m", "radius": "m", "stress": "Pa"}
    columns = {name: ("summit", np.asarray(summits[name], np.float32), {"units": unit}) for name, unit in units.items()}
    return xr.Dataset(
        columns
        | {
            "strip": ("summit", np.asarray(summits["strip"], np.int32)),
            "plastic_share": ((), share[0], {"units": "1", "long_name": "A_P / A"}),
            "plastic_share_error": ((), share[1], {"units": "1"}),
            "separation": ((), distance, {"units": "m"}),
        }
    )


def sample_sizes(energy, density, sizes, distances):
    """Convergence of the density of ē in the number of samples.

    Parameters
    ----------
    energy : (n_e,) array
        Where the density is given [J m⁻²].
    density : (n_m, n_e) array
        [m² J⁻¹]
    sizes : (n_m,) sequence
        Numbers of samples.
    distances : (n_m, 2) array
        Kolmogorov's distance to all samples and its standard error [-].
    """
    values, errors = np.transpose(distances)
    return xr.Dataset(
        {
            "density": (("size", "energy"), density, {"units": "m2 J-1"}),
            "distance": ("size", values, {"units": "1", "long_name": "Kolmogorov's distance to all samples"}),
            "distance_error": ("size", errors, {"units": "1"}),
        },
        coords={"size": list(sizes), "energy": ("energy", energy, {"units": "J m-2"})},
    )


def orders(edges, input_density, densities, distances, samples, converged):
    """Marginals of η drawn from polynomials of increasing order.

    Parameters
    ----------
    edges : (n + 1,) array
        Of the bins of η [-].
    input_density : (N_g, n) array
        Of the samples [-].
    densities : (N_d, N_g, n) array
        Of the draws, for total orders 1 ... N_d [-].
    distances : (2, N_d, N_g) array
        Kolmogorov's distance of the draws to the kernel density and to the samples [-].
    samples : int
        Number m of samples.
    converged : (N_g,) sequence
        Order from which on a marginal cannot be told from the kernel density with ``samples`` draws; 0 if none.
    """
    count = len(densities)
    return xr.Dataset(
        {
            "density": (("order", "eta", "position"), densities),
            "input_density": (("eta", "position"), input_density),
            "distance": (("target", "order", "eta"), distances, {"long_name": "Kolmogorov's distance"}),
            "samples": ((), samples),
            "converged_order": ("eta", list(converged), {"long_name": "0 if not converged"}),
        },
        coords={
            "order": np.arange(1, count + 1),
            "eta": np.arange(1, len(input_density) + 1),
            "target": ["kernels", "input"],
            "position": 0.5 * (edges[1:] + edges[:-1]),
        },
    )


def mesh(meshes, arrests, law, curve):
    """Crack on uniform ground under meshes of several finenesses.

    Parameters
    ----------
    meshes : sequence of pairs
        Length of the elements and distance of the contact points [m].
    arrests : sequence of Arrest
    law : (4,) array
        Law of the ground, Eq. (12) [SI].
    curve : tuple
        Distance (n_d,) [m] and force (n_d,) [Pa] of the sample that the law stands for.
    """
    elements, points = np.transpose(meshes)
    distance, force = curve
    return xr.Dataset(
        {
            "element_length": ("mesh", elements, {"units": "m"}),
            "point_distance": ("mesh", points, {"units": "m", "long_name": "l_meso"}),
            "crack_length": ("mesh", [a.crack_length for a in arrests], {"units": "m"}),
            "energy": ("mesh", [a.energy for a in arrests], {"units": "J m-2", "long_name": "Eq. (13)"}),
            "law": ("coefficient", law, {"units": "SI"}),
            "force": ("distance", force, {"units": "Pa"}),
        },
        coords={
            "coefficient": ["f_max", "d_max", "a_left", "a_right"],
            "distance": ("distance", distance, {"units": "m"}),
        },
    )


def correlation(surfaces, lag, correlations, lengths):
    """Normalised autocorrelation of surfaces and their correlation lengths.

    Parameters
    ----------
    surfaces : sequence of str
    lag : (n,) array
        [m]
    correlations : (n_s, n) array
        [-]
    lengths : (n_s,) array
        [m]
    """
    return xr.Dataset(
        {
            "autocorrelation": (("surface", "lag"), correlations, {"units": "1"}),
            "correlation_length": ("surface", lengths, {"units": "m", "long_name": "r_Z < 0.01 m₂ beyond"}),
        },
        coords={"surface": list(surfaces), "lag": ("lag", lag, {"units": "m"})},
    )


def reading(humidities, energies, beams):
    """Crack lengths of a pair under one reading of the paper.

    Parameters
    ----------
    humidities : sequence
        [-]
    energies : (n_rh, m) array
        Of the sampled pairs [J m⁻²].
    beams : sequence of n_rh dicts
        Arrays of :func:`stiction.beam.montecarlo.columns`.
    """
    return xr.Dataset(
        {
            "adhesion_energy": (("humidity", "sample"), energies, {"units": "J m-2"}),
            "crack_length": (("humidity", "beam"), [b["crack_length"] for b in beams], {"units": "m"}),
            "state": (("humidity", "beam"), np.array([b["state"] for b in beams], np.int8)),
        },
        coords={"humidity": list(humidities)},
    )


def iteration(rings, steps, misfits):
    """Stage iteration: the spectra of the algorithm of Fig. 4, of unit variance, and how far they are from the target.

    Parameters
    ----------
    rings : tuple
        Wave numbers (n,) [rad m⁻¹] and the target on them (n,) [m²].
    steps : tuple
        Per iteration: Gaussian spectra (k, n) and periodograms of translated fields (k, fields, n) [m²].
    misfits : dict
        Mean error |ln(s / s_Z)| of a ring: misfit of the estimated spectra (k,), sampling_misfit of right ones
        (k,), closed_form_misfit [-].
    """
    (wavenumber, target), (underlying, periodogram) = rings, steps
    unit, mean = {"units": "m2"}, {"units": "1", "long_name": "mean error |ln(s / s_Z)| of a ring"}
    return xr.Dataset(
        {
            "target": ("wavenumber", target, unit),
            "underlying": (("iteration", "wavenumber"), underlying, unit),
            "periodogram": (("iteration", "field", "wavenumber"), periodogram, unit),
        }
        | {name: (("iteration",)[: np.ndim(values)], values, mean) for name, values in misfits.items()},
        coords={
            "iteration": np.arange(1, len(underlying) + 1),
            "wavenumber": ("wavenumber", wavenumber, {"units": "rad m-1"}),
        },
    )


def fit(samples, errors, total):
    """Stage fit: relative errors of Eq. (12) against the curves of those samples that have a law.

    Parameters
    ----------
    samples : (n,) array
        Numbers of the samples with a law, out of ``total``.
    errors : tuple
        Errors of curve and energy (n,) each [-].
    total : int
    """
    names = {"curve_error": "of the curve for d >= d_limit, root mean square", "energy_error": "of the adhesion energy"}
    columns = zip(names.items(), errors, strict=True)
    return xr.Dataset(
        {name: ("sample", error, {"units": "1", "long_name": f"relative error {of}"}) for (name, of), error in columns}
        | {
            "without_law": ((), 1 - len(samples) / total, {"units": "1", "long_name": "share of samples without a law"})
        },
        coords={"sample": samples},
    )


def resampling(columns):
    """Study resampling: how every beam on laws of the samples themselves ended; as `stiction.stages.data.beams`."""
    return xr.Dataset(
        {
            "state": ("sample", np.asarray(columns["state"], np.int8)),
            "crack_length": ("sample", columns["crack_length"], {"units": "m"}),
        },
        coords={"sample": columns["sample"]},
    )


def humidity_axis(humidity, probabilities, energies):
    """Stage humidity: distribution of the adhesion energy e over the samples, along the relative humidity.

    Parameters
    ----------
    humidity : (n,) array
        [-]
    probabilities : (k,) array
        Of the quantiles kept [-].
    energies : (n, m) array
        Energies of all samples [J m⁻²].
    """
    unit = {"units": "J m-2"}
    mean, error = mean_with_error(energies.T)
    return xr.Dataset(
        {
            "energy_mean": ("humidity", mean, unit),
            "energy_mean_error": ("humidity", error, unit | {"long_name": "standard error of the mean"}),
            "energy_quantile": (("probability", "humidity"), np.quantile(energies, probabilities, axis=1), unit),
        },
        coords={
            "humidity": ("humidity", humidity, {"units": "1"}),
            "probability": ("probability", probabilities, {"units": "1"}),
        },
    )
