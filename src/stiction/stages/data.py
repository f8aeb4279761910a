"""Labelled datasets: every population and every file is built and read here."""

import contextlib
import json
import os
import uuid
from pathlib import Path

import numpy as np
import xarray as xr

VECTOR = ("adhesion_energy", "pull_off", "pull_off_distance", "limit_distance")
VECTOR_UNITS = ("J m-2", "Pa", "m", "m")

#: End states of a beam, in the order of :class:`stiction.beam.cantilever.EndState`.
STATES = ("S-shape", "arc", "free")


class DataError(RuntimeError):
    """A file that is not the result it is taken for; the message says what to do."""


def save(dataset, path, stage, settings):
    """Write a dataset whole or not at all, with its stage, its name and the settings that made it.

    Parameters
    ----------
    dataset : xarray.Dataset
    path : path
    stage : str
        Name of the stage; :func:`load` checks it, and that the file still has the name under which it was written.
    settings : dict
        Plain numbers, texts, lists and dicts; neither time nor machine, so that equal settings give equal files.

    Raises
    ------
    DataError
        If the disk is full or the folder cannot be written.
    """
    path = Path(path)
    origin = {"stage": stage, "name": path.stem, "settings": json.dumps(settings, sort_keys=True)}
    labelled = dataset.assign_attrs(Conventions="CF-1.10", **origin)
    encoding = {name: {"zlib": True, "complevel": 1} for name, values in labelled.items() if values.size > 10_000}
    with _replacing(path) as draft:
        draft.write_bytes(bytes(labelled.nbytes + 2**16))  # a full disk is told here; HDF5 would fail without a reason
        labelled.to_netcdf(draft, engine="netcdf4", encoding=encoding)


def load(path, stage):
    """Read a whole dataset of a stage into memory.

    Raises
    ------
    DataError
        If the file is truncated, foreign, of another stage or of another case.
    """
    wanted = stage, Path(path).stem
    try:
        with xr.open_dataset(path, engine="netcdf4") as dataset:
            found = dataset.attrs.get("stage"), dataset.attrs.get("name")
            loaded = dataset.load()
    except (OSError, ValueError, RuntimeError) as error:
        raise DataError(
            f"{path} cannot be read ({error}); delete it and start again, it will be computed anew"
        ) from error
    if found != wanted:
        held = "{} of {}".format(*found) if all(found) else "no result of this study"
        raise DataError(f"{path} holds {held}, not {stage} of {wanted[1]}; delete it and start again")
    return loaded


def save_text(text, path):
    """Write a text file whole or not at all; raises as :func:`save`."""
    with _replacing(Path(path)) as draft:
        draft.write_text(text, encoding="utf-8")


@contextlib.contextmanager
def _replacing(path):
    """A draft beside the target that takes its place when all is written, and vanishes on an error."""
    draft = path.with_name(f".{path.name}.{uuid.uuid4().hex}")
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        for left in path.parent.glob(f".{path.name}.*"):  # by a run that was killed
            left.unlink(missing_ok=True)
        draft.touch()
    except OSError as error:
        raise DataError(f"folder {path.parent} cannot be written ({error}); make it writable") from error
    try:
        yield draft
        with draft.open("rb") as file:
            os.fsync(file.fileno())  # else a power cut can leave the name without the content
        draft.replace(path)
    except (OSError, RuntimeError) as error:
        raise DataError(f"{path} cannot be written ({error}); is the disk full?") from error
    finally:
        draft.unlink(missing_ok=True)


def save_bytes(content, path):
    """Write a binary file whole or not at all; raises as :func:`save`."""
    with _replacing(Path(path)) as draft:
        draft.write_bytes(content)


def heights(density, moments):
    """Stage heights: the maximum-entropy density of one surface.

    Parameters
    ----------
    density : HeightDensity
    moments : dict
        rms [m], skewness, kurtosis.
    """
    z = np.linspace(-6, 6, 601)
    return xr.Dataset(
        {
            "multiplier": (
                "order",
                list(density.multipliers),
                {"units": "1", "long_name": "λ of Eq. (3), standardised heights"},
            ),
            "density": (
                "height",
                density(z),
                {"units": "1", "long_name": "probability density of the standardised height"},
            ),
            "rms": ((), moments["rms"], {"units": "m"}),
            "skewness": ((), moments["skewness"], {"units": "1"}),
            "kurtosis": ((), moments["kurtosis"], {"units": "1"}),
        },
        coords={"order": [1, 2, 3, 4], "height": ("height", z, {"units": "1"})},
    )


def parameters(spectrum):
    """The four parameters of Eq. (7)."""
    units = {"plateau": "m4", "floor": "m4", "corner": "rad m-1", "cutoff": "rad m-1"}
    return xr.Dataset({name: ((), getattr(spectrum, name), {"units": unit}) for name, unit in units.items()})


def identification(found, target):
    """Stage identification: parameters of Eq. (7), simulated summit statistics and those asked for."""
    return parameters(found.spectrum).assign(
        mean_radius=((), found.mean_radius, {"units": "m"}),
        mean_radius_error=((), found.mean_radius_error, {"units": "m"}),
        summit_density=((), found.density, {"units": "m-2"}),
        summit_density_error=((), found.density_error, {"units": "m-2"}),
        target_mean_radius=((), target.mean_radius, {"units": "m"}),
        target_summit_density=((), target.density, {"units": "m-2"}),
        target_rms=((), target.rms, {"units": "m"}),
        evaluations=((), found.evaluations),
    )


def spectrum(target, underlying, achieved, defect):
    """Stage spectrum: Eq. (7), the spectrum of the Gaussian field behind it and the one that the heights get.

    The three spectra are of unit variance, at the wave numbers of ``underlying``.
    """
    zeta = underlying.wavenumber
    unit = {"units": "m2"}
    return parameters(target).assign(
        target=("wavenumber", target(zeta) / target.variance, unit),
        underlying=("wavenumber", underlying.density, unit),
        achieved=("wavenumber", achieved(zeta), unit),
        defect=((), defect, {"units": "1", "long_name": "share of the variance that no Gaussian field provides"}),
        wavenumber=("wavenumber", zeta, {"units": "rad m-1"}),
    )


def character(strips, fields, summits, patch):
    """Stage character: what simulated surfaces look like.

    Parameters
    ----------
    strips : dict
        Per strip: powers of the heights (n, 4) [m^k], summit_density (n,) [m⁻²], mean_curvature (n,) [m⁻¹].
    fields : tuple
        Wave numbers (n_ζ,) [rad m⁻¹] and periodograms of periodic fields (n_f, n_ζ) [m⁴].
    summits : tuple
        Heights [m] and curvatures [m⁻¹] of some summits, (n_s,) each.
    patch : tuple
        Spacing [m] and heights [m] of one patch, (n_x, n_y).
    """
    wavenumber, periodogram = fields
    spacing, heights = patch
    x, y = (("m", np.arange(n) * spacing) for n in heights.shape)
    return xr.Dataset(
        {
            "power": (("strip", "order"), strips["power"], {"units": "m^order", "long_name": "mean of z^order"}),
            "summit_density": ("strip", strips["summit_density"], {"units": "m-2"}),
            "mean_curvature": ("strip", strips["mean_curvature"], {"units": "m-1"}),
            "periodogram": (("field", "wavenumber"), periodogram, {"units": "m4"}),
            "summit_height": ("summit", np.asarray(summits[0], np.float32), {"units": "m"}),
            "summit_curvature": ("summit", np.asarray(summits[1], np.float32), {"units": "m-1"}),
            "elevation": (("x", "y"), np.asarray(heights, np.float32), {"units": "m"}),
        },
        coords={
            "order": [1, 2, 3, 4],
            "wavenumber": ("wavenumber", wavenumber, {"units": "rad m-1"}),
            "x": ("x", x[1], {"units": x[0]}),
            "y": ("y", y[1], {"units": y[0]}),
        },
    )


def contact(solid_pressure, bearing_area, grid, samples):
    """Stage contact: p_s(sample, distance) and A(sample, height), free of humidity; float32.

    Parameters
    ----------
    solid_pressure, bearing_area : (n, n_solid), (n, n_bearing) arrays
        [Pa], [-].
    grid : DistanceGrid
    samples : range
        Number of each sample in the study.
    """
    return xr.Dataset(
        {
            "solid_pressure": (("sample", "distance"), np.asarray(solid_pressure, np.float32), {"units": "Pa"}),
            "bearing_area": (("sample", "height"), np.asarray(bearing_area, np.float32), {"units": "1"}),
            "step": ((), grid.step, {"units": "m"}),
        },
        coords={
            "sample": np.asarray(samples, np.int32),
            "distance": ("distance", grid.solid, {"units": "m"}),
            "height": ("height", grid.bearing, {"units": "m"}),
        },
    )


def forces(vectors, limit, distance, curves):
    """Stage forces: vectors v(sample, component) of Eq. (11), f_limit, and the first few curves.

    Parameters
    ----------
    vectors : (n, 4) array
        [SI].
    limit : float
        Pressure f_limit [Pa].
    distance : (n_d,) array
        [m]
    curves : (k, n_d) array
        Forces of the first k samples [Pa].
    """
    named = {
        name: ("sample", vectors[:, i], {"units": unit})
        for i, (name, unit) in enumerate(zip(VECTOR, VECTOR_UNITS, strict=True))
    }
    return xr.Dataset(
        named
        | {
            "limit": ((), limit, {"units": "Pa"}),
            "force": (("curve", "distance"), np.asarray(curves, np.float32), {"units": "Pa"}),
        },
        coords={"distance": ("distance", distance, {"units": "m"})},
    )


def vectors(dataset):
    """Vectors v of stage forces, (n, 4) [SI]."""
    return np.column_stack([dataset[name].values for name in VECTOR])


def chaos(model, report, rejected):
    """Stage chaos: the chaos model of the vector v of one case and how it compares with its input.

    Parameters
    ----------
    model : ChaosModel
    report : tuple
        Statistics (3, 4, 4) and correlations (3, 4, 4) by source: input, kernel density, chaos.
    rejected : float
        Share of draws without a force law [-].
    """
    coordinates = model.coordinates
    statistics, correlations = report
    return xr.Dataset(
        {
            "coefficient": (("eta", "term"), model.coefficients),
            "multi_index": (("term", "eta"), model.indices),
            "scale": ("component", coordinates.scale),
            "mean": ("component", coordinates.mean),
            "variance": ("axis", coordinates.variances),
            "axes": (("component", "axis"), coordinates.axes),
            "limit": ((), model.f_limit, {"units": "Pa"}),
            "dimension_error": ("axis", model.dimension_error, {"long_name": "Err_DR if this many axes are kept"}),
            "truncation_error": ("eta", model.truncation_error),
            "rejected": ((), rejected, {"long_name": "share of draws without a force law"}),
            "statistics": (("source", "statistic", "component"), statistics, {"units": "SI"}),
            "correlation": (("source", "component", "other"), correlations),
        },
        coords={
            "component": list(VECTOR),
            "other": list(VECTOR),
            "axis": [1, 2, 3, 4],
            "source": ["input", "kernels", "chaos"],
            "statistic": ["mean", "standard deviation", "1 % quantile", "99 % quantile"],
        },
    )


def beams(columns, nodes):
    """Stage beams: how every beam of a case ended, and the shapes of the first ones.

    Parameters
    ----------
    columns : dict
        Arrays of :func:`stiction.beam.montecarlo.columns`.
    nodes : (n,) array
        Nominal positions of the nodes [m].
    """
    flags = {"flag_values": np.arange(3, dtype=np.int8), "flag_meanings": " ".join(STATES)}
    return xr.Dataset(
        {
            "state": ("sample", np.asarray(columns["state"], np.int8), flags),
            "crack_length": ("sample", columns["crack_length"], {"units": "m"}),
            "adhesion_energy": ("sample", columns["energy"], {"units": "J m-2", "long_name": "Eq. (13), S-shape only"}),
            "imbalance": ("sample", columns["imbalance"], {"units": "N"}),
            "iterations": ("sample", columns["iterations"]),
            "deflection": (("beam", "node"), np.asarray(columns["deflection"], np.float32), {"units": "m"}),
        },
        coords={"sample": columns["sample"], "node": ("node", nodes, {"units": "m"})},
    )


def ended(beams, state):
    """Which beams of a dataset of stage beams ended as ``S-shape``, ``arc`` or ``free``; (n,) bool."""
    return beams.state.values == STATES.index(state)
