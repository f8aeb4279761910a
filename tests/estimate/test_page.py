"""Arithmetic of the page in JavaScript beside that of Python, at random questions."""

import json
import math
import shutil
import subprocess
from pathlib import Path

import numpy as np
import pytest

import stiction.estimate.table as table_of_estimate
from stiction.estimate.answer import CONFIDENCES, answer
from stiction.estimate.bridge import Bridge
from stiction.estimate.closed.beams import DryingLiquid
from stiction.estimate.closed.life import Surroundings
from stiction.estimate.force import Stopper
from stiction.estimate.length import NotLearnt
from stiction.estimate.question import Question, surface
from stiction.estimate.solids import SolidPair

NODE = shutil.which("node")
STATES = 200
#: Script that answers questions from standard input.
SCRIPT = """
const input = JSON.parse(require("fs").readFileSync(0, "utf8"));
const answers = input.questions.map((question) => {
  try { return answer({...question, ...sides(question)}, input.table); }
  catch (reason) { if (reason instanceof NotLearnt) return {unknown: reason.message}; throw reason; }
});
function sides({beams, substrate, solids}) {
  const [stated, ...members] = beams.map((beam) => added(heights(beam), heights(substrate)));
  return {stated, members, ...(solids ? {solids: solidsOf(solids)} : {})};
}
function solidsOf({modulus, beam_modulus: beamModulus, through_water: throughWater, in_dry_air: inDryAir, wetting}) {
  return {modulus, beamModulus, throughWater, inDryAir, wetting};
}
console.log(JSON.stringify(answers));
"""


def drawn(rng, of_kind):
    """Random question about a device of a kind, with all numbers of the surface or some typical ones in its place."""
    beams = [
        {
            "rms_nm": math.exp(rng.uniform(0, 2.3)),
            "hurst": rng.uniform(0.4, 2.5),
            "corner_rad_per_um": rng.uniform(8, 60),
            "cutoff_rad_per_um": rng.uniform(90, 290),
            "skewness": rng.uniform(-1.2, 0),
            "kurtosis": rng.uniform(3, 5),
        }
        for _ in range(rng.choice([1, 5]))
    ]
    substrate = beams[0] | {"rms_nm": 0.2, "corner_rad_per_um": 10.0}
    airs, often = rng.uniform(0.4, 0.92, rng.choice([1, 2])).tolist(), int(rng.choice([1, 1000]))
    airs = [*airs[1:], 0.0] if rng.random() < 0.4 else airs
    asked = {"beams": beams, "substrate": substrate, "humidities": airs, "averaged": bool(rng.random() < 0.5)}
    return asked | {"touchdowns": often} | of_solids(rng) | of_kind(rng) | dried(rng)


def dried(rng):
    """Surface tension of a random liquid, zero without one [N/m]."""
    return {"liquid": float(rng.choice([0, rng.uniform(0.01, 0.075)]))}


def of_solids(rng):
    """Nothing, or numbers of random solids and water, a few of which do not wet."""
    if rng.random() < 0.3:
        return {}
    moduli = dict(zip(("modulus", "beam_modulus"), rng.uniform(60e9, 400e9, 2).tolist(), strict=True))
    constants = {"through_water": rng.uniform(5e-21, 3e-19), "in_dry_air": rng.uniform(1e-19, 3.5e-19)}
    solids = moduli | constants | {"wetting": float(rng.choice([-0.1, 2, rng.uniform(0.5, 2)], p=[0.1, 0.3, 0.6]))}
    return {"solids": solids, "temperature": rng.uniform(275, 370)}


def cantilever(rng):
    """Numbers of a random cantilever."""
    device = {"thickness": 2.6e-6, "gap": rng.uniform(5e-6, 25e-6), "width": rng.uniform(8e-6, 40e-6)}
    device |= {"length": rng.uniform(1e-4, 4e-4)}
    device["added"] = float(rng.choice([0, 10 ** rng.uniform(-5, -1)]))  # 0.1 J/m² alone holds many of these lengths
    return device


def bridge(rng):
    """Numbers of a random bridge, a few of them without stress or too thick."""
    device = {
        "thickness": rng.uniform(0.8e-6, 7e-6),
        "gap": rng.uniform(0.5e-6, 5e-6),
        "width": rng.uniform(8e-6, 40e-6),
    }
    device |= {"stress": float(rng.choice([0, rng.uniform(0, 2e8)])), "length": rng.uniform(5e-5, 8e-4)}
    of_voltage = rng.choice([0, 1]) * 10 ** rng.uniform([-5, 3], [-1, 7])
    return device | dict(zip(("added", "tension"), of_voltage.tolist(), strict=True))


def stopper(rng):
    """Numbers of a random stopper, of which a few are too large."""
    device = {"sides": rng.uniform(1e-6, 6.3e-6, 2).tolist(), "force": 10 ** rng.uniform(-6, -3)}
    return device | {"added": float(rng.choice([0, 10 ** rng.uniform(-7, -4)]))}  # more than many forces


def in_python(question, table):
    """Numbers of an answer, or why it is not known."""
    library = table["library"]
    (stated, *members), (other, _) = (
        [surface(one, library)[0] for one in question["beams"]],
        surface(question["substrate"], library),
    )
    own = {key: value for key, value in question.items() if key not in ("beams", "substrate", "humidities", "liquid")}
    own["surroundings"] = Surroundings({"Mine": DryingLiquid(question["liquid"])} if question["liquid"] else {})
    named = {str(k): member for k, member in enumerate(members)}
    of = next((one for key, one in (("sides", Stopper), ("stress", Bridge)) if key in question), Question)
    if "solids" in own:
        own["solids"] = SolidPair(**own["solids"])
    asked = of("", (stated, other), (named, {}), tuple(question["humidities"]), **own)
    try:
        found = answer(asked, table, table_of_estimate.process("tips"), table_of_estimate.process("full"))
    except NotLearnt as reason:
        return str(reason)
    rows = [[row.size, *(end for name in CONFIDENCES for end in row.intervals[name])] for row in found.rows]
    flat = [found.flat.size, *([] if found.flat.at_tip is None else [found.flat.at_tip])]
    return [*np.ravel(rows), *found.stuck, *life_of(found), *flat]


def life_of(found):
    """Lengths of beams that dry, and the shock: none of a stopper, to which the page gives no mass."""
    dried = [length for each in found.dried.values() for length in each.lengths]
    return [] if found.is_force else [*dried, found.touching.shock]


def in_javascript(answers):
    """The same of the answers of the script."""
    for found in answers:
        if "unknown" in found:
            yield found["unknown"]
        else:
            rows = [
                [row["size"], *(end for name in CONFIDENCES for end in row["intervals"][name])] for row in found["rows"]
            ]
            life = [*(found["life"]["dried"] or []), found["life"]["shock"]] if found["life"] else []
            flat = [found["flat"][name] for name in ("size", "tip") if found["flat"].get(name) is not None]
            yield [*np.ravel(rows), *found["stuck"], *life, *flat]


@pytest.mark.skipif(NODE is None, reason="node is not on this machine")
@pytest.mark.parametrize("of_kind", [cantilever, bridge, stopper])
def test_the_page_computes_what_python_does(of_kind):
    rng, table = np.random.default_rng(7), table_of_estimate.content()
    questions = [drawn(rng, of_kind) for _ in range(STATES)]
    source = Path(table_of_estimate.FILE).with_name("estimate.js").read_text(encoding="utf-8") + SCRIPT
    given = json.dumps({"questions": questions, "table": table})
    done = subprocess.run([NODE, "-e", source], input=given, capture_output=True, text=True, check=True)
    numbers = 0
    for question, found in zip(questions, in_javascript(json.loads(done.stdout)), strict=True):
        expected = in_python(question, table)
        if isinstance(expected, str):
            assert found == expected
        else:
            np.testing.assert_allclose(found, expected, rtol=1e-6, atol=1e-12)
            numbers += 1
    assert numbers > STATES / 10
