"""Exceptions: iterations that do not converge, scans that cannot be used."""


class NotConverged(RuntimeError):
    """An iteration ended above its tolerance; the message includes its name, residual and tolerance."""

    def __init__(self, what: str, residual: float, tolerance: float, iterations: int):
        super().__init__(f"{what}: residual {residual:.3g} > {tolerance:.3g} after {iterations} iterations")


class ScanError(ValueError):
    """A measured scan that cannot be used; one sentence with the key of the configuration and the file."""

    def __init__(self, file: str, key: str, reason: str):
        super().__init__(f"{key}: {file} {reason}")
        self.file, self.key, self.reason = file, key, reason
