"""Test the tests: break the physics in small ways and count the ways that no test notices.

    python tests/mutants.py [module ...]

Each mutant is one replacement in one module of a copy of the project, on which the tests of that module run until the
first fails. Caches of compiled code are separate, so that no broken kernel outlives its mutant.
"""

import argparse
import os
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).parents[1]
PATIENCE = 180  # [s] a mutant whose tests take longer does not end, which counts as noticed

#: Names of test files that are not those of their modules: no two test files have one name.
TESTS = {"chaos.model": "chaos_model", "stages.pairs": "stage_pairs"}

#: Module to replacements (what stands there once, what takes its place).
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
    ],
    "surface.translation": [
        ("np.sqrt(k - 1) * previous", "np.sqrt(k) * previous"),
        ("previous) / np.sqrt(k)", "previous) / np.sqrt(k + 1)"),
        ("power = self.hermite_coefficients**2", "power = np.abs(self.hermite_coefficients)"),
        ("np.exp(-(_SCORES**2) / 2)", "np.exp(-(_SCORES**2))"),
        ("rho -= error /", "rho += error /"),
        ("lowest = self.autocorrelation(-1.0)", "lowest = self.autocorrelation(1.0)"),
    ],
    "surface.field": [
        ("np.where(k2 == 0, 1.0, 0.5)", "np.where(k2 == 0, 1.0, 1.0)"),
        ("np.where(k2 == 0, 1, 4)", "np.where(k2 == 0, 1, 2)"),
        ("(self.rms * self.translation.table)", "(self.rms**2 * self.translation.table)"),
        ("fraction * (table[k + 1] - table[k])", "fraction * (table[k] - table[k + 1])"),
        ("scores[i, j] * scale + offset", "scores[i, j] * scale - offset"),
        ("heights[i, j] += table[k]", "heights[i, j] = table[k]"),
        ("** 2 / step**2, step)", "** 2 / step, step)"),
        ("step * np.arange(1, n // 2 + 1)", "step * np.arange(n // 2)"),
        ("step = 2 * np.pi / (len(heights) * spacing)", "step = np.pi / (len(heights) * spacing)"),
    ],
    "surface.summits": [
        ("and h > z[i - 1, j + 1]", "and h > z[i - 1, j]"),
        ("h > z[i, j - 1]\n", "h >= z[i, j - 1]\n"),
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
    ],
    "surface.iteration": [
        ("spectrum.density * wanted / periodograms", "spectrum.density * periodograms"),
        ("(square.sum() * step**2)", "square.sum()"),
        ("np.sqrt(2 / np.pi /", "np.sqrt(2 /"),
    ],
    "studies.sensitivity": [
        ("moment + abs(moment) * step", "moment + moment * step"),
        ("return np.sign(at[0]) *", "return"),
        ("np.sqrt(second - first**2)", "np.sqrt(second)"),
    ],
    "studies.plasticity": [
        ("ONSET = 0.6", "ONSET = 1.6"),
        ("np.pi * radius * interference", "2 * np.pi * radius * interference"),
        ("height[reaching] - distance", "height[reaching]"),
    ],
    "stages.pairs": [
        ("reduced_modulus(**si(solid))", "2 * reduced_modulus(**si(solid))"),
        ('contact["distance_step"]', '2 * contact["distance_step"]'),
        ('"contact", pair, side, sample', '"contact", pair, "beam", sample'),
    ],
    "estimates": [
        ("/ np.sqrt(len(samples))", "/ len(samples)"),
        ("abs(power * mean * error / centre)", "abs(mean * error / centre)"),
        ("np.sqrt((n - 1) / n *", "np.sqrt((n - 1) *"),
    ],
    "studies.variants": [
        ("slopes @ common", "np.linalg.norm(slopes * common)"),
        ("return ratio - 1, ratio * error", "return ratio - 1, error"),
        ("both = reading.stuck & base.stuck", "both = reading.stuck"),
        ("2 * (left / total * before - after)", "2 * (left / total * before + after)"),
        ("np.linalg.norm(by_base * own)", "by_base @ own"),
        ("np.abs(by_shift) @ shift", "np.linalg.norm(by_shift * shift)"),
    ],
    "studies.convergence": [
        ("KOLMOGOROV_MEAN / np.sqrt(samples)", "KOLMOGOROV_MEAN / samples"),
        ("1 / size - 1 / len(samples)", "1 / size"),
        ("first = far[-1] + 1", "first = far[0] + 1"),
        ("!= EndState.S_SHAPE", "== EndState.FREE"),
    ],
    "contact.meniscus": [
        ("np.log(humidity) / WATER_MOLAR_VOLUME", "np.log10(humidity) / WATER_MOLAR_VOLUME"),
        ("GAS_CONSTANT * temperature *", "GAS_CONSTANT *"),
        ("return -2 * kelvin_radius", "return -kelvin_radius"),
        ("(humidity < 1))", "(humidity <= 1))"),
        ("WATER_SURFACE_ENERGY / laplace_pressure", "-WATER_SURFACE_ENERGY / laplace_pressure"),
    ],
    "contact.vanderwaals": [
        ("(2 / 15) ** (1 / 6)", "(2 / 15) ** (1 / 3)"),
        ("(16 * np.pi *", "(12 * np.pi *"),
        ("0.97 * 2 ** (1 / 6)", "0.97 * 2 ** (1 / 3)"),
        ("self.work_of_adhesion / self.range", "self.work_of_adhesion * self.range"),
        ('0.0 if through == "none"', '0.0 if through == "dry"'),
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
    ],
    "contact.pair": [
        ("count[k] = higher / heights.size", "count[k] = higher"),
        ("+ below + 1, 0)", "+ below, 0)"),
        ("factor = 4 / 3 * modulus / np.sqrt", "factor = 4 / 3 * modulus * np.sqrt"),
        ("overlap = max(heights[i, j] - k * step, 0.0)", "overlap = max(heights[i, j] - (k + 1) * step, 0.0)"),
        ("third = radius ** (1 / 3)", "third = radius ** (1 / 2)"),
        ("share = place - row", "share = 1 - place + row"),
        ("weight = unit_force * radius", "weight = unit_force"),
        ("force / inside", "force / (heights.size * spacing**2)"),
        ("heights[:: self.every, :: self.every]", "heights[:: self.every, :]"),
        ("self.beam.grid.spacing * self.every", "self.beam.grid.spacing"),
        ("part * (low[cell + 1] - low[cell])", "(1 - part) * (low[cell + 1] - low[cell])"),
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
    "chaos.model": [
        ("d_max - np.exp(log_gap)", "d_max + np.exp(log_gap)"),
        ("@ self.axes / np.sqrt(self.variances)", "@ self.axes / self.variances"),
        ("constrained(q * self.scale)", "constrained(q)"),
        ("(4 / (samples * (dimension + 2)))", "(4 / (samples * (dimension + 4)))"),
        ("1 / np.sqrt(1 + bandwidth**2)", "1 / (1 + bandwidth**2)"),
        ("np.exp(0.5 * (nearest - weights[i]))", "np.exp(nearest - weights[i])"),
        ("edge = start - 0.5 * taps.size * step", "edge = start - taps.size * step"),
        ("density.bandwidth**2 - step**2 / 6", "density.bandwidth**2 + step**2 / 6"),
        ("values[1] = 2 * points - 1", "values[1] = 2 * points + 1"),
        ("- a * values[a - 1, i]) / (a + 1)", "- a * values[a - 1, i]) / (a + 2)"),
        ("values[a] *= np.sqrt(2 * a + 1)", "values[a] *= np.sqrt(2 * a + 2)"),
        ("3 * w * t * (1 - t)", "6 * w * t * (1 - t)"),
        ("if sum(alpha) <= order]", "if sum(alpha) < order]"),
        ("self.coefficients[:, 1:] ** 2", "self.coefficients ** 2"),
        ("<= tolerance))", "< 10 * tolerance))"),
        ("missing -= int(good.sum())", "missing -= int(good.size)"),
        ("first += 1  #", "first += 2  #"),
    ],
    "beam.cantilever": [
        ("self.thickness**3 / 12", "self.thickness**3 / 3"),
        ("1 - 3 * s**2 + 2 * s**3, s", "1 - 3 * s**2 + s**3, s"),
        ("band[i + 1, 2] += 2 * k", "band[i + 1, 2] += 4 * k"),
        ("force[i + 1] += load / 12", "force[i + 1] += load / 6"),
        ("12 * k / first**3 * u[i] +", "12 * k / first**2 * u[i] +"),
        ("x * (x - 2)", "x * (x - 1)"),
        ("distance < laws[r, 1] else", "distance > laws[r, 1] else"),
        ("system.force[i + row] -= n[row] * push", "system.force[i + row] += n[row] * push"),
        ("np.abs(system.force[rows]).max()", "system.force[rows].max()"),
        ("mesh.load * first**4 / (24 * mesh.stiffness)", "mesh.load * first**4 / (12 * mesh.stiffness)"),
        ("return 72 * beam", "return 36 * beam"),
        ("excess[r] / (before - excess[r])", "excess[r] / (before + excess[r])"),
        ("(r + 0.5 + behind)", "(r + 1 + behind)"),
        ("> 0.75 * beam.gap / crack", "> 1.75 * beam.gap / crack"),
        ("crack_length(beam, laws, end.deflection) > 1.5", "crack_length(beam, laws, end.deflection) > 0.5"),
        ("* mesh.area * x * (x - 2)", "* x * (x - 2)"),
    ],
    "beam.energy": [
        ("6 * beam.bending_stiffness", "3 * beam.bending_stiffness"),
        ("return 1.5 * beam.young_modulus", "return 3 * beam.young_modulus"),
        ("beam.thickness**3 / crack_length**4", "beam.thickness**3 / crack_length**3"),
        ("CRACK_LENGTH_POWER = -1 / 4", "CRACK_LENGTH_POWER = -1 / 5"),
    ],
    "beam.montecarlo": [
        ("1 + scatter * rng", "1 + 2 * scatter * rng"),
        ("rng.standard_normal(len(SCATTERED))", "rng.standard_normal()"),
        ("beam = scattered_beam(experiment.beam, experiment.scatter, rng)", "beam = experiment.beam"),
        ("adhesion_energy(crack, experiment.beam)", "adhesion_energy(crack, beam)"),
        ("end.deflection[:, 0]", "end.deflection[:, 1]"),
        ("stream(k)), samples)", "stream(0)), samples)"),
        ("outcomes[:shapes]", "outcomes[shapes:]"),
    ],
}


def source_of(module):
    """File of a module such as ``surface.maxent``."""
    return f"src/stiction/{module.replace('.', '/')}.py"


def tests_of(module):
    """File of its tests."""
    *folder, name = module.split(".")
    return "/".join(["tests", *folder, f"test_{TESTS.get(module, name)}.py"])


class Copy:
    """A copy of the project in which one mutant lives at a time."""

    def __init__(self, folder):
        self.folder, self.warm, self.cache = folder / "project", folder / "warm", folder / "cache"
        ignored = shutil.ignore_patterns("__pycache__", "workflow", "benchmarks")
        for name in ("src", "tests"):
            shutil.copytree(ROOT / name, self.folder / name, ignore=ignored)
        for name in ("pyproject.toml", "config.yaml"):
            shutil.copy(ROOT / name, self.folder)

    def tests(self, module, cache):
        """Run the tests of a module; the name of the first that fails, empty if all pass."""
        files = [tests_of(module), source_of(module)]
        command = [sys.executable, "-B", "-m", "pytest", "-x", "--tb=no", "-p", "no:cacheprovider", *files]
        environment = os.environ | {"NUMBA_CACHE_DIR": str(cache), "OMP_NUM_THREADS": "1"}
        environment["PYTHONPATH"] = str(self.folder / "src")
        try:
            done = subprocess.run(
                command, cwd=self.folder, env=environment, capture_output=True, text=True, timeout=PATIENCE
            )
        except subprocess.TimeoutExpired:
            return "its tests do not end"
        if done.returncode == 0:
            return ""
        lines = [line for line in done.stdout.splitlines() if line.startswith(("FAILED", "ERROR"))]
        return lines[0] if lines else f"pytest ended with {done.returncode}"

    def notice(self, module, old, new):
        """The test that notices a mutant, empty if none does."""
        path = self.folder / source_of(module)
        text = path.read_text(encoding="utf-8")
        shutil.rmtree(self.cache, ignore_errors=True)
        shutil.copytree(self.warm, self.cache)
        kept = path.stat()
        try:
            path.write_text(text.replace(old, new), encoding="utf-8")
            return self.tests(module, self.cache)
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


def main():
    parser = argparse.ArgumentParser(description="Break the physics in small ways and count what no test notices.")
    parser.add_argument("modules", nargs="*", metavar="module", help="of src/stiction; all by default")
    modules = parser.parse_args().modules or list(MUTANTS)
    if unknown := set(modules) - set(MUTANTS):
        parser.error(f"no mutants of {', '.join(sorted(unknown))}; there are some of {', '.join(MUTANTS)}")
    mutants, survivors = chosen(modules), []
    with tempfile.TemporaryDirectory() as folder:
        copy = Copy(Path(folder))
        for module in modules:
            if failed := copy.tests(module, copy.warm):
                sys.exit(f"the tests of {module} must pass before it is broken: {failed}")
        copy.warm.mkdir(exist_ok=True)
        for module, old, new in mutants:
            test = copy.notice(module, old, new)
            survivors += [] if test else [(module, old, new)]
            print(f"{'caught  ' if test else 'SURVIVED'} {module}: {old!r} -> {new!r}  {test}", flush=True)  # noqa: T201
    caught = len(mutants) - len(survivors)
    print(f"{caught} of {len(mutants)} mutants caught, {100 * caught / len(mutants):.0f} %")  # noqa: T201
    sys.exit(caught < 0.9 * len(mutants))


if __name__ == "__main__":
    main()
