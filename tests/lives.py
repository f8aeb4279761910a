"""Keys of a beam and of a stopper whose lives tests ask for."""

import numpy as np
from ground import C1

from stiction.stages.life.inputs import BeamErrors, BeamKeys, Electrode, Liquid, StopperKeys

LIQUIDS = {"water": Liquid(0.072), "mine": Liquid(0.03, np.pi / 3)}
OF = BeamKeys(device=C1, density=2330.0, liquids=LIQUIDS, uncertainty=BeamErrors())
AREA = (3e-6, 3e-6)
UNSTATED = {"restoring_force": 18.99e-6, "contact": AREA}
STOPPER = StopperKeys(
    restoring_force=18.99e-6,
    contact=AREA,
    stiffness=10.0,
    gap=1.899e-6,
    mass=50e-12,
    electrode=Electrode(1e-8, 3e-6),
    touchdowns=4,
)
