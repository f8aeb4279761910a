from dataclasses import replace

import numpy as np
import pytest
from beams import PAPER, scattered_laws, uniform_laws
from numpy.testing import assert_allclose, assert_array_equal

from stiction.beam.energy import apparent_adhesion_energy
from stiction.beam.montecarlo import Experiment, columns, release_beam, released_beams, scattered_beam, simulate
from stiction.beam.release import EndState
from stiction.errors import NotConverged
from stiction.streams import stream


def draw_scattered(n, rng):
    return scattered_laws(rng, n, 0.6)


def draw_uniform(n, _):
    return uniform_laws(n)


def beam_stream(k):
    return stream(1, "beam", "test", k)


NG = Experiment(PAPER, 1000, draw_scattered)
GEO = replace(NG, scatter=0.025)


def outcomes(experiment, samples, threads=1):
    return columns(list(simulate(experiment, samples, beam_stream, threads)), shapes=len(samples))


def assert_same(one, other):
    for name in one:
        assert_array_equal(one[name], other[name])


def test_results_do_not_depend_on_threads():
    assert_same(outcomes(GEO, range(8), threads=1), outcomes(GEO, range(8), threads=3))


def test_results_do_not_depend_on_batches_or_order():
    whole = outcomes(GEO, range(6))
    parts = [outcomes(GEO, samples) for samples in (range(2), range(2, 6))]
    assert_same(whole, {name: np.concatenate([part[name] for part in parts]) for name in whole})
    assert_same({name: values[::-1] for name, values in whole.items()}, outcomes(GEO, range(5, -1, -1)))


def test_different_beams_differ():
    assert len(set(outcomes(NG, range(5))["crack_length"])) == 5


def test_models_with_and_without_geometric_scatter_share_their_laws():
    seen = []

    def draw(n, rng):
        seen.append(draw_scattered(n, rng))
        return seen[-1]

    ends = [release_beam(replace(NG, draw_laws=draw, scatter=s), 3, beam_stream(3)) for s in (0, 0.025)]
    assert_array_equal(seen[0], seen[1])
    assert_array_equal(seen[0], draw_scattered(1000, beam_stream(3)))
    assert ends[0].crack_length != ends[1].crack_length


def test_no_scatter_means_the_nominal_beam():
    assert scattered_beam(PAPER, 0.0, beam_stream(0)) == PAPER


def test_dimensions_scatter_independently_by_the_given_deviation():
    rng, n = beam_stream(0), 4000
    names = ("thickness", "length", "width", "gap")
    beams = [scattered_beam(PAPER, 0.025, rng) for _ in range(n)]
    ratios = np.array([[getattr(beam, name) / getattr(PAPER, name) for name in names] for beam in beams])
    assert np.all(np.abs(ratios.mean(axis=0) - 1) < 4 * 0.025 / np.sqrt(n))
    spread_error = 0.025 / np.sqrt(2 * n)
    assert np.all(np.abs(ratios.std(axis=0) - 0.025) < 4 * spread_error)
    assert np.all(np.abs(ratios.std(axis=0) - 0.03) > 4 * spread_error)  # control
    correlations = np.corrcoef(ratios.T)[np.triu_indices(4, 1)]
    assert np.all(np.abs(correlations) < 4 / np.sqrt(n))
    assert {(beam.young_modulus, beam.elements) for beam in beams} == {(PAPER.young_modulus, PAPER.elements)}


def test_on_uniform_ground_crack_lengths_scatter_like_root_of_gap_and_thickness():
    # Eq. (13): l ~ h^(1/2) t^(3/4), so 2.5 % of each give 2.5 % √(1/4 + 9/16) = 2.25 %; length and width have no effect
    n = 400
    cracks = outcomes(Experiment(PAPER, 1000, draw_uniform, 0.025), range(n))["crack_length"]
    expected, error = 0.025 * np.sqrt(1 / 4 + 9 / 16), 0.0225 / np.sqrt(2 * n)
    relative = cracks.std(ddof=1) / cracks.mean()
    assert abs(relative - expected) < 4 * error
    assert abs(relative - 0.025 * np.sqrt(1 + 9 / 16)) > 4 * error  # control: l ~ h t^(3/4) is detected


def test_energy_is_eq_13_with_nominal_dimensions():
    ends = outcomes(GEO, range(4))
    assert_allclose(ends["energy"], apparent_adhesion_energy(ends["crack_length"], PAPER), rtol=1e-14)


def test_scatter_of_the_laws_makes_beams_scatter_and_stick_more():
    n = 40
    weak, strong = (
        outcomes(replace(NG, draw_laws=lambda n, rng, v=v: scattered_laws(rng, n, v)), range(n)) for v in (0.1, 0.8)
    )
    errors = [end["energy"].std(ddof=1) / np.sqrt(n) for end in (weak, strong)]
    assert strong["energy"].mean() - weak["energy"].mean() > 4 * np.hypot(*errors)
    assert strong["energy"].std() > 3 * weak["energy"].std()


def test_a_free_beam_has_a_crack_length_and_a_state():
    free = Experiment(PAPER, 1000, lambda n, _: uniform_laws(n, 1e-8, 3.0))
    ends = outcomes(free, range(2))
    assert_array_equal(ends["state"], EndState.FREE)
    assert_array_equal(ends["crack_length"], PAPER.length)


def test_columns_keep_the_given_number_of_shapes():
    ends = columns(list(simulate(NG, range(10, 13), beam_stream)), shapes=2)
    assert_array_equal(ends["sample"], [10, 11, 12])
    assert ends["deflection"].shape == (2, 201)
    assert_allclose(ends["deflection"][:, -1], PAPER.gap, atol=10e-9)  # flat on the ground at its end


def test_released_beams_are_the_first_of_their_streams():
    found, expected = released_beams(NG, 3, beam_stream, threads=2, shapes=2), outcomes(NG, range(3))
    assert_same(found, expected | {"deflection": expected["deflection"][:2]})


def test_errors_state_the_number_of_the_beam():
    broken = replace(NG, draw_laws=lambda n, _: np.full((n, 4), np.nan))
    with pytest.raises(ValueError, match="law 0 ") as error:
        outcomes(broken, [7])
    assert "in beam 7" in error.value.__notes__


def test_a_beam_without_equilibrium_stops_the_study(monkeypatch):
    def fail(*_):
        raise NotConverged("beam", 1.0, 0.1, 3)

    monkeypatch.setattr("stiction.beam.montecarlo.released_beam", fail)
    with pytest.raises(NotConverged):
        outcomes(NG, range(2))


@pytest.mark.parametrize(("field", "value"), [("points", 0), ("points", 1001), ("scatter", -0.1), ("scatter", np.nan)])
def test_an_experiment_is_checked_at_once(field, value):
    with pytest.raises(ValueError, match=str(value)):
        replace(NG, **{field: value})
