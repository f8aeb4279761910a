"""Study mesh (App. C, Fig. 19): crack length on one force law for meshes of increasing fineness."""

import warnings
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
import xarray as xr

from stiction.analysis.mesh import Arrest, arrest_on_uniform_ground, whole_meshes
from stiction.beam.foundation import ELEMENT, STRIP, foundation_length
from stiction.config.units import from_si
from stiction.contact import forcelaw
from stiction.errors import NotConverged
from stiction.plan.stage import Stage
from stiction.progress import progress
from stiction.stages.beams.cantilevers import Cantilevers, cantilever, sections
from stiction.stages.laws import forces as stage_forces


@dataclass(frozen=True)
class Meshes:
    """Meshes of the study. Combinations not filling each other and the beam are left out."""

    elements: tuple[float, ...]  #: lengths of the elements [m]
    strips: tuple[float, ...]  #: distances of the contact points [m]


@dataclass(frozen=True, kw_only=True)
class Settings(Cantilevers):
    """Settings of the study, without the forces."""

    mesh: Meshes
    case: str
    pair: str


def compute(forces: xr.Dataset, settings: Settings) -> xr.Dataset:
    """Release beams on uniform ground with increasingly fine meshes.

    Raises
    ------
    ValueError
        If no mesh resolves the crack; the message contains the lengths that would.
    """
    distance, curves = stage_forces.curves(forces)
    # ASSUME: the single realisation of the paper is a typical one: of the stored curves, that with the median energy.
    sample = stage_forces.typical(forces)
    samples, limit = stage_forces.vectors(forces)
    law = forcelaw.coefficients(samples[[sample]], limit)[0]
    beam = cantilever(settings, settings.pair)
    arrests = {}
    for element, point in progress(whole_meshes(beam.length, settings.mesh.elements, settings.mesh.strips), "meshes"):
        ground = replace(beam, elements=round(beam.length / element)), law, round(beam.length / point)
        try:
            arrests[element, point] = arrest_on_uniform_ground(*ground)
        except (ValueError, NotConverged) as reason:  # the elements are too long for the crack or for the law
            warnings.warn(f"left out elements of {from_si(element, 'um'):.3g} µm: {reason}", stacklevel=2)
    if not arrests:
        length = from_si(foundation_length(beam, law[None]), "um")
        raise ValueError(
            f"no mesh of studies.mesh resolves the crack: take elements of at most {ELEMENT * length:.3g} µm and "
            f"strips of at most {STRIP * length:.3g} µm"
        )
    return layout([*arrests], [*arrests.values()], law, (distance, curves[sample]))


def layout(
    meshes: Sequence, arrests: Sequence[Arrest], law: np.ndarray, curve: tuple[np.ndarray, np.ndarray]
) -> xr.Dataset:
    """Crack length and energy on uniform ground for meshes of increasing fineness.

    Each mesh has a length of the elements and a distance of the contact points [m]. The law of the ground (4,) [SI]
    approximates a sample with these distances [m] and forces [Pa], (n_d,) each.
    """
    elements, points = np.transpose(meshes)
    distance, force = curve
    return xr.Dataset(
        {
            "element_length": ("mesh", elements),
            "point_distance": ("mesh", points),
            "crack_length": ("mesh", [a.crack_length for a in arrests]),
            "energy": ("mesh", [a.energy for a in arrests]),
            "law": ("coefficient", law),
            "force": ("distance", force),
        },
        coords={
            "coefficient": ["f_max", "d_max", "a_left", "a_right"],
            "distance": ("distance", distance),
        },
    )


STAGES = (
    Stage.writing(
        "mesh",
        "studies/mesh",
        inputs=lambda plan, at: {"forces": f"forces/{plan.figure_case}_NG"},
        settings=lambda plan, at: (
            {
                "mesh": plan.config["studies"]["mesh"],
                "case": plan.figure_case,
                "pair": plan.figure_pair,
            }
            | sections(plan, plan.figure_pair)
        ),
        kind=Settings,
        compute=compute,
        message="Convergence of the crack length in the mesh of the beam (App. C).",
    ),
)
