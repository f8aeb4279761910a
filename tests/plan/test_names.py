"""Names of datasets by key are those that the stages write, so that no file can be confused with another."""

import pytest

from stiction.config.files import load
from stiction.plan import names
from stiction.plan.graph import Graph
from stiction.plan.plan import Plan

PLAN = Plan(load({"run": {"pairs": ["a", "b"]}}))
GRAPH = Graph(PLAN)


@pytest.mark.parametrize(
    "named",
    [
        names.by_name("character", PLAN.surfaces, "_NG"),
        names.by_case("chaos", PLAN.cases, "_NG"),
        names.by_outcome("beams", PLAN.outcomes),
        names.by_outcome("studies/variants", PLAN.variants.cases),
        names.by_model("humidity", PLAN.pairs, ("G", "NG")),
    ],
)
def test_a_key_holds_the_wildcards_of_its_file(named):
    assert len(set(named.values())) == len(named)
    for key, name in named.items():
        at = vars(GRAPH.job(name).at)
        if "case" in at:
            parts = (names.Case(at["case"]).pair, names.Case(at["case"]).humidity)
            assert key == (*parts, *(at[word] for word in ("model", "variant") if word in at and len(key) > 2))
        else:
            values = [at[word] for word in ("surface", "pair", "model") if word in at]
            assert key == values[0] or list(key) == values
