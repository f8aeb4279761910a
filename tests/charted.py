"""Chart of a device with known numbers, for tests of its tables and figures."""

import numpy as np
import xarray as xr

S_SHAPE, EITHER = "S-shape", "S-shape or arc"


def charted(humidity, factor=1.0, error=0.004):
    """Dataset of stage chart, in which a power law gave the thinner beam at the wider gap."""
    lengths = factor * 1e-6 * np.arange(100, 116).reshape(2, 2, 2, 2)
    limits = 1e-6 * np.arange(50, 58).reshape(2, 2, 2)
    return xr.Dataset(
        {
            "safe_length": (("thickness", "gap", "shape", "share"), lengths),
            "flooded_length": (("thickness", "gap", "shape"), limits),
            "by_elements": (("thickness", "gap"), [[1, 0], [1, 1]]),
            "power_law_error": error,
            "film": 1e-9 if humidity else 0.0,
            "humidity": humidity,
        },
        coords={"thickness": [2e-6, 3e-6], "gap": [10e-6, 20e-6], "shape": [S_SHAPE, EITHER], "share": [1e-2, 1e-3]},
    )
