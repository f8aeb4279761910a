"""How well Eq. (12) stands for the force curves: a table with one row per case and model (Fig. 5)."""

import numpy as np
import pandas as pd

from stiction.estimates import mean_with_error


def fit_quality(fits):
    """Relative errors of curve and energy over all samples.

    Parameters
    ----------
    fits : dict
        (pair, humidity, model) to the dataset of stage fit.
    """
    return pd.DataFrame([_row(key, fit) for key, fit in fits.items()])


def _row(key, fit):
    """Case, share of samples without a law, and errors of those with one."""
    row = dict(zip(("pair", "relative_humidity", "model"), key, strict=True))
    curve, energy = 100 * fit.curve_error.values, 100 * fit.energy_error.values
    mean, error = mean_with_error(curve)
    return row | {
        "samples": len(curve),
        "share_without_law": float(fit.without_law),
        "curve_error_percent": mean,
        "curve_error_se_percent": error,
        "curve_error_median_percent": np.median(curve),
        "curve_error_95_percent": np.quantile(curve, 0.95),
        "energy_error_max_percent": energy.max(),
    }


def markdown_fit(table):
    """The table for reading."""
    rows = [
        {
            "pair": row.pair,
            "RH": f"{row.relative_humidity:g}",
            "model": row.model,
            "curve [%]": f"{row.curve_error_percent:.2f} ± {row.curve_error_se_percent:.2f}",
            "median [%]": f"{row.curve_error_median_percent:.2f}",
            "95 % of samples below [%]": f"{row.curve_error_95_percent:.1f}",
            "ē at most [%]": f"{row.energy_error_max_percent:.0e}",
            "without law [%]": f"{100 * row.share_without_law:.2g}",
        }
        for _, row in table.iterrows()
    ]
    caption = (
        "Fit by Eq. (12): relative error of the curve for d ≥ d_limit, mean ± standard error, and of the energy ē."
    )
    return caption + "\n\n" + pd.DataFrame(rows).to_markdown(index=False) + "\n"
