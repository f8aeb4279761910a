"""The table of the estimate is that of the code: control numbers, page, and the design that it was learnt from."""

import hashlib
from pathlib import Path

import numpy as np
import pytest

from stiction.command.at_once import estimate
from stiction.estimate import dry as of_dry_air
from stiction.estimate.answer import CONFIDENCES, TO_USE
from stiction.estimate.bridge import COORDINATES as OF_BRIDGES
from stiction.estimate.dry_bridge import COORDINATES as OF_DRY_BRIDGES
from stiction.estimate.learning import dry, dry_bridges, dry_patches
from stiction.estimate.learning.design import FILMS, SurfaceLaw, points, states
from stiction.estimate.learning.jobs import control
from stiction.estimate.learning.training import SETS
from stiction.estimate.page import page
from stiction.estimate.state import COORDINATES, OF_PATCHES
from stiction.estimate.table import FILE, Surrogate, content, origin, process
from stiction.progress import without_progress

DOCS = Path(__file__).parents[2] / "docs"
AGAIN = "tips, patches or bridges have changed since the estimate was learnt: run make surrogate"


def test_tips_patches_and_bridges_are_still_those_that_were_learnt():
    with without_progress():
        slopes, pressures, held = control.slopes(), control.of_patches(), control.of_bridges()
    np.testing.assert_allclose(slopes, content()["control"]["slopes"], rtol=1e-4, err_msg=AGAIN)
    np.testing.assert_allclose(pressures, content()["control"]["patches"], rtol=1e-4, err_msg=AGAIN)
    np.testing.assert_allclose(held, content()["control"]["bridges"], rtol=1e-4, err_msg=AGAIN)


def test_contacts_in_dry_air_are_still_those_that_were_learnt():
    with without_progress():
        found = dry.control() | dry_patches.control() | dry_bridges.control()
    for name, values in content()["dry"]["control"].items():
        np.testing.assert_allclose(found[name], values, rtol=1e-3, err_msg=AGAIN)


@pytest.mark.slow
def test_full_contact_is_still_the_one_that_was_learnt():
    with without_progress():
        forces = control.forces()
    np.testing.assert_allclose(forces, content()["control"]["forces"], rtol=1e-3, err_msg=AGAIN)


def test_the_table_is_small_and_the_page_of_the_docs_has_it():
    assert FILE.stat().st_size < 1e6
    assert (DOCS / "_static" / "estimate.html").read_text(encoding="utf-8") == page()
    assert len(page()) < 2e6


def test_the_table_has_what_the_estimate_reads():
    stoppers, bridges = content()["stoppers"], content()["bridges"]
    assert list(COORDINATES) == content()["coordinates"]
    assert list(OF_PATCHES) == stoppers["coordinates"]
    assert list(OF_BRIDGES) == bridges["coordinates"]
    in_dry_air = content()["dry"]
    assert list(of_dry_air.OF_TIPS) == in_dry_air["coordinates"]
    assert list(of_dry_air.OF_PATCHES) == in_dry_air["stoppers"]["coordinates"]
    assert list(OF_DRY_BRIDGES) == in_dry_air["bridges"]["coordinates"]
    for part in (content(), stoppers, bridges, in_dry_air, in_dry_air["stoppers"], in_dry_air["bridges"]):
        first, last = (part["margins"][name] for name in CONFIDENCES)
        assert 0 < first <= part["margins"][TO_USE] <= last < 5
    others = [Surrogate(**part[name]) for part, name in ((stoppers, "forces"), (bridges, "middle"))]
    others += [Surrogate(**part["full"]) for part in (stoppers, bridges)]
    others += [Surrogate(**in_dry_air["bridges"]["middle"])]
    for one in (process("tips"), process("full"), *others):
        assert len(one.nodes[0]) == len(one.columns)


@pytest.mark.parametrize("law", [SurfaceLaw.ANY, SurfaceLaw.TYPICAL])
def test_more_points_begin_with_fewer_and_other_seeds_are_other_surfaces(law):
    assert points(9, 1, law)[:4] == points(4, 1, law)
    assert not {str(point.sides) for point in points(9, 1, law)} & {str(point.sides) for point in points(9, 2, law)}


def test_films_of_a_point_are_within_their_range_and_its_own():
    films = states(8, 3, 1)[:, 0]
    assert np.all((films >= 1e-9 * FILMS[0]) & (films <= 1e-9 * FILMS[1]))
    np.testing.assert_array_equal(films, states(8, 3, 1)[:, 0])
    assert not np.any(films == states(8, 4, 1)[:, 0])


#: What surfaces are drawn for.
USES = ("learn", "decide", "check")


def test_help_and_page_say_from_what_the_table_is_learnt(capsys):
    points = {use: sum(effort.points for name, effort in SETS.items() if name.startswith(use)) for use in USES}
    digest = hashlib.sha256(FILE.read_bytes()).hexdigest()
    for word in (*map(str, points.values()), digest[:8]):
        assert word in origin()
    assert f">{origin()}</p>" in page()
    with pytest.raises(SystemExit):
        estimate.main(["-h"])
    assert origin() in " ".join(capsys.readouterr().out.split())
