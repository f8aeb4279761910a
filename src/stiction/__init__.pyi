"""Public names of the package by the modules that define them: for editors, and read when the package is imported."""

# configuration, study of a pair of surfaces, and devices
from stiction.config.files import load as load
from stiction.config.cases import case_id as case_id
from stiction.study import PairStudy as PairStudy
from stiction.device import Device as Device
from stiction.process import Process as Process
from stiction.run.opened import open as open
from stiction.progress import show_progress as show_progress

# surfaces
from stiction.described_surface import Surface as Surface
from stiction.surface.maxent import solve as maximum_entropy
from stiction.surface.maxent import HeightDensity as HeightDensity
from stiction.surface.spectrum import CutoffSelfAffine as CutoffSelfAffine
from stiction.surface.spectrum import TabulatedSpectrum as TabulatedSpectrum
from stiction.surface.translation import Translation as Translation
from stiction.surface.translation import underlying_spectrum as underlying_spectrum
from stiction.surface.field import StripGrid as StripGrid
from stiction.surface.field import RoughSurface as RoughSurface

# measured surfaces
from stiction.scans.reading import read as read_scan
from stiction.scans.scan import Scan as Scan
from stiction.stages.surfaces.maps import height_map as height_map
from stiction.scans.estimate import estimate as estimate_surface
from stiction.scans.estimate import SurfaceEstimate as SurfaceEstimate
from stiction.analysis.facing import facing_coherence as facing_coherence
from stiction.analysis.facing import FacingCoherence as FacingCoherence

# contact and force laws
from stiction.contact.vanderwaals import DugdaleAttraction as DugdaleAttraction
from stiction.contact.vanderwaals import attraction as attraction
from stiction.contact.asperity import reduced_modulus as reduced_modulus
from stiction.contact.asperity import asperity as asperity
from stiction.contact.asperity import MaugisTable as MaugisTable
from stiction.contact.asperity import HertzAsperity as HertzAsperity
from stiction.contact.pair import SurfacePair as SurfacePair
from stiction.stages.laws.forces import vectors as force_vectors
from stiction.contact.forcelaw import coefficients as force_laws
from stiction.contact.forcelaw import pressure as law_pressure
from stiction.contact.forcelaw import energy as law_energy
from stiction.chaos.model import ChaosModel as ChaosModel
from stiction.chaos.model import fit as fit_chaos
from stiction.stages.laws.stored_model import chaos_model as chaos_model
from stiction.chaos.model import draw_laws as draw_laws

# beams
from stiction.beam.cantilever import Beam as Beam
from stiction.beam.release import EndState as EndState
from stiction.beam.release import release as release

# random numbers and errors
from stiction.streams import stream as stream
from stiction.config.messages import ConfigError as ConfigError
from stiction.errors import NotConverged as NotConverged

__version__: str
