"""How an iteration says that it failed."""


class NotConverged(RuntimeError):
    """An iteration ended above its tolerance; the message says which one and how far it got."""

    def __init__(self, what, residual, tolerance, iterations):
        super().__init__(f"{what}: residual {residual:.3g} > {tolerance:.3g} after {iterations} iterations")
