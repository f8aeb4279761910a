"""Names of datasets by key, as inputs of stages with many of them."""

from collections.abc import Iterable

from stiction.config.cases import Case

#: A case with its model: pair, relative humidity [-] and model.
Outcome = tuple[str, float, str]
#: Variant that corrects the base case to full elastic contact.
CORRECTED = "contact_full"
#: Key that a variant changes, and its section; the source of the spectrum is a key of each surface.
CHANGED = {
    **{"van_der_waals": None, "psd": None, "asperity": "contact", "every": "contact", "spacing_nm": "sampling"},
    **{"poisson_ratio": "solid", "reach": "attraction", "adsorbed_nm": "water"},
}
#: Key of a variant with a finer mesh.
FINER = "strips_per_element"
#: Pattern of a variant in paths.
VARIANT = f"base|{CORRECTED}|(?:{'|'.join((*CHANGED, FINER))})_[a-z0-9.-]+"


def by_name(folder: str, names: Iterable[str], end: str = "") -> dict[str, str]:
    """Datasets of a folder by surface, pair or device.

    Examples
    --------
    >>> by_name("character", ["B2"], "_NG")
    {'B2': 'character/B2_NG'}
    """
    return {name: f"{folder}/{name}{end}" for name in names}


def by_case(folder: str, cases: Iterable[str], end: str = "") -> dict[tuple[str, float], str]:
    """Datasets of a folder by pair, or device, and humidity.

    Examples
    --------
    >>> by_case("chaos", ["b_rh067"], "_NG")
    {('b', 0.67): 'chaos/b_rh067_NG'}
    """
    return {(case.pair, case.humidity): f"{folder}/{case}{end}" for case in map(Case, cases)}


def by_outcome(folder: str, outcomes: Iterable[tuple[str, str]]) -> dict[tuple[str, float, str], str]:
    """Datasets of a folder by pair, humidity, and model or variant, from cases and models or variants.

    Examples
    --------
    >>> by_outcome("beams", [("b_rh067", "GEO")])
    {('b', 0.67, 'GEO'): 'beams/b_rh067_GEO'}
    """
    datasets = {(Case(case), model): f"{folder}/{case}_{model}" for case, model in outcomes}
    return {(case.pair, case.humidity, model): file for (case, model), file in datasets.items()}


def by_model(folder: str, names: Iterable[str], models: Iterable[str]) -> dict[tuple[str, str], str]:
    """Datasets of a folder by surface or pair, and model.

    Examples
    --------
    >>> by_model("humidity", ["b"], ["G"])
    {('b', 'G'): 'humidity/b_G'}
    """
    models = list(models)
    return {(name, model): f"{folder}/{name}_{model}" for name in names for model in models}
