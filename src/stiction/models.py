"""Names that the whole package shares: models of surfaces and of beams, and the two surfaces of a pair."""

#: Models of the heights: Gaussian and non-Gaussian.
SURFACE_MODELS = ("G", "NG")
#: Models of the beams: GEO has the force laws of NG and beams of scattered dimensions.
BEAM_MODELS = (*SURFACE_MODELS, "GEO")
#: The two surfaces of a pair, in the order in which all sequences contain them.
SIDES = ("beam", "substrate")


def surface_model(model: str) -> str:
    """Model of the heights of the surfaces on which beams of a model stick."""
    return "G" if model == "G" else "NG"
