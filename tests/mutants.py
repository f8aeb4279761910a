"""Mutation testing: introduce small errors into the code and count those that no test detects.

    python tests/mutants.py [module ...]

Each mutant is one replacement in one module of a copy of the project, on which the tests of that module run until the
first fails. Each mutant has a separate cache of compiled code, so that no faulty kernel is reused.
"""

import argparse
import os
import shutil
import subprocess
import sys
import tempfile
import time
from concurrent.futures import ThreadPoolExecutor, as_completed
from pathlib import Path
from queue import Queue

ROOT = Path(__file__).parents[1]
#: A mutant counts as detected if its tests take this many times as long as without it, and at least that long [s].
PATIENCE = 4, 120

#: Tests of modules that have no test file of their name: names of test files are unique.
TESTS = {
    "chaos.model": "chaos/test_chaos_model.py",
    "report.tables_surfaces": "report",
    "report.tables_beams": "report",
    "report.tables_studies": "report",
    "report.style": "report",
    "beam.equilibrium": "beam",
    "beam.energy": "beam",
    "beam.release": "beam",
    "report.figures_beams": "report/test_style.py",
    "run.atomic": "stages/test_storage.py",
    "run.labels": "run/test_kept.py",
    "stages.curves": "stages/test_stage_curves.py",
    "stages.pairs": "stages/test_stage_pairs.py",
    "stages.named": "stages/test_storage.py",
    "config.merging": "config/test_files.py",
    "models": "config/test_plan.py",
    "scans.scan": "scans/test_surface_estimate.py",
    "scans.reading": "scans/test_scan_reading.py",
    "scans.estimate": "scans/test_surface_estimate.py",
}
#: Stages and studies whose tests are in one file each.
STAGES = "parameters heights spectrum surfaces identification character forces chaos releases beams cantilevers"
STUDIES = "sensitivity_contact sensitivity plasticity fit humidity iteration sample_sizes orders mesh correlation"
STUDIES += " resampling variant variant_contact"
TESTS |= {f"stages.{name}": "stages/test_stages.py" for name in STAGES.split()}
TESTS |= {f"studies.{name}": "studies/test_studies.py" for name in STUDIES.split()}

#: Modules and their replacements (text that occurs exactly once, its replacement).
MUTANTS = {
    "surface.maxent": [
        ("return np.exp(-exponent)", "return np.exp(exponent)"),
        ("_HEIGHTS**order * self", "_HEIGHTS**(order + 1) * self"),
        ("0.5 * (self(_HEIGHTS[1:])", "0.6 * (self(_HEIGHTS[1:])"),
        ("-ndtri_exp(np.minimum(above, 0))", "ndtri_exp(np.minimum(above, 0))"),
        ("GAUSSIAN = HeightDensity((0.0, 0.5,", "GAUSSIAN = HeightDensity((0.0, 0.6,"),
        ("kurtosis > skewness**2 + 1:", "kurtosis > skewness**2:"),
        ("- np.outer(moments, moments)", "+ np.outer(moments, moments)"),
        ("largest + np.log(total * _STEP)", "largest + np.log(total)"),
        (".max() < _FARTHEST_MODE", ".max() < 100 * _FARTHEST_MODE"),
        ("known[0]) | (score > known[-1])", "known[0]) | (score > 2 * known[-1])"),
    ],
    "surface.feasible": [
        ("-2 * np.log(0.05)", "-np.log(0.05)"),
        ("return float(low)", "return float(high) + 0.01"),
        ("np.diag([6.0, 24.0])", "np.diag([24.0, 6.0])"),
        ("/ heights\n", "/ np.sqrt(heights)\n"),
        ("return Moments(skewness, kurtosis, 0.0)", "return Moments(skewness, min(kurtosis, 3.0), 0.0)"),
        ("inverse = np.linalg.inv(covariance)", "inverse = np.diag(1 / errors**2)"),
        ("np.sqrt(off @ inverse @ off)", "off @ inverse @ off"),
        (
            "best = minimize_scalar(\n        lambda trial: on_border(trial).distance",
            "best = minimize_scalar(\n        lambda trial: -on_border(trial).distance",
        ),
        ("if found.distance > LARGEST_DISTANCE", "if found.distance > 100 * LARGEST_DISTANCE"),
        ("np.array([-LARGEST_SCORE, LARGEST_SCORE])", "np.array([-5.0, 5.0])"),
        ("        _solve(skewness, kurtosis)  # raises", "        pass  # raises"),
    ],
    "beam.foundation": [
        ("STRIP, ELEMENT = 0.7, 2.2", "STRIP, ELEMENT = 1.0, 2.2"),
        ("STRIP, ELEMENT = 0.7, 2.2", "STRIP, ELEMENT = 0.7, 3.5"),
        ("(4 * bending / stiffness) ** 0.25", "(bending / stiffness) ** 0.25"),
        ("return 4 * a_left * f_max", "return 2 * a_left * f_max"),
        ("np.mean(ground_stiffness", "np.max(ground_stiffness"),
    ],
    "beam.resolution": [
        ("if strip > allowed:", "if False:"),
        ("allowed = min(STRIP * length, element)", "allowed = element"),
        ("element = min(ELEMENT * length, start / ALONG_START)", "element = ELEMENT * length"),
        ("element = min(ELEMENT * length, start / ALONG_START)", "element = start / ALONG_START"),
        ("range(beam.elements, points + 1)", "range(1, points + 1)"),
        ("if points % n == 0 and", "if"),
        (
            "arrest_length(forcelaw.energy(laws).mean(), beam), beam.length)",
            "arrest_length(forcelaw.energy(laws).mean(), beam), np.inf)",
        ),
    ],
    "contact.bounds": [
        ("heights > highest - height", "heights > highest + height"),
        ("tension * float", "0.5 * tension * float"),
        ("np.log(1 + np.sqrt(2)) / highest", "np.log(1 + np.sqrt(3)) / highest"),
    ],
    "surface.spectrum": [
        ("np.log(self.floor / self.plateau)", "np.log(self.plateau / self.floor)"),
        ("np.maximum(wavenumber / self.corner, 1.0)", "np.maximum(wavenumber / self.corner, 0.9)"),
        ("power = order + 2", "power = order + 1"),
        ("exponent = power + self.slope", "exponent = power - self.slope"),
        ("return 2 * np.pi * self.moment(0)", "return np.pi * self.moment(0)"),
        ("m4 / (6 * np.pi * np.sqrt(3) * m2)", "m4 / (6 * np.pi * np.sqrt(3 * m2))"),
        ("0.75 * np.pi * self.spectrum.moment(4)", "0.5 * np.pi * self.spectrum.moment(4)"),
        ("8 / 3 * np.sqrt(", "4 / 3 * np.sqrt("),
        ("weights[[0, -1]] /= 2", "weights[[0, -1]] *= 2"),
        ("@ (weights * zeta * spectrum(zeta))", "@ (weights * spectrum(zeta))"),
        ("[-1]\n    if last", "[0]\n    if last"),
        ("step * np.arange(1, rings + 1)", "step * np.arange(rings)"),
        ("_rings(len(values))[counted]", "_rings(len(values))[~counted]"),
    ],
    "surface.translation": [
        ("np.sqrt(k - 1) * previous", "np.sqrt(k) * previous"),
        ("previous) / np.sqrt(k)", "previous) / np.sqrt(k + 1)"),
        ("power = self.hermite_coefficients**2", "power = np.abs(self.hermite_coefficients)"),
        ("np.exp(-(_SCORES**2) / 2)", "np.exp(-(_SCORES**2))"),
        ("rho -= error /", "rho += error /"),
        ("lowest = self.autocorrelation(-1.0)", "lowest = self.autocorrelation(1.0)"),
    ],
    "surface.normals": [
        ("_TAIL * np.exp(-(_TAIL**2) / 2) + ", "_TAIL * np.exp(-(_TAIL**2) / 2) - "),
        ("(c << uint64(24)) | (c >> uint64(40))", "(c << uint64(23)) | (c >> uint64(41))"),
        ("counter + uint64(1), True", "counter + uint64(2), True"),
        ("float32(bits >> uint32(8))", "float32(bits >> uint32(9))"),
        ("excess = float32(-1 / _TAIL)", "excess = float32(-2 / _TAIL)"),
        ("if steps & uint32(0x100)", "if steps & uint32(0x200)"),
        ("(_DENSITY[layer - 1] - _DENSITY[layer])", "(_DENSITY[layer] - _DENSITY[layer - 1])"),
        ("if steps >= _INSIDE[layer]", "if steps > _INSIDE[layer]"),
        ("x = -x if bits & uint32(_LAYERS)", "x = -x if bits & uint32(2 * _LAYERS)"),
        ('state | {"has_uint32": int(held), "uinteger"', 'state | {"has_uint32": 0, "uinteger"'),
    ],
    "surface.field": [
        ("np.where(k2 == 0, 1.0, 0.5)", "np.where(k2 == 0, 1.0, 1.0)"),
        ("np.where(k2 == 0, 1, 4)", "np.where(k2 == 0, 1, 2)"),
        ("(self.rms * self.translation.table)", "(self.rms**2 * self.translation.table)"),
        ("(table[k + np.uint32(1)] - table[k])", "(table[k] - table[k + np.uint32(1)])"),
        ("scores[j] * scale + offset", "scores[j] * scale - offset"),
        ("heights[j] += table[k]", "heights[j] = table[k]"),
        ("normals[2 * k + 1] * amplitude[k]", "normals[2 * k] * amplitude[k]"),
        ("** 2 / step**2, step)", "** 2 / step, step)"),
        ("step = 2 * np.pi / (len(heights) * spacing)", "step = np.pi / (len(heights) * spacing)"),
    ],
    "surface.summits": [
        ("(h > above[j + 1])", "(h > above[j])"),
        ("sides = (h > row[j - 1])", "sides = (h >= row[j - 1])"),
        ("(4 * h - z", "(3 * h - z"),
        ("/ (2 * spacing * spacing)", "/ (spacing * spacing)"),
        ("count / (inner * spacing**2)", "count / (z.size * spacing**2)"),
        ("range(1, z.shape[1] - 1)", "range(1, z.shape[1] - 2)"),
    ],
    "surface.identify": [
        ("return np.pi / self.spacing", "return 2 * np.pi / self.spacing"),
        ("(target.cutoff / corner) ** -slope", "(target.cutoff / corner) ** slope"),
        ("target.rms**2 / shape.variance", "target.rms / shape.variance"),
        ("radius / target.mean_radius, density", "1 / target.mean_radius, density"),
        ("density * curvature.mean()", "density / curvature.mean()"),
        ("if not fit.success", "if False"),
        ("if key not in known", "if True"),
    ],
    "surface.iteration": [
        ("spectrum.density * wanted / periodograms", "spectrum.density * periodograms"),
        ("(square.sum() * step**2)", "square.sum()"),
        ("np.sqrt(2 / np.pi /", "np.sqrt(2 /"),
    ],
    "scans.scan": [
        ("heights.shape) < FEWEST_POINTS", "heights.shape) < 8 * FEWEST_POINTS"),
        ("self.size[1] / self.shape[1]", "self.size[1] / self.shape[0]"),
        ("return 1 - float(", "return float("),
        ("self.size[0] * self.size[1]", "self.size[0] ** 2 * self.size[1]"),
    ],
    "scans.reading": [
        ("UNITS[unit] * _heights", "_heights"),
        ("heights, size = heights.T, size[::-1]", "heights = heights.T"),
        ("if not first:", "if False:"),
        ('warnings.simplefilter("ignore")', "pass"),
        ("logging.disable(logging.CRITICAL)", "pass"),
        ("if reader.format() in _WITHOUT_MAGIC and", "if False and"),
        ("bool(words & _HEIGHT) and words <=", "bool(words & _HEIGHT) or words <="),
        ("or _unit_of(channel) in UNITS)", "or True)"),
        ("_words(channel.name) - _DIRECTION)", "_words(channel.name))"),
        ("len(channels) == 1 and _NAMELESS", "len(channels) >= 1 and _NAMELESS"),
        ("if stored is not None and stored not in UNITS", "if False"),
        ("UNITS[stored] != UNITS[source.height_unit]", "stored == source.height_unit"),
        ("if channel.dim != 2", "if False"),
        ("rtol=_SAME_SIZE, atol=0", "rtol=0, atol=0"),
        ("np.ma.filled(np.ma.asarray(heights, dtype=float), np.nan)", "np.asarray(heights, dtype=float)"),
        ("known[1] in (None, str(channel.index))", "True"),
        ("not in _NOT_LEVELLED", "in _NOT_LEVELLED"),
        ("0 < len(line) <= _LONGEST_REASON", "True"),
    ],
    "scans.levelling": [
        ("for b in range(degree + 1 - a)", "for b in range(degree + 1)"),
        ('LEVELS = {"mean": 0, "plane": 1, "quadratic": 2}', 'LEVELS = {"mean": 0, "plane": 2, "quadratic": 2}'),
        ("np.where(defined, heights, 0.0)", "np.nan_to_num(heights, nan=1.0)"),
        ("(products.T @ defined)", "(products.T @ np.ones_like(defined))"),
        ("basis = _legendre(len(heights), degree)", "basis = _legendre(len(heights), degree + 1)[:, 1:]"),
        ("axis=axis), axis=1 - axis", "axis=1 - axis), axis=1 - axis"),
    ],
    "scans.moments": [
        ("[np.isfinite(heights)]", "[np.isfinite(heights) & (heights != 0)][1:]"),
        ("m2 = p2 - m1**2", "m2 = p2"),
        ("+ 2 * m1**3", "- 2 * m1**3"),
        ("+ 6 * m1**2 * p2", "+ 4 * m1**2 * p2"),
        ("- 3 * first -", "-"),
        ("- 2 * kurtosis * spread", "- kurtosis * spread"),
        ("- 4 * lag * (1 / size[0] + 1 / size[1])", "- 2 * lag * (1 / size[0] + 1 / size[1])"),
        ("+ 2 * lag**2 / (size[0] * size[1])", ""),
        ("(rho / rho[0]) ** np.arange(1, terms + 1)", "(rho / rho[0]) ** np.arange(2, terms + 2)"),
        ("* angle * lag\n", "* angle\n"),
        ("freedom = len(per_scan) - 1", "freedom = len(per_scan)"),
        ("/ np.diag(covariance)", "/ np.sqrt(np.diag(covariance))"),
        ("j * columns : (j + 1) * columns", "i * columns : (i + 1) * columns"),
        ("return jackknife(moments, rows)[1]", "return jackknife(moments, rows)[1] / 2"),
    ],
    "scans.periodogram": [
        ("_TAPERED = 0.5", "_TAPERED = 0.05"),
        ("_SLOW_BAND = 3", "_SLOW_BAND = 0"),
        ("(square * 4 * np.pi**2)", "(square * 2 * np.pi)"),
        ("np.mean(window**2), np.mean(window**4)", "np.mean(window), np.mean(window**4)"),
        ("len(scans) * square**2 / fourth", "len(scans)"),
        ("** 2 for z in scans) / len(scans)", "** 2 for z in scans)"),
        ("np.nan_to_num(z) * window", "np.nan_to_num(z, nan=1e-9) * window"),
        ("count[taken] / 2 *", "count[taken] *"),
        ("radius * min(spectrum.size)", "radius * max(spectrum.size)"),
        ("np.arctan2(second, first)", "np.arctan2(first, second)"),
        ("return first[:, None], second[None, :]", "return second[:, None], first[None, :]"),
    ],
    "scans.whittle": [
        ("_LONGEST_WAVE = 1 / 1.5", "_LONGEST_WAVE = 1.0"),
        ("_SHORTEST_WAVE = 4", "_SHORTEST_WAVE = 2"),
        ("_TIP_SAFETY = 0.5", "_TIP_SAFETY = 1.0"),
        ("nyquist = np.pi / max(pixel)", "nyquist = np.pi / min(pixel)"),
        ("min(high, nyquist, tip)", "min(high, nyquist)"),
        ("2 * z[half:-half] - z[: -2 * half]", "z[half:-half] - z[: -2 * half]"),
        ("max(_peak_curvature(z, half, pixel) for z in scans)", "_peak_curvature(scans[0], half, pixel)"),
        ("self.plateau * (cutoff / self.corner) ** self.slope", "self.plateau * (cutoff / self.corner)"),
        ("np.log(plateau) + np.average(np.log(shape), weights=modes)", "np.log(plateau) + np.average(np.log(shape))"),
        ("if len(wavenumber) < 8", "if False"),
        ("modes * (density / (plateau * shape) - 1) ** 2", "(density / (plateau * shape) - 1) ** 2"),
        ("gradient[0] = 1.0", "pass"),
        ("_NON_GAUSSIAN**2 *", "2 *"),
        ("np.full_like(decay, -slope)", "np.full_like(decay, slope)"),
        (
            "np.interp(np.log(np.maximum(wavenumber, known[0])), np.log(known), np.log(density))",
            "np.log(np.interp(wavenumber, known, density)) + 0.1",
        ),
        ("beyond = slope *", "beyond = 2 * slope *"),
    ],
    "scans.quantiles": [
        ("- z.mean()) / z.std()", "- z.mean()) / z.var()"),
        ("scan[np.isfinite(scan)]", "np.nan_to_num(scan).ravel()"),
        ("slice(None, None, -1)) * above", "slice(None)) * above"),
        ("_SLOPE_RANGE)[0]", "0)[0] + 1"),
        ("np.sqrt(share @ (height - mean) ** 2)", "np.sqrt(share @ height**2)"),
        ("(4 * np.pi**2 * float(spectrum(0.0)))", "(2 * np.pi * float(spectrum(0.0)))"),
        ("if largest < 1:", "if False:"),
        ("_AREAS_BEYOND, _SLOPE_RANGE = 10, 0.5", "_AREAS_BEYOND, _SLOPE_RANGE = 30, 0.5"),
        ("base) - centre) * 2, centre", "base) - centre), centre"),
        ("(1 / scans + 1 / n)", "(1 / scans)"),
        ("difference = residual - model_residuals.mean(axis=0)", "difference = residual"),
        ("(n - size) / (size * (n - 1))", "1 / size"),
        ("model_residuals[np.isfinite(model_residuals).all(axis=1)]", "np.nan_to_num(model_residuals)"),
        ("if is_feasible(skewness, kurtosis)", "if True"),
        ("nearest_feasible(skewness, kurtosis, covariance())", "nearest_feasible(skewness, kurtosis)"),
    ],
    "scans.model_scans": [
        ("+ [np.log(self.rms), 0, 0]", "+ [self.rms, 0, 0]"),
        ("self._points * min(self.frame.pixel) / 2", "self._points * min(self.frame.pixel) / 200"),
        ("spacing, self.correlation)", "spacing, 0.0)"),
        ("np.arange(n) * p / spacing", "np.arange(n)"),
        ("model.rms ** np.arange(1, 5)", "model.rms ** np.arange(4)"),
        ("moments(found) - expected", "moments(found)"),
        ("reshape(groups, scans, -1).mean(axis=1)", "reshape(groups, scans, -1)[:, 0]"),
        ("axis=0) - truth", "axis=0) + truth"),
        ("levelled = level(raw, levelling)", "levelled = raw - raw.mean()"),
        ("density * curvature.mean()", "density * curvature.max()"),
        ("if not frame.square", "if False"),
        ("[per_area[0] / per_area[1], per_area[0]]", "[per_area[1] / per_area[0], per_area[0]]"),
    ],
    "scans.estimate": [
        ("moments(self.powers.mean(axis=0))", "moments(self.powers[0])"),
        ("self.fit.corner * min(self.frame.size)", "self.fit.corner * 10 * min(self.frame.size)"),
        ("self.frame.area * len(self.names)", "self.frame.area"),
        ("scan.undefined_share > settings.undefined_share", "scan.undefined_share > 0.5"),
        ("if scan.frame.shape != first.frame.shape or", "if"),
        ("_SAME_SIZE = 0.01", "_SAME_SIZE = 0.1"),
        ("found.moments - drawn.bias(", "found.moments + drawn.bias("),
        ("covariance=model.covariance / len(scans)", "covariance=model.covariance"),
        ("shift @ compared_slopes", "0 * shift @ compared_slopes"),
        ("if number < ENOUGH_WAVELENGTHS", "if number < 2"),
        ("if ratio > _TILES", "if ratio > 2 * _TILES"),
        ("strict=True) if p < _UNLIKELY]", "strict=True) if p < 0.005]"),
        ("if ratio > _MISFIT", "if ratio > 2 * _MISFIT"),
        ("(np.argmax(found.sectors) + 0.5)", "np.argmax(found.sectors)"),
        ("if within.tip < within.nyquist", "if within.tip < 0"),
        ("if slow > _JUMP * fast", "if slow > 3 * _JUMP * fast"),
        ("if likely < _UNLIKELY", "if likely < 0"),
        ("found.frame, tile)) for z in found.levelled", "found.frame, tile)) for z in found.levelled[:1]"),
        ("modelled.std(axis=0, ddof=1)", "modelled.std(axis=0, ddof=1) / 100"),
    ],
    "analysis.sensitivity": [
        ("moment + abs(moment) * step", "moment + moment * step"),
        ("return np.sign(at[0]) *", "return"),
        ("np.sqrt(second - first**2)", "np.sqrt(second)"),
    ],
    "analysis.plasticity": [
        ("ONSET = 0.6", "ONSET = 1.6"),
        ("np.pi * radius * interference", "2 * np.pi * radius * interference"),
        ("height[reaching] - distance", "height[reaching]"),
        ("yields(stress, hardness)", "yields(stress)"),
    ],
    "stages.pairs": [
        (
            "reduced_modulus(settings.solid.young_modulus, settings.solid.poisson_ratio)",
            "2 * reduced_modulus(settings.solid.young_modulus, settings.solid.poisson_ratio)",
        ),
        ("solid, settings.contact.distance_step", "solid, 2 * settings.contact.distance_step"),
        ('"contact", pair, side, sample', '"contact", pair, "beam", sample'),
    ],
    "estimates": [
        ("/ np.sqrt(len(samples))", "/ len(samples)"),
        ("abs(power * mean * error / centre)", "abs(mean * error / centre)"),
        ("np.sqrt((n - 1) / n *", "np.sqrt((n - 1) *"),
    ],
    "analysis.variants": [
        ("slopes @ common", "np.linalg.norm(slopes * common)"),
        ("return ratio - 1, ratio * error", "return ratio - 1, error"),
        ("both = variant.stuck & base.stuck", "both = variant.stuck"),
        ("2 * (left / total * before - after)", "2 * (left / total * before + after)"),
        ("np.linalg.norm(by_base * own)", "by_base @ own"),
        ("np.abs(by_shift) @ shift", "np.linalg.norm(by_shift * shift)"),
    ],
    "analysis.convergence": [
        ("KOLMOGOROV_MEAN / np.sqrt(samples)", "KOLMOGOROV_MEAN / samples"),
        ("1 / size - 1 / len(samples)", "1 / size"),
        ("first = far[-1] + 1", "first = far[0] + 1"),
    ],
    "analysis.mesh": [
        ("max(2, ceil(2 * beam.length", "max(1, ceil(2 * beam.length"),
        ("ceil(2 * beam.length / points / (STRIP * length))", "ceil(beam.length / points / (STRIP * length))"),
        ("ELEMENT * length) / 2", "ELEMENT * length)"),
        ("self.used.crack_length / self.fine.crack_length - 1", "self.fine.crack_length / self.used.crack_length - 1"),
        ("self.fine.energy / float(energy(self.law))", "self.used.energy / float(energy(self.law))"),
        ("for law in laws) / len(laws)", "for law in laws)"),
        ("!= EndState.S_SHAPE", "== EndState.FREE"),
        ("apparent_adhesion_energy(end.crack_length, beam))", "0.0)"),
        ("if is_multiple(length, e) and is_multiple(e, p)", "if is_multiple(length, e)"),
        ("if is_multiple(length, e) and", "if is_multiple(length, p) and"),
    ],
    "devices.arcs": [
        ("return 1.5 * beam.gap / length", "return beam.gap / length"),
        ("return 3 / 8 * beam.young_modulus", "return 3 / 2 * beam.young_modulus"),
        ("/ energy) ** (1 / 4)", "/ energy) ** (1 / 3)"),
        ("[..., 0] / tip_slope", "[..., 0] * tip_slope"),
        ("(40 / (a_right * rise))", "(1 / (a_right * rise))"),
        ("tip + points))) * strip", "tip + points)))"),
        ("bending = 3 * beam", "bending = 6 * beam"),
    ],
    "devices.bridges": [
        ("if not residual_stress >= 0:", "if residual_stress < -1e7:"),
        ("residual_stress * beam.width * beam.thickness", "residual_stress * beam.width"),
        ("reshape(-1, 2).sum(axis=1)", "reshape(2, -1).sum(axis=0)"),
        ("reshape(-1, 2).sum(axis=1)", "reshape(-1, 2)[:, 0] * 2"),
        ("return 2 * arrest_length", "return arrest_length"),
    ],
    "devices.tail": [
        ("(ranks - 0.375)", "(ranks - 0.0)"),
        ("- slopes * scores.mean(), slopes", ", slopes"),
        ("np.sort(lengths)[: len(scores)]", "np.asarray(lengths)[: len(scores)]"),
        ("if len(scores) < FEWEST", "if len(scores) < 1"),
        ("if not np.isfinite(lowest).all()", "if False"),
        ("rng.gamma(samples + 1 - k", "rng.gamma(samples"),
        ("intercepts + (slopes - 1) * ndtri", "intercepts + slopes * ndtri"),
        ("[errors, errors / slopes]", "[errors, errors]"),
        ("np.exp(self.intercept + self.slope * ndtri(share))", "np.exp(self.intercept - self.slope * ndtri(share))"),
    ],
    "devices.risk": [
        ("crack_lengths + HOLD * foundation", "crack_lengths"),
        ("HOLD * foundation, np.inf)", "HOLD * foundation, 0.0)"),
        ("np.minimum(s_shapes, arcs)", "np.maximum(s_shapes, arcs)"),
        ("samples - 1) + 1.0,", "samples - 1) + 0.5,"),
        ("np.where(stuck < samples, inner, 1.0)", "inner"),
        ('side="left"', 'side="right"'),
        ("two_sided = (1 + CONFIDENCE) / 2", "two_sided = CONFIDENCE / 2"),
        ("np.log(1 - CONFIDENCE)", "np.log(CONFIDENCE)"),
        ("upper_bound(stuck, n) <= share", "stuck <= share * n"),
        ("ordered[allowed[-1]]", "ordered[allowed[-1] + 1]"),
        ("betainc((n + 1) * share,", "betainc(n * share + 1,"),
        ("np.quantile(pivots, CONFIDENCE)", "np.quantile(pivots, 0.5)"),
        ("np.quantile(pivots, CONFIDENCE)", "np.quantile(errors, CONFIDENCE)"),
        ("if share >= VERIFIED and", "if"),
        ("and n * share >= DECADE", ""),
        ("estimate * fitted.slope * errors.std()", "fitted.slope * errors.std()"),
        ("(groups - 1) / groups * np.sum", "1 / groups * np.sum"),
        ("if not 0 < share <= TAIL", "if not 0 < share"),
        ("if n >= samples_for(share):", "if n >= 10 * samples_for(share):"),
    ],
    "devices.stoppers": [
        ("return f_max * area", "return f_max / area"),
        (
            "stuck_share(-np.asarray(restoring_forces), -pull_off)",
            "stuck_share(np.asarray(restoring_forces), pull_off)",
        ),
        ("(rise - bend * before)", "(rise + bend * before)"),
        ("if i in (0, len(x) - 1)", "if i == 0"),
        ("if bend < 0 else", "if bend > 0 else"),
    ],
    "devices.chart": [
        ("gap**self.gap_power", "gap"),
        ("if rank < terms.shape[1]", "if rank < 1"),
        ("np.ptp(dimensions, axis=0) > 1e-9", "np.ptp(dimensions, axis=0) > -1"),
        ("(low, high) in ((", "(high, low) in (("),
        ("np.max(np.abs(law(thickness, gap) / length - 1))", "np.mean(np.abs(law(thickness, gap) / length - 1))"),
        ("gap[~test], length[~test])", "gap[~test], length[test])"),
        ("fit_power_law(thickness[~test]", "fit_power_law(2 * thickness[~test]"),
        ("if error > ALLOWED", "if error > 10 * ALLOWED"),
        (
            "tension * meniscus_height(humidity, temperature, contact_angles)",
            "tension * meniscus_height(humidity, temperature)",
        ),
        (
            "arrest_length(flooded_energy(temperature, contact_angles), beam)",
            "arrest_length(flooded_energy(temperature), beam)",
        ),
    ],
    "devices.budget": [
        ("self.slopes @ self.covariance @ self.slopes", "self.slopes**2 @ np.diag(self.covariance)"),
        (
            "self.slopes[of] @ self.covariance[np.ix_(of, of)] @ self.slopes[of]",
            "self.slopes[of] ** 2 @ np.diag(self.covariance)[of]",
        ),
        ("shared = self.covariance[of] @ self.slopes", "shared = self.covariance[np.ix_(of, of)] @ self.slopes[of]"),
        ("self.total**2 - known", "self.total - known"),
        ("np.linalg.eigvalsh(correlation).min() < -1e-9", "False"),
        ("not np.allclose(correlation, correlation.T) or", ""),
        ("start = end\n", "pass\n"),
        ("np.outer(uncertainties, uncertainties) * correlation", "np.outer(uncertainties, uncertainties)"),
        ("length(less[used])) / step", "length(less[used]))"),
        ("more[used]) / length(less[used])", "more[used]) / length(less)"),
        ("(groups - 1) / groups * np.sum", "np.sum"),
        ("np.log(changed / base)", "np.log(base / changed)"),
        ("key=lambda row: row[2])", "key=lambda row: row[0])"),
    ],
    "devices.limits": [
        ("if strip <= STRIP * foundation and", "if"),
        ("and element <= ELEMENT * foundation", ""),
        ("PLASTIC = 0.02", "PLASTIC = 0.2"),
        ("FILMS = 20.0", "FILMS = 10.0"),
        ("(film + rms):", "film:"),
        ("slope = 1.5 * gap", "slope = 0.75 * gap"),
        ("SLENDER = 20.0", "SLENDER = 10.0"),
        ("6 * gap * width**2", "6 * gap * width"),
        ("if ratio < STRETCH", "if ratio < 2 * STRETCH"),
        ("if strip <= 2 * wedge", "if strip <= 20 * wedge"),
        ("if share == 0:", "if share == 1:"),
        (
            '    if share == 1:\n        return None\n    return (\n        f"Only',
            '    if share == 0:\n        return None\n    return (\n        f"Only',
        ),
        ("if strip > correlation_length", "if strip > 10 * correlation_length"),
        ("if quantity not in stated]", "]"),
        ("        stubby_beam(crack_length, thickness),\n", ""),
    ],
    "contact.meniscus": [
        ("np.log(humidity) / molar_volume", "np.log10(humidity) / molar_volume"),
        ("GAS_CONSTANT * temperature *", "GAS_CONSTANT *"),
        ("return -wetting * kelvin_radius", "return -2 * kelvin_radius"),
        ("np.cos(contact_angles[0]) + np.cos(contact_angles[1])", "2 * np.cos(contact_angles[0])"),
        ("if not wetting > 0", "if not wetting > -1"),
        ("(humidity < 1))", "(humidity <= 1))"),
        ("surface_energy(temperature) / laplace_pressure", "WATER_SURFACE_ENERGY / laplace_pressure"),
        ("(1 - 0.625 * tau)", "(1 - 0.6 * tau)"),
        ("tabulated_density(_REFERENCE) / tabulated_density(temperature)", "1.0"),
        ("_REFERENCE = 300.0", "_REFERENCE = 298.15"),
        ("16.945176", "16.95176"),
    ],
    "contact.vanderwaals": [
        ("(2 / 15) ** (1 / 6)", "(2 / 15) ** (1 / 3)"),
        ("(16 * np.pi *", "(12 * np.pi *"),
        ("0.97 * 2 ** (1 / 6)", "0.97 * 2 ** (1 / 3)"),
        ("self.work_of_adhesion / self.range", "self.work_of_adhesion * self.range"),
        ('if through == "none":', 'if through == "dry":'),
        ("if hamaker_constant is None else hamaker_constant", ""),
    ],
    "contact.asperity": [
        ("(2 * (1 - poisson_ratio**2))", "(2 * (1 + poisson_ratio**2))"),
        ("return 4 / 3 * modulus * np.sqrt(radius)", "return 3 / 4 * modulus * np.sqrt(radius)"),
        ("np.maximum(interference, 0) ** 1.5", "np.maximum(interference, 0) ** 1.4"),
        ("return 2 / np.pi * modulus", "return modulus"),
        ("return 2 * attraction.stress", "return attraction.stress"),
        ("* radius / (4 / 3 * modulus) ** 2", "* radius / (4 / 3 * modulus)"),
        ("(u + (u**2 - 1) * t)", "(u + (u**2 + 1) * t)"),
        ("(u * t - m + 1)", "(u * t - m - 1)"),
        ("load = a**3 - transition", "load = a**3 + transition"),
        ("return load, a**2 - 4 / 3", "return load, a**2 - 2 / 3"),
        ("load = -0.5 * np.pi", "load = -np.pi"),
        ("- 2 / (np.pi * transition)", "+ 2 / (np.pi * transition)"),
        ("0.25 * np.pi * transition, 4", "0.5 * np.pi * transition, 4"),
        ("np.argmin(interference)", "np.argmin(load)"),
        ("float(np.log(high / low) / (n - 1))", "float(np.log(high / low) / n)"),
        ("float(np.pi * self.attraction.work_of_adhesion)", "float(self.attraction.work_of_adhesion)"),
        ("factor = 4 / 3 * modulus / np.sqrt", "factor = 4 / 3 * modulus * np.sqrt"),
        ("overlap = max(heights[i, j] - k * step, 0.0)", "overlap = max(heights[i, j] - (k + 1) * step, 0.0)"),
        ("third = radius ** (1 / 3)", "third = radius ** (1 / 2)"),
        ("share = place - row", "share = 1 - place + row"),
        ("scales.force * radius", "scales.force"),
        (
            "if summits[j] and heights[i, j] > 0:\n                factor",
            "if summits[j] and heights[i, j] > 0.5e-9:\n                factor",
        ),
        ("part * (low[cell + np.uint32(1)] - low[cell])", "(1 - part) * (low[cell + np.uint32(1)] - low[cell])"),
        ("if attraction is None else", "if attraction is not None else"),
        ("before=self.further[0]", "before=self.further[1]"),
        ("row += scales.before", "row += 0"),
        ("row, share = len(snap_off) - 2, 1.0", "row, share = 0, 1.0"),
        ("return a * (a**2 - 2 * transition * width)", "return a * (a**2 - transition * width)"),
        ("width**2 * (width + transition) - 1.5", "width**2 * (width - transition) - 1.5"),
        ("deep_load((top - deep * step) * inverse, transition)", "deep_load(top * inverse, transition)"),
        ("roots[deep:held], load[row]", "roots[:held], load[row]"),
        (
            "if summits[j] and heights[i, j] > 0:\n                sphere",
            "if summits[j] and heights[i, j] > -1e-9:\n                sphere",
        ),
        ("transition = np.exp(scales.log_transition) * third", "transition = np.exp(scales.log_transition)"),
        ("min(1e-2, 0.1 / transition)", "1e-2"),
    ],
    "contact.estimate": [
        ("rms**2 / moments[0] * moment", "rms / moments[0] * moment"),
        ("(3 / 8 / mean_radius) ** 2", "(3 / 8 / mean_radius)"),
        ("np.sqrt(3) * density), m4)", "np.sqrt(3) / density), m4)"),
        ("return 3 / 8 * np.sqrt(np.pi / self.m4)", "return 3 / 8 * np.sqrt(1 / self.m4)"),
        ("return 4 * np.sqrt(self.m0 / (np.pi * alpha))", "return np.sqrt(self.m0 / (np.pi * alpha))"),
        ("(1 - 0.8968 / alpha)", "(1 + 0.8968 / alpha)"),
        ("return surface.summit_density * ", "return "),
        ("ndtr((height - distance) / rms)", "ndtr((distance - height) / rms)"),
        ("float(-curve.min())", "float(curve.max())"),
    ],
    "config.memory": [
        ("_PER_POINT * (1e3 * length_um / spacing_nm)", "_PER_POINT * (1e3 * length_um)"),
        ('config["beam"]["width_um"] + sampling["margin_um"]', 'config["beam"]["width_um"]'),
        ("return max(USUAL, ", "return min(USUAL, "),
        ("for spacing in spacings]", "for spacing in spacings[:1]]"),
    ],
    "contact.solids": [
        ("(2 * other / (one + other))", "(other / (one + other))"),
        ("(2 * other / (one + other))", "(2 * one / (one + other))"),
        ("return min(first.hardness", "return max(first.hardness"),
        ("np.sqrt(medium)) ** 2)", "np.sqrt(medium)) ** 1)"),
        ("if not vacuum > medium", "if not vacuum >= medium"),
        ("* second.hamaker_constant[medium])", "* first.hamaker_constant[medium])"),
        ("-1 < self.poisson_ratio <= 0.5", "-1 <= self.poisson_ratio <= 0.6"),
        ("0 <= self.contact_angle <= np.pi", "0 <= self.contact_angle"),
        ("return first.contact_angle, second", "return first.contact_angle, first"),
        ('"hardness": self.hardness} | constants', '"hardness": self.hardness}'),
    ],
    "contact.pair": [
        ("area[k - 1] = higher / heights.size", "area[k - 1] = higher"),
        ("+ np.int32(below + 1)", "+ np.int32(below)"),
        (
            "self.asperity.add_forces(heights, spacing, grid.step, force)",
            "self.asperity.add_forces(heights, 2 * spacing, grid.step, force)",
        ),
        ("force / inside", "force / (heights.size * spacing**2)"),
        ("heights[:: self.every, :: self.every]", "heights[:: self.every, :]"),
        ("self.beam.grid.spacing * self.every", "self.beam.grid.spacing"),
    ],
    "contact.forcelaw": [
        ("((1 - weight) * here + weight * ahead)", "(weight * here + (1 - weight) * ahead)"),
        ("1.0, -tension, out)", "1.0, tension, out)"),
        ("(starts[2] - shift - starts[1])", "(starts[2] + shift - starts[1])"),
        ("(level - force[index]) /", "(force[index] - level) /"),
        ("-slope / bend if", "slope / bend if"),
        ("-(force[i] + 0.5 * slope * offset)", "-(force[i] + slope * offset)"),
        ("0.5 * min(left, right) ** 2", "min(left, right) ** 2"),
        ("np.log(1 + np.sqrt(1 + f_limit / f_max))", "np.log(np.sqrt(1 + f_limit / f_max))"),
        ("e / f_max - 0.5 /", "e / f_max - 1.5 /"),
        ("1.5 / reach]", "0.5 / reach]"),
        ("f_max * decay * (decay - 2)", "f_max * decay * (decay - 1)"),
        ("(1.5 / a_right + 0.5 / a_left)", "(0.5 / a_right + 1.5 / a_left)"),
        ("float(f_max.max())", "float(f_max.min())"),
    ],
    "chaos.coordinates": [
        ("d_max - np.exp(log_gap)", "d_max + np.exp(log_gap)"),
        ("@ self.axes / np.sqrt(self.variances)", "@ self.axes / self.variances"),
        ("constrained(q * self.scale)", "constrained(q)"),
        ("np.cumsum(variances[:0:-1])[::-1]", "np.cumsum(variances[1:])"),
        (
            "return PrincipalCoordinates(scale, q.mean(axis=0), variances.copy(), axes * signs)",
            "return PrincipalCoordinates(scale, q.mean(axis=0), variances.copy(), -axes * signs)",
        ),
        ("& (d_max > d_limit)", "& (d_max >= d_limit)"),
    ],
    "chaos.density": [
        ("(4 / (samples * (dimension + 2)))", "(4 / (samples * (dimension + 4)))"),
        ("1 / np.sqrt(1 + bandwidth**2)", "1 / (1 + bandwidth**2)"),
        ("np.exp(0.5 * (nearest - squares[i]))", "np.exp(nearest - squares[i])"),
        ("given[r, first] == given[r - 1, first]", "r > 0"),
        ("edge = start - 0.5 * taps.size * step", "edge = start - taps.size * step"),
        ("density.bandwidth**2 - step**2 / 6", "density.bandwidth**2 + step**2 / 6"),
        ("self.bandwidth * rng.standard_normal", "rng.standard_normal"),
    ],
    "chaos.polynomials": [
        ("= 2 * points[i] - 1", "= 2 * points[i] + 1"),
        ("- a * values[a - 1, i]) / (a + 1)", "- a * values[a - 1, i]) / (a + 2)"),
        ("norm = np.sqrt(2 * a + 1)", "norm = np.sqrt(2 * a + 2)"),
        ("3 * w * t * (1 - t)", "6 * w * t * (1 - t)"),
        ("if sum(alpha) <= order]", "if sum(alpha) < order]"),
        ("first += 1  #", "first += 2  #"),
        ("used -= 1  #", "used -= 2  #"),
        ("used = ~indices[:, k:]", "used = ~indices[:, k - 1 :]"),
    ],
    "chaos.model": [
        ("self.coefficients[:, 1:] ** 2", "self.coefficients ** 2"),
        ("<= tolerance))", "< 10 * tolerance))"),
        ("missing -= int(good.sum())", "missing -= int(good.size)"),
        ("<= order\n", "< order\n"),
        ("lawful[rng.integers(len(lawful), size=n)]", "lawful[:n]"),
    ],
    "numbers": [
        ("rtol=1e-9", "rtol=1e-1"),
        ("max(1, round(whole / part))", "round(whole / part)"),
    ],
    "beam.cantilever": [
        ("self.thickness**3 / 12", "self.thickness**3 / 3"),
        ("self.young_modulus * self.second_moment", "self.young_modulus / self.second_moment"),
        ("self.length / self.elements", "self.length * self.elements"),
        ("(value > 0 and", "(value >= 0 and"),
        ("(self.tension >= 0 and", "(self.tension > -2 and"),
        ("np.sqrt(self.tension / self.bending_stiffness)", "np.sqrt(self.tension * self.bending_stiffness)"),
    ],
    "beam.tension": [
        ("17 * kl**4 / 1680", "27 * kl**2 / 1680"),
        ("kl**2 / (1 - mean)", "kl**2 / (1 + mean)"),
        ("coupling = force * mean / 2", "coupling = force / 2"),
        ("coupling / 2 + 1 / mean,", "coupling / 2 + mean,"),
        ("band[i + 1, 2] -= n", "band[i + 1, 2] += n"),
        ("force[i + 3] -= n * (3 * fall", "force[i + 3] -= n * (36 * fall"),
        ("load * first**2 / (2 * c)", "load * first**2 / 12"),
        ("+= -clamping + c * u[i]", "+= clamping + c * u[i]"),
        ("odd = (slope / 2 - end)", "odd = (slope - end)"),
        ("(2 * stiffness * kl**2)", "(2 * stiffness * kl)"),
        ("slope / 2 * sh + odd", "slope / 2 * ch + odd"),
        ("return moment**2 / (2 * beam.width", "return moment**2 / (beam.width"),
        ("_HALVINGS = 60", "_HALVINGS = 6"),
        ("beam) / pull)", "beam) / pull) ** 0.9"),
        ("return 2 * beam.bending_stiffness * beam.gap", "return beam.bending_stiffness * beam.gap"),
    ],
    "beam.equilibrium": [
        ("1 - 3 * s**2 + 2 * s**3, s", "1 - 3 * s**2 + s**3, s"),
        ("band[i + 1, 2] += 2 * k", "band[i + 1, 2] += 4 * k"),
        ("force[i + 1] += load / 12", "force[i + 1] += load / 6"),
        ("12 * k / first**3 * u[i] +", "12 * k / first**2 * u[i] +"),
        ("x * (x - 2)", "x * (x - 1)"),
        ("distance < laws[r, 1] else", "distance > laws[r, 1] else"),
        ("system.force[i + row] -= n[row] * push", "system.force[i + row] += n[row] * push"),
        ("np.abs(system.force[rows]).max()", "system.force[rows].max()"),
        ("mesh.load * first**4 / (24 * mesh.stiffness)", "mesh.load * first**4 / (12 * mesh.stiffness)"),
        ("* mesh.area * x * (x - 2)", "* x * (x - 2)"),
        ("return beam.gap - (np.hstack", "return beam.gap + (np.hstack"),
        ("pull = mesh.stiffness * mesh.decay**2", "pull = mesh.stiffness * mesh.decay"),
        ("kl = first * mesh.decay", "kl = mesh.decay"),
        ("float(tip_force), beam.decay * l_e", "float(tip_force), beam.decay"),
    ],
    "beam.release": [
        ("return 72 * beam", "return 36 * beam"),
        ("return tension.holding_load(beam, crack)", "pass"),
        ("(6 - 8 * s + 3 * s**2)", "(6 - 8 * s + 2 * s**2)"),
        ("excess[r] / (before - excess[r])", "excess[r] / (before + excess[r])"),
        ("(r + 0.5 + behind)", "(r + 1 + behind)"),
        ("> 0.75 * beam.gap / crack", "> 1.75 * beam.gap / crack"),
        ("crack_length(beam, laws, end.deflection) > 1.5", "crack_length(beam, laws, end.deflection) > 0.5"),
        ("START * min(arrest_length(energy, beam), beam.length)", "arrest_length(energy, beam)"),
    ],
    "beam.energy": [
        ("6 * beam.bending_stiffness", "3 * beam.bending_stiffness"),
        ("return 1.5 * beam.young_modulus", "return 3 * beam.young_modulus"),
        ("beam.thickness**3 / crack_length**4", "beam.thickness**3 / crack_length**3"),
        ("CRACK_LENGTH_POWER = -1 / 4", "CRACK_LENGTH_POWER = -1 / 5"),
        ("return tension.release_rate(crack_length, beam)", "pass"),
        ("return tension.arrest_length(energy, beam)", "pass"),
    ],
    "beam.montecarlo": [
        ("1 + scatter * rng", "1 + 2 * scatter * rng"),
        ("rng.standard_normal(len(SCATTERED))", "rng.standard_normal()"),
        ("beam = scattered_beam(experiment.beam, experiment.scatter, rng)", "beam = experiment.beam"),
        ("adhesion_energy(end.crack_length, experiment.beam)", "adhesion_energy(end.crack_length, beam)"),
        ("end.equilibrium.deflection[:, 0]", "end.equilibrium.deflection[:, 1]"),
        ("stream(k)), samples)", "stream(0)), samples)"),
        ("outcomes[:shapes]", "outcomes[shapes:]"),
    ],
    "report.format": [
        (
            "return 100 * (value / reference - 1) if reference else np.nan",
            "return 100 * (value - reference) if reference else np.nan",
        ),
        ("return text if float(text) else format(0.0, form)", "return text"),
        ("max(0, 1 - int(exponent))", "max(0, -int(exponent))"),
        ("max(0, 1 - int(exponent))", "1 - int(exponent)"),
        ('f"{error:.1e}".partition', 'f"{error:e}".partition'),
    ],
    "report.published": [
        ("return published[published.iloc[:, 0].isin(list(names))]", "return published"),
        ("else np.isclose(held.astype(float), value)", "else held == value"),
        ('keep_default_na=False, na_values=[""]', "keep_default_na=True"),
    ],
    "report.tables": [
        ("disable_numparse=True, ", ""),
    ],
    "report.tables_surfaces": [
        ("third / rms**3", "third / rms**2"),
        ("1 / curvature / UM", "curvature * UM"),
        ("100 * float(spectra[surface].defect)", "-100 * float(spectra[surface].defect)"),
        ("{source: 100 * float(spectra[surface].defect)}", '{"published": 100 * float(spectra[surface].defect)}'),
    ],
    "report.tables_beams": [
        ("spread, error = values.std(ddof=1), np.hypot(*errors)", "spread, error = values.std(ddof=1), errors[0]"),
        ("100 * np.hypot(chaos_error, samples_error) / samples", "100 * (chaos_error + samples_error) / samples"),
    ],
    "report.tables_studies": [
        ('if statistic == "mean" else np.nan', "if True else np.nan"),
    ],
    "report.style": [
        ("return _MARKERS[k % len(_MARKERS)]", "return _MARKERS[k]"),
        ("max(left - short, 0), min(right + short, 1)", "left - short, right + short"),
        ("panel.set_xlim(max(left - short, 0)", "panel.set_xlim(max(left, 0)"),
    ],
    "report.figures_beams": [
        ("2 * weakest, *map(_reach, released.values()))", "2 * weakest)"),
        ("1.1 * (energies.mean() + energies.std())", "energies.mean()"),
    ],
    "report.checks": [
        ("abs(found.error) <= accuracy", "found.error <= accuracy"),
        ("tolerance = accuracy / abs(CRACK_LENGTH_POWER)", "tolerance = 40 * accuracy"),
        ("energies.max() * found.excess", "2 * energies.max() * found.excess"),
        ("bool(low <= gamma <= high)", "bool(gamma <= high)"),
        ('elements=released.sizes["node"] - 1', "elements=beams[pair].elements"),
        ("if case_id(pair, humidity) in on_mesh_of_paper else ACCURACY", "if True else ACCURACY"),
        ("if stuck.sum() < 2", "if stuck.sum() < 0"),
        ("distance <= LARGEST_DISTANCE, message", "True, message"),
        ('used = heights[surface] if model == "NG"', 'used = targets[surface] if model == "NG"'),
        ('+ (defect * target if name == "rms_nm" else 0)', '- (defect * target if name == "rms_nm" else 0)'),
        (
            'return pd.read_csv(path, dtype={"passed": bool}, keep_default_na=False)',
            'return pd.read_csv(path, comment="#")',
        ),
    ],
    "config.files": [
        ("changes, read(PAPER))", "reversed(list(changes)), read(PAPER))"),
        ("    validate(config)\n", ""),
        ("return normalised(config)", "return config"),
        ("for key in sorted(value)}", "for key in value}"),
        ('sorted(pair["humidities"])', 'pair["humidities"]'),
    ],
    "config.reading": [
        ("for key in duplicates(", "for key in set("),
        ("if not isinstance(content, dict)", "if content is None"),
        ('key.tag != "tag:yaml.org,2002:merge"', "key.tag"),
        ('.count(b"\\n") + 1', '.count(b"\\n")'),
        ('"is empty" if content is None', '"is empty" if content'),
        ("if pattern.fullmatch(text) and", "if False and"),
        ("mark.line + 1", "mark.line"),
        ("taken = option in options", "taken = taken or option in options"),
        ("if taken and equals", "if False"),
        ("equals and name.isidentifier()", "name.isidentifier()"),
        ("return 2 if found else 0", "return 0"),
    ],
    "config.relations": [
        ("return None if gap >= least", "return None if gap >= 0.5 * least"),
        ("np.max(meniscus_height(humidities", "np.min(meniscus_height(humidities"),
        ("        if strip > longest:", "        if strip > 2 * longest:"),
        ('before if key == "@"', 'key if key == "@"'),
        ("(1e-6 * thickness) ** 3 / 12", "(1e-6 * thickness) ** 2 / 12"),
        ("if kurtosis <= skewness**2 + 1", "if kurtosis < skewness**2 + 1"),
        ("return None if corner < cutoff", "return None if corner <= cutoff"),
        ("return None if floor < plateau", "return None if floor <= plateau"),
        ("nyquist = math.pi / spacing", "nyquist = 2 * math.pi / spacing"),
        ("largest = math.pi / cutoff", "largest = 2 * math.pi / cutoff"),
        ("return None if spacing <= coarse or", "return None if spacing >= coarse or"),
        ("return None if length > bound", "return None if length > 0.5 * bound"),
        ("length * _AT_MOST < bound", "length * 10 * _AT_MOST < bound"),
        ("if needed <= memory.LARGEST", "if needed <= 100 * memory.LARGEST"),
        ("_too_large(length + margin, width + margin, spacing)", "_too_large(length, width, spacing)"),
        ("force[0] >= _SAFE * force[1]", "force[0] >= -_SAFE * force[1]"),
        ('{*pair["humidities"], shown_humidity}', "{shown_humidity}"),
        ("step = spacing * every", "step = spacing"),
        ("if 3 * coarse <= side", "if 2 * coarse <= side"),
        ("return None if chunks <= samples", "return None if chunks < samples"),
        ("math.comb(n + 4, 4) <= samples", "math.comb(n + 3, 3) <= samples"),
        ("is_multiple(length, strip * elements)", "is_multiple(length, strip)"),
        ("length > 1.5 * strip * strips", "length > 0.5 * strip * strips"),
        ("return None if size < length", "return None if size <= length"),
        ("return path[:depth] == fault[:depth]", "return path == fault"),
        ("dict.fromkeys(map(str, problems))", "map(str, problems)"),
    ],
    "run.fingerprint": [
        ("if _name(module) not in SILENT", "if True"),
        ("open_files += imports", "pass"),
        ('fields["body"] = node.body[1:]', "pass"),
        ("for node in ast.walk(tree)", "for node in tree.body"),
        ("for end in (None, -1)]", "for end in (None,)]"),
        ("for name, value in sorted(fields.items())", "for name, value in fields.items()"),
        ("if value not in (None, [])", "if True"),
        ("elif not text or value.value:", "else:"),
        ("ast.Constant(joined[-1].value + value.value)", "ast.Constant(value.value)"),
        ("if not path.is_relative_to(PACKAGE) or path.parent", "if path.parent"),
        ('name.startswith("stiction.")', 'name.startswith("stiction.x")'),
    ],
    "config.units": [
        ("value * factor\n", "value / factor\n"),
        ('"um": 1e-6', '"um": 1e-9'),
        ("key[: unit.start()] if unit else key", "key"),
        ("tuple(item * factor for item in value)", "tuple(value)"),
    ],
    "config.plan": [
        ("and humidity_of(case) <= max", "and humidity_of(case) >= 0 * max"),
        ("and all(self._has_heights_of_paper(name) for name in self.sides(pair))", ""),
        ("else SUMMITS\n", "else ()\n"),
        ("exists = all(is_feasible", "exists = any(is_feasible"),
        (
            "[case_id(pair, humidity) for pair in self.pairs",
            '[case_id(pair, humidity) for pair in self.config["pairs"]',
        ),
        ("return wanted if wanted in self.pairs else self.pairs[0]", "return wanted"),
        ("return at[0] * at[1] > 0 and exists", "return exists"),
        ("if elements != same}", "}"),
        ('return wanted if known[wanted] else entry["psd"]', "return wanted"),
        ('if variant == "base" or self._under(pair, variant) != self._under(pair, "base")', "if True"),
        ("and set(self.sides(pair)) <= set(self.paper_surfaces)", ""),
        ("if beam\n            and _same", "if _same"),
        ('but=["psd"])', 'but=["psd", "published_psd"])'),
        ('if key != "psd"}', "}"),
    ],
    "config.jobs": [
        ("return {} if plan.has_mesh_of_paper(case) else", "return {} if False else"),
        ("if not plan.has_mesh_of_paper(case_id(pair, h))", "if plan.has_mesh_of_paper(case_id(pair, h))"),
        ('section["scatter"] if model == "GEO" else 0', 'section["scatter"]'),
        ("[min(humidities), max(humidities)]", "[max(humidities), min(humidities)]"),
        ("if max(values) <= 0 > min(values)]", "if min(values) < 0]"),
        ("| plan.finer_beams.get(name, {})", ""),
        ('("distance_step_nm", "every")) | more', '("distance_step_nm", "every", "chunks")) | more'),
        ('samples=study["samples"]), "step"', 'samples=plan.config["contact"]["samples"]), "step"'),
    ],
    "stages.storage": [
        ("if found != wanted", "if found[0] != wanted[0]"),
        ("labels.made_from(inputs, stage", "labels.made_from((), stage"),
    ],
    "run.labels": [
        ("sort_keys=True", "sort_keys=False"),
        ("{} if found.stage == stage else", "{} if found.stage != stage else"),
        ("before |= found.before |", "before |="),
        ("except (OSError, RuntimeError) as error", "except RuntimeError as error"),
    ],
    "run.kept": [
        ("if found.name != path.stem", "if False"),
        ("_first(found.settings, settings)", "_first(settings, settings)"),
        ("in found.before.items()", "in ()"),
        ("expected(file) or {}", "expected(file) or stored"),
        ("json.loads(json.dumps(wanted))", "wanted"),
        ("{*found, *wanted}", "{*found}"),
        (".hexdigest() != checksum", ".hexdigest() is None"),
        ("(path.parent, path.name)", "path.as_posix()"),
    ],
    "run.forkserver": [
        ("gc.freeze()  #", "pass  #"),
        ('importlib.import_module("stiction.run.warmup").main()', "pass"),
        ("        importlib.import_module(module.name)", "        pass"),
        ("raise_signal(signal.SIGINT)", "raise_signal(signal.SIGTERM)"),
        ("signal.signal(signal.SIGINT, signal.SIG_IGN)", "signal.getsignal(signal.SIGINT)"),
        ("        signal.signal(signal.SIGINT, interrupt)\n", ""),
        ("prctl(_PR_SET_PDEATHSIG", "prctl(0"),
        ("                _end_with(server)\n", ""),
        ("            if not message:\n                return None\n", ""),
        ("sys.argv[:] = [script]", "sys.argv[:] = []"),
        ("sys.path.insert(0, str(Path(script).parent))", "pass"),
        ('sys.modules["__main__"] = module', "pass"),
        ("        stream.flush()", "        pass"),
        ("(error.code or 0) & 0xFF", "1"),
        ("int | None)", "int)"),
        ("error.__traceback__.tb_next)", "error.__traceback__)"),
        ("os.waitstatus_to_exitcode(status)", "status"),
        ("            self.close()\n", ""),
    ],
    "run.hooks": [
        ("if waiting.acquire(blocking=False)", "if True"),
        ("        waiting.release()\n", ""),
        ("timer.daemon = True", "timer.daemon = False"),
        ("<= set(dir(scheduler))", '<= {"_schedule_reevalutation", "_open_jobs"}'),
        ('"VECLIB_MAXIMUM"', '"VECLIB_MAXIMUM_NUM"'),
        ('["self", "fname", "edit"]', '["self", "fname", "debug"]'),
        ('sys.platform != "linux"', "False"),
        (
            "    except ConnectionError as error:\n        return",
            "    except ConnectionError as error:\n        assert",
        ),
        ("return alike and not any(special)", "return alike"),
        ("environment(script.threads, folder) == server.environment", "True"),
        (' and not script.resources.get("shell_exec")', ""),
        ("    if status:\n", "    if not status:\n"),
        ("            start(script, fname, edit)\n", "            pass\n"),
        ("    except BrokenPipeError:\n        return", "    except BrokenPipeError:\n        assert"),
        ('if "pandas" in sys.modules else', "if False else"),
    ],
    "run.atomic": [
        ("        draft.unlink(missing_ok=True)\n\n\ndef save_text", "        pass\n\n\ndef save_text"),
        ("os.fsync(file.fileno())", "pass"),
        ("draft.replace(path)", "path.write_bytes(draft.read_bytes())"),
    ],
    "stages.curves": [
        ("-float(laplace_pressure(humidity, temperature))", "float(laplace_pressure(humidity, temperature))"),
        ("float(meniscus_height(humidity, temperature)),", "0.5 * float(meniscus_height(humidity, temperature)),"),
    ],
    "stages.heights": [
        ("used = replace(settings, skewness=found.skewness, kurtosis=found.kurtosis)", "used = settings"),
        ("_measured(settings, found.distance)", "_measured(used, found.distance)"),
        ("    if not found.distance:\n", "    if False:\n"),
        ("maxent.solve(found.skewness, found.kurtosis)", "maxent.solve(-found.skewness, found.kurtosis)"),
        ('if model == "NG" else GAUSSIAN', 'if model == "G" else GAUSSIAN'),
        ("float(heights.skewness), float(heights.kurtosis))", "float(heights.kurtosis), float(heights.skewness))"),
        ("np.linspace(-6, 6, 601)", "np.linspace(-3, 6, 601)"),
    ],
    "stages.spectrum": [
        ("target(zeta) / target.variance", "target(zeta)"),
        ('density(heights, "NG")', 'density(heights, "G")'),
        ('if model == "G":', 'if model == "NG":'),
        ('"sampling.margin_um": use.margin}', '"sampling.margin_um": use.strip_length}'),
        ("1 / RESEMBLES <= ratio <= RESEMBLES", "1 / RESEMBLES <= ratio"),
        ('settings.psd == "identified" and settings.identified', "False"),
        ("spectrum.underlying.values, target.cutoff)", "spectrum.target.values, target.cutoff)"),
        ("spectrum.wavenumber, spectrum.achieved)", "spectrum.wavenumber, spectrum.target)"),
        ("spectrum_of_heights(underlying, translation, settings.spacing), defect)", "underlying, defect)"),
        ("return float(spectrum.defect)", "return -float(spectrum.defect)"),
    ],
    "stages.surfaces": [
        ("self.spacing, self.margin)", "self.spacing, 0.5 * self.margin)"),
        ("moments(heights).rms, grid)", "1.1 * moments(heights).rms, grid)"),
    ],
    "stages.identification": [
        (
            "summits.mean_summit_radius, summits.summit_density",
            "summits.mean_summit_radius, 2 * summits.summit_density",
        ),
        ('patches(), patches("control"))', "patches(), patches())"),
        ('"identification", surface, *address)', '"identification", *address)'),
        ("parameters.refuse_long_correlation(surface, found.spectrum", "(surface, found.spectrum"),
        ("StripGrid(patch, patch, settings.spacing,", "StripGrid(patch, patch, settings.target_spacing,"),
    ],
    "stages.parameters": [
        ("if length <= bound", "if length <= 0.9 * bound"),
        ('identification[f"{name}_error"])', "identification[name])"),
    ],
    "stages.character": [
        ("[::every, ::every]", "[::every, :]"),
        ("** order) for order in (1, 2, 3, 4)]", "** order) for order in (0, 1, 2, 3)]"),
        ('"character", name, k)', '"character", name, 0)'),
        ('"character", surface, "field", k)', '"character", surface, "field", 0)'),
        ("np.hstack(summits)[:, :_KEPT]", "np.hstack(summits)[:, 1:_KEPT]"),
        ("find_summits(z, spacing)", "find_summits(z, surface.grid.spacing)"),
    ],
    "stages.forces": [
        ("settings.humidity, settings.water)", "0.9 * settings.humidity, settings.water)"),
        ("[curve(k).copy() for k", "[curve(k) for k"),
        ("min(_KEPT, contact", "min(1, contact"),
        ("for name in COMPONENTS]", "for name in COMPONENTS[::-1]]"),
    ],
    "stages.chaos": [
        ("settings.chaos.order, settings.chaos.dimension_tolerance)", "settings.chaos.order, 0.5)"),
        ('stream(settings.seed, "chaos", case, model)', 'stream(settings.seed, "chaos", case)'),
        ('stream(settings.seed, "rejection", case, model)', 'stream(settings.seed, "chaos", case, model)'),
        ("rejected / (rejected + _DRAWS)", "rejected / _DRAWS"),
        ('("scale", "mean", "variance", "axes"))', '("mean", "scale", "variance", "axes"))'),
    ],
    "stages.releases": [
        ("    if settings.refined:\n", "    if not settings.refined:\n"),
        ('draw(_LAWS, address("mesh"))', "draw(_LAWS, address(0))"),
        ('error.add_note(f"in case {case}")', "pass"),
        ('"beams", case)', '"beam", case)'),
        ("draw, settings.scatter)", "draw)"),
        ("range(number), address, threads)", "range(1, number + 1), address, threads)"),
        ("total=number)), shapes)", "total=number)))"),
        ("beams.state.values == STATES", "beams.state.values >= STATES"),
    ],
    "stages.beams": [
        ('columns["deflection"].shape[1] - 1', "settings.beam.elements"),
        ("case, settings, shapes=_KEPT)", "case, settings, shapes=1)"),
        ('columns["energy"], {"units"', 'columns["crack_length"], {"units"'),
        ("elements=elements).nodes", "elements=elements).nodes[::-1]"),
        ('" ".join(releases.STATES)', '" ".join(releases.STATES[::-1])'),
    ],
    "stages.cantilevers": [
        ("width=size.width", "width=size.thickness"),
        ("gap=settings.pairs[pair].gap", "gap=size.thickness"),
        ("round(beam.length / sampling.strip_length)", "round(beam.length / sampling.strip_length / 5)"),
    ],
    "studies.sensitivity_contact": [
        ('less if side == "less" else more', 'more if side == "less" else less'),
        ("found.assign(moment=getattr(moments, moment))", "found.assign(moment=less)"),
        ("beam = changed, stage_spectrum", "beam = heights, stage_spectrum"),
        ("(beam, substrate), pair,", "(substrate, beam), pair,"),
    ],
    "studies.sensitivity": [
        ("energy_sensitivity(found.swapaxes(1, 2), at)", "energy_sensitivity(found.swapaxes(1, 2), at[::-1])"),
        ("[moment(contact) for contact in contacts]", "[moment(contact) for contact in contacts[::-1]]"),
        ("slopes, errors = estimate", "errors, slopes = estimate"),
        ('("mean", "standard deviation")', '("standard deviation", "mean")'),
    ],
    "studies.plasticity": [
        ("grid.spacing * meeting.every)", "grid.spacing * 2)"),
        ("touching(height, curvature, settings.distance)", "touching(height, curvature, 0.9 * settings.distance)"),
        ("plastic_share(area, stress,", "plastic_share(stress, area,"),
        ("np.full(len(radius), k)", "np.full(len(radius), k // 2)"),
        ('surface_pair(surfaces, "NG", settings)', 'surface_pair(surfaces, "G", settings)'),
        ("meeting.draw(*streams(k))", "meeting.draw(*streams(0))"),
    ],
    "studies.fit": [
        ("np.flatnonzero(admissible(vectors, limit))", "np.arange(len(vectors))"),
        ("vectors[samples], limit)", "vectors[: len(samples)], limit)"),
        ("1 - len(samples) / total", "len(samples) / total"),
    ],
    "studies.humidity": [
        ("np.array([0.05, 0.5, 0.95])", "np.array([0.01, 0.5, 0.99])"),
        ("np.linspace(*settings.range, settings.points)", "np.linspace(*settings.range[::-1], settings.points)"),
        ("mean_with_error(energies.T)", "mean_with_error(energies.T[1:])"),
    ],
    "studies.iteration": [
        ("misfit(periodograms.mean(axis=1), rings)", "misfit(periodograms[:, 0], rings)"),
        ("misfit(achieved(spectrum, zeta), rings)", "misfit(target(zeta) / target.variance, rings)"),
        ('"iteration", surface)', '"iteration")'),
        ('density(heights, "NG")', 'density(heights, "G")'),
        ("sampling_misfit(periodograms),", "sampling_misfit(periodograms[:, :, 1:]),"),
    ],
    "studies.sample_sizes": [
        ("energies[:size], at)", "energies[-size:], at)"),
        ("| {len(energies)})", ")"),
        ("max(2, round(", "max(1, round("),
        ("1.2 * energies.max()", "energies.max()"),
        ("distance_of_parts(energies, size)", "distance_of_parts(energies[:size], size)"),
    ],
    "studies.orders": [
        ("chaos.truncated(fitted, order)(xi)", "fitted(xi)"),
        ('"orders", settings.case)', '"orders")'),
        ("[:, : fitted.dimension]", "[:, -fitted.dimension :]"),
        ("distances[0].T]", "distances[1].T + 1]"),
        ('"target": ["kernels", "input"]', '"target": ["input", "kernels"]'),
    ],
    "studies.mesh": [
        ("len(energies) // 2]", "len(energies) // 4]"),
        ("coefficients(samples[[sample]], limit)", "coefficients(samples[[sample]], 2 * limit)"),
        ("round(beam.length / point)", "round(beam.length / element)"),
        ("(distance, curves[sample])", "(distance, curves[0])"),
        ("elements, points = np.transpose", "points, elements = np.transpose"),
    ],
    "studies.correlation": [
        ("[c / c[0] for c", "[c for c"),
        ("np.linspace(0, 1e-6, 401)", "np.linspace(0, 2e-6, 401)"),
        (
            "[correlation_length(target) for target in targets]",
            "[correlation_length(target, 0.1) for target in targets]",
        ),
    ],
    "studies.resampling": [
        ('"resampling", case)', '"beams", case)'),
        ("samples=settings.beams, scatter=0,", "samples=settings.beams, scatter=0.01,"),
        ('np.asarray(columns["state"], np.int8)', 'np.ones_like(columns["state"])'),
    ],
    "studies.variant": [
        ("energies.append(vectors[:, 0])", "energies.append(vectors[:, 1])"),
        ("samples=number, scatter=0", "samples=number, scatter=0.01"),
        ("case_id(pair, humidity), refined)", "case_id(pair, humidities[0]), refined)"),
        ("refined=humidity in settings.refined", "refined=False"),
        ("settings.chaos.order, settings", "1, settings"),
        ('releases.ended(chosen, "S-shape")', 'releases.ended(chosen, "arc")'),
    ],
    "studies.variant_contact": [
        ("base.sampling.spacing, identifications)", "2 * base.sampling.spacing, identifications)"),
        ('pair, "NG", changed)', 'pair, "NG", base)'),
        ('surfaces, pair, "NG"', 'surfaces, pair, "G"'),
    ],
    "config.merging": [
        ("return {**base, **{key", "return {**{key"),
        ("key: merged(base.get(key), value)", "key: value"),
    ],
    "models": [
        ('return "G" if model == "G" else "NG"', "return model"),
    ],
    "stages.named": [
        ("key(Path(path).stem)", "Path(path).stem"),
        ("return (*key, model) if model else key", "return key"),
    ],
}


def source_of(module):
    """File of a module such as ``surface.maxent``."""
    return f"src/stiction/{module.replace('.', '/')}.py"


def tests_of(module):
    """File or folder of its tests."""
    *folder, name = module.split(".")
    return f"tests/{TESTS.get(module, '/'.join([*folder, f'test_{name}.py']))}"


class Copy:
    """Copy of the project with one mutant at a time."""

    def __init__(self, folder):
        self.folder, self.warm, self.cache = folder / "project", folder / "warm", folder / "cache"
        ignored = shutil.ignore_patterns("__pycache__", "benchmarks")
        for name in ("src", "tests", "workflow", "profiles"):
            shutil.copytree(ROOT / name, self.folder / name, ignore=ignored)
        for name in ("pyproject.toml", "config.yaml"):
            shutil.copy(ROOT / name, self.folder)

    def tests(self, module, cache, limit=None):
        """Run the tests of a module, at most for a time [s]; the name of the first that fails, empty if all pass."""
        files = [tests_of(module), source_of(module)]
        command = [sys.executable, "-B", "-m", "pytest", "-x", "--tb=no", "-p", "no:cacheprovider", *files]
        environment = os.environ | {"NUMBA_CACHE_DIR": str(cache), "OMP_NUM_THREADS": "1"}
        environment["PYTHONPATH"] = str(self.folder / "src")
        try:
            done = subprocess.run(
                command, cwd=self.folder, env=environment, capture_output=True, text=True, timeout=limit
            )
        except subprocess.TimeoutExpired:
            return "its tests do not end"
        if done.returncode == 0:
            return ""
        lines = [line for line in done.stdout.splitlines() if line.startswith(("FAILED", "ERROR"))]
        return lines[0] if lines else f"pytest ended with {done.returncode}"

    def notice(self, module, old, new, limit):
        """Name of the test that detects a mutant; empty if none does."""
        path = self.folder / source_of(module)
        text = path.read_text(encoding="utf-8")
        shutil.rmtree(self.cache, ignore_errors=True)
        shutil.copytree(self.warm, self.cache)
        kept = path.stat()
        try:
            path.write_text(text.replace(old, new), encoding="utf-8")
            return self.tests(module, self.cache, limit)
        finally:
            path.write_text(text, encoding="utf-8")
            os.utime(path, ns=(kept.st_atime_ns, kept.st_mtime_ns))


def chosen(modules):
    """(module, old, new) of all mutants of the modules; each must change exactly one place."""
    mutants = [(module, old, new) for module in modules for old, new in MUTANTS[module]]
    for module, old, _ in mutants:
        text = (ROOT / source_of(module)).read_text(encoding="utf-8")
        if text.count(old) != 1:
            sys.exit(f"{module} holds {old!r} {text.count(old)} times, must be once: bring tests/mutants.py up to date")
    return mutants


def detected(module, mutants, copies):
    """Mutants of a module and the names of the tests that detect them; the tests must pass without a mutant.

    Copies of the project are taken from a queue and put back, so that each is used by one thread at a time.
    """
    copy = copies.get()
    try:
        start = time.monotonic()
        if failed := copy.tests(module, copy.warm):
            return [((module, "", ""), f"FAILED without a mutant: {failed}")]
        copy.warm.mkdir(exist_ok=True)
        limit = max(PATIENCE[0] * (time.monotonic() - start), PATIENCE[1])
        return [((module, old, new), copy.notice(module, old, new, limit)) for _, old, new in mutants]
    finally:
        copies.put(copy)


def main():
    parser = argparse.ArgumentParser(description="Introduce small errors and count those that no test detects.")
    parser.add_argument("modules", nargs="*", metavar="module", help="of src/stiction; all by default")
    modules = parser.parse_args().modules or list(MUTANTS)
    if unknown := set(modules) - set(MUTANTS):
        parser.error(f"no mutants of {', '.join(sorted(unknown))}; there are some of {', '.join(MUTANTS)}")
    mutants, results = chosen(modules), []
    workers = min(len(modules), os.cpu_count())
    with tempfile.TemporaryDirectory() as folder, ThreadPoolExecutor(workers) as pool:
        copies = Queue()
        for worker in range(workers):
            copies.put(Copy(Path(folder) / str(worker)))
        tasks = [pool.submit(detected, name, [m for m in mutants if m[0] == name], copies) for name in modules]
        for task in as_completed(tasks):
            for (module, old, new), test in task.result():
                print(f"{'caught  ' if test else 'SURVIVED'} {module}: {old!r} -> {new!r}  {test}", flush=True)  # noqa: T201
                results.append(test)
    if broken := [test for test in results if "without a mutant" in test]:
        sys.exit("\n".join(broken))
    caught = sum(map(bool, results))
    print(f"{caught} of {len(mutants)} mutants caught, {100 * caught / len(mutants):.1f} %")  # noqa: T201
    sys.exit(caught < 0.99 * len(mutants))


if __name__ == "__main__":
    main()
