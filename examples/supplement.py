"""What the paper says and its tables do not show: ``python supplement.py FOLDER``, after ``make paper``.

Reads ``results/tables/table_3.csv`` in FOLDER and draws patches of other sizes. Writes ``runs/supplement`` there: the
tables of Greenwood and Williamson's model, of sizes, of surfaces and of shares, and a figure.
"""

import sys
from pathlib import Path

import numpy as np
import pandas as pd
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

import stiction
from stiction.beam.energy import arrest_length
from stiction.config.units import in_si
from stiction.contact.environment import Water
from stiction.contact.materials import Solid
from stiction.contact.meniscus import film, flooded_energy
from stiction.plan.graph import Results
from stiction.plan.plan import Plan
from stiction.report.format import TO_MJ, TO_UM
from stiction.report.style import SINGLE, handles, legend_outside, letter, plain_log, save, styled
from stiction.stages.beams.cantilevers import Cantilevers, cantilever, sections
from stiction.stages.contact.adhesion_parameter import adhesion_parameters, summits
from stiction.stages.contact.curves import energies
from stiction.surface.spectrum import CutoffSelfAffine, autocovariance, correlation_length

#: Widths of strips of 1.5 µm [µm], and humidities at which energies of a pair scatter.
WIDTHS, HUMIDITIES = (30, 10, 3, 1), {"a": 0.6, "b": 0.67, "c": 0.8}
#: Surface pairs of every size.
SAMPLES = 300
#: Least energy of the first panel [mJ/m²], and what each panel shows.
LEAST = 1e-3
TITLES = (
    "Greenwood and Williamson (GW): far too little adhesion",
    r"Few summits scatter less than $A^{-1/2}$",
    "Surfaces scatter weak adhesion",
)
#: What markers and dotted lines are in each panel.
LINES = (
    ("this model, NG", "GW"),
    ("simulated", "$A^{-1/2}$, independent summits"),
    ("scatter by surfaces", "scatter by dimensions"),
)


def main(folder):
    """Write all tables and the figure."""
    config = stiction.load()
    table = pd.read_csv(folder / "results" / "tables" / "table_3.csv", dtype={"pair": str})
    parts = {
        "greenwood_williamson": greenwood_williamson(config, table),
        "sizes": pd.concat([sizes(pair) for pair in HUMIDITIES], ignore_index=True),
        "surfaces": surfaces(config),
        "shares": shares(config, table),
    }
    into = folder / "runs" / "supplement"
    into.mkdir(parents=True, exist_ok=True)
    for name, frame in parts.items():
        frame.to_csv(into / f"{name}.csv", index=False, lineterminator="\n")
        text = frame.to_markdown(index=False, floatfmt=".3g")
        (into / f"{name}.md").write_text(text + "\n", encoding="utf-8")
    save(drawn(parts), into / "supplement.png")


def greenwood_williamson(config, table):
    """Energies and crack lengths of the baseline beside those of models G and NG and the measured lengths."""
    plan, rows, hardness = Plan(config), [], Solid().hardness
    for pair in config["run"]["pairs"]:
        model, beam = summits(plan, pair), cantilever(in_si(Cantilevers, sections(plan, pair)), pair)
        humidities = config["pairs"][pair]["humidities"]
        for humidity, parameter in adhesion_parameters(plan, plan.air, pair, humidities).items():
            energy = model.energy(film(humidity, config["water"]["temperature_K"]))
            of = table[(table.pair == pair) & np.isclose(table.relative_humidity, humidity)].set_index("model")
            rows.append(
                {
                    "pair": pair,
                    "RH": humidity,
                    "ē, GW [mJ/m²]": TO_MJ * energy,
                    "ē, G [mJ/m²]": TO_MJ * of.meso_energy_J_per_m2["G"],
                    "ē, NG [mJ/m²]": TO_MJ * of.meso_energy_J_per_m2["NG"],
                    "l_s, GW [µm]": TO_UM * arrest_length(energy, beam),
                    "l_s, NG [µm]": of.crack_length_um["NG"],
                    "measured [µm]": of.experiment_um["NG"],
                    "θ": parameter,
                    "plasticity index": model.plasticity_index(hardness),
                }
            )
    return pd.DataFrame(rows)


def sizes(pair):
    """Scatter of the energy of patches of a pair against their area."""
    rows = []
    for width in WIDTHS:
        changed = {"beam": {"width_um": width}, "contact": {"samples": SAMPLES, "chunks": 1}, "chaos": {"order": 3}}
        results = Results.of(stiction.load(changed | {"run": {"pairs": [pair]}}))
        found = energies(results[f"contact/{pair}_NG"], HUMIDITIES[pair], Water(300.0))
        cv = found.std(ddof=1) / found.mean()
        rows.append({"pair": pair, "RH": HUMIDITIES[pair], "area [µm²]": 1.5 * width, "cv": cv})
    frame = pd.DataFrame(rows)
    return frame.assign(**{"cv √area [µm]": frame.cv * np.sqrt(frame["area [µm²]"])})


def surfaces(config, strip=(1.5e-6, 30e-6), points=400):
    """Correlation length of the heights of each surface, and correlation of the mean heights of neighbouring strips."""
    rows = []
    length, width = strip
    along, across = np.linspace(0, 2 * length, points), np.linspace(0, 6e-6, points)
    for name, surface in config["surfaces"].items():
        spectrum = in_si(CutoffSelfAffine, surface["published_psd"])
        lags = np.linspace(0, np.hypot(along[-1], across[-1]), 1500)
        heights = autocovariance(spectrum, lags)
        field = np.interp(np.hypot(along[:, None], across), lags, heights)
        over = field @ (2 * (1 - across / width)) * (across[1] - across[0])
        same = 2 * np.maximum(length - along, 0) @ over
        neighbour = np.maximum(length - np.abs(along - length), 0) @ over
        rows.append(
            {
                "surface": name,
                "correlation length [µm]": TO_UM * correlation_length(spectrum),
                "r(1.5 µm)/r(0)": np.interp(length, lags, heights) / heights[0],
                "neighbouring strips": neighbour / same,
            }
        )
    return pd.DataFrame(rows)


def shares(config, table):
    """Γ over that of flooded flats, and the ratio of the variances of Γ by surfaces and by dimensions."""
    flooded = flooded_energy(config["water"]["temperature_K"])
    keys = ["pair", "relative_humidity"]
    plain, scattered = (table[table.model == model].set_index(keys) for model in ("NG", "GEO"))
    relative = [(of.adhesion_energy_std_J_per_m2 / of.adhesion_energy_J_per_m2) ** 2 for of in (plain, scattered)]
    frame = pd.DataFrame(
        {
            "Γ/2γ [%]": 100 * plain.adhesion_energy_J_per_m2 / flooded,
            "ē/2γ [%]": 100 * plain.meso_energy_J_per_m2 / flooded,
            "surfaces [%]": 100 * np.sqrt(relative[0]),
            "dimensions [%]": 100 * np.sqrt(np.maximum(relative[1] - relative[0], 0)),
        }
    ).reset_index()
    return frame.rename(columns={"relative_humidity": "RH"})


@styled
def drawn(parts):
    """Energies of the baseline, scatter against area, and both sources of scatter."""
    figure = Figure(figsize=(SINGLE, 7.6), layout="constrained")
    axes = figure.subplots(3, 1)
    for k, (pair, rows) in enumerate(parts["greenwood_williamson"].groupby("pair")):
        axes[0].semilogy(rows.RH, rows["ē, GW [mJ/m²]"], f"C{k}:")
        axes[0].semilogy(rows.RH, rows["ē, NG [mJ/m²]"], f"C{k}o-", markersize=3, label=pair)
        of_size = parts["sizes"][parts["sizes"].pair == pair]
        axes[1].loglog(of_size["area [µm²]"], of_size.cv, f"C{k}o", markersize=3)
        line = of_size.cv.iloc[0] * np.sqrt(of_size["area [µm²]"].iloc[0] / of_size["area [µm²]"])
        axes[1].loglog(of_size["area [µm²]"], line, f"C{k}:")
        share = parts["shares"][parts["shares"].pair == pair]
        axes[2].loglog(share["Γ/2γ [%]"], share["surfaces [%]"], f"C{k}o-", markersize=3)
        axes[2].loglog(share["Γ/2γ [%]"], share["dimensions [%]"], f"C{k}:")
    axes[0].set(xlabel="relative humidity [–]", ylabel=r"adhesion energy $\bar e$ [mJ/m²]", ylim=(LEAST, None))
    arrow = {"ha": "center", "va": "bottom", "arrowprops": {"arrowstyle": "->"}}
    axes[0].annotate(r"to $10^{-14}$", (0.85, 1.1 * LEAST), (0.78, 4 * LEAST), **arrow)
    axes[1].set(xlabel="area of a patch [µm²]", ylabel=r"std / mean of the energy $\bar e$ [–]")
    axes[2].set(xlabel=r"adhesion energy $\Gamma$, of that of flat wet surfaces $2\gamma$ [%]")
    axes[2].set(ylabel=r"std / mean of $\Gamma$ [%]")
    for axis in (axes[1].xaxis, axes[1].yaxis, axes[2].yaxis):
        plain_log(axis)
    pairs = handles(axes[0])
    legend_outside(figure, (pairs[0], [f"pair {pair}" for pair in pairs[1]]), "lower", 3)
    for panel, names in zip(axes, LINES, strict=True):
        styles = ({"marker": "o", "markersize": 3}, {"linestyle": ":"})
        shown = [Line2D([], [], color="0.3", label=name, **style) for name, style in zip(names, styles, strict=True)]
        panel.legend(handles=shown, loc="lower left")
    letter(axes, TITLES)
    return figure


if __name__ == "__main__":
    main(Path(sys.argv[1]))
