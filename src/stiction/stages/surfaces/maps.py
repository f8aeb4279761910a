"""Maps of heights with labels, for users: of drawn surfaces and of scans."""

import numpy as np
import xarray as xr

from stiction.scans.scan import Scan


def labelled(heights: np.ndarray, pixel: tuple[float, float], name: str) -> xr.DataArray:
    """Map of heights (n1, n2) [m] over x and y [m], points these distances apart [m].

    Its attributes state the name of the surface and the rms about the mean [m]; ``plot()`` of xarray draws it.
    """
    axes = {
        axis: (axis, np.arange(points) * step, {"units": "m"})
        for axis, points, step in zip("xy", heights.shape, pixel, strict=True)
    }
    attributes = {"units": "m", "long_name": f"height of {name}", "rms": float(np.nanstd(heights, dtype=float))}
    return xr.DataArray(heights, axes, ("x", "y"), "height", attributes)


def height_map(scan: Scan) -> xr.DataArray:
    """Heights of a scan, as the file has them, with x along the fast axis [m]. See `labelled`.

    Examples
    --------
    >>> import numpy as np
    >>> waves = np.sin(np.arange(64))[:, None] * np.cos(np.arange(64))
    >>> found = height_map(Scan(1e-9 * waves, (1e-6, 1e-6), "waves"))
    >>> found.dims, found.sizes["x"], round(1e9 * found.attrs["rms"], 1)
    (('x', 'y'), 64, 0.5)
    """
    return labelled(scan.heights, scan.frame.pixel, scan.name)
