"""Exceptions: iterations without convergence, scans without use.

Each passes its arguments on to the class of Python, which needs them to rebuild it in another process.
"""


class NotConverged(RuntimeError):
    """Iteration ended above its tolerance. The message includes its name, residual and tolerance."""

    def __init__(self, subject: str, residual: float, tolerance: float, iterations: int):
        super().__init__(subject, residual, tolerance, iterations)

    def __str__(self):
        subject, residual, tolerance, iterations = self.args
        return f"{subject}: residual {residual:.3g} > {tolerance:.3g} after {iterations} iterations"


class ScanError(ValueError):
    """Error of an unusable scan: one sentence with the key of the configuration and the file."""

    def __init__(self, file: str, key: str, reason: str):
        super().__init__(file, key, reason)
        self.file, self.key, self.reason = file, key, reason

    def __str__(self):
        return f"{self.key}: {self.file} {self.reason}"
