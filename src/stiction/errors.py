"""Exception for iterations that do not converge."""


class NotConverged(RuntimeError):
    """An iteration ended above its tolerance; the message includes its name, residual and tolerance."""

    def __init__(self, what: str, residual: float, tolerance: float, iterations: int):
        super().__init__(f"{what}: residual {residual:.3g} > {tolerance:.3g} after {iterations} iterations")
