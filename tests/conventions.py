"""Demands of the CF conventions on a netCDF file that matter to its readers, checked without this package."""

import re

import netCDF4

#: Symbols of UDUNITS, without prefixes, that files may contain.
SYMBOLS = {"m", "s", "kg", "N", "J", "Pa", "V", "K", "rad", "degC", "W", "Hz", "min", "h", "percent", "degree"}


def is_udunits(text):
    """Whether a unit is 1, or a product of symbols with whole powers, such as ``J m-2``."""
    factors = [
        re.fullmatch(r"[num]?([A-Za-z]+?)(-?[1-9])?|([A-Za-z]+)(-?[1-9])?", factor) for factor in text.split(" ")
    ]
    return text == "1" or all(factor and {factor[1], factor[3]} & SYMBOLS for factor in factors)


def faults(path):
    """Faults of a file, one sentence each."""
    sentences = []
    with netCDF4.Dataset(path) as file:
        if not re.fullmatch(r"CF-1\.\d+", getattr(file, "Conventions", "")):
            sentences.append("no Conventions")
        sentences += [f"no {name}" for name in ("title", "source", "references") if not getattr(file, name, "")]
        named = " ".join(
            getattr(variable_or_file, "coordinates", "") for variable_or_file in (file, *file.variables.values())
        ).split()
        coordinates = {*named, *(set(file.dimensions) & set(file.variables))}
        sentences += [f"coordinate {name} is missing" for name in coordinates - set(file.variables)]
        for name, variable in file.variables.items():
            attributes = {key: variable.getncattr(key) for key in variable.ncattrs()}
            sentences += [f"{name}: {fault}" for fault in _faults(name, variable, attributes, name in coordinates)]
    return sentences


def _faults(name, variable, attributes, is_coordinate):
    """Faults of one variable."""
    if not re.fullmatch("[A-Za-z][A-Za-z0-9_]*", name):
        yield "no name"
    if not {"long_name", "standard_name"} & set(attributes):
        yield "neither long_name nor standard_name"
    if is_coordinate and {"_FillValue", "missing_value"} & set(attributes):
        yield "a coordinate with a fill value"
    if "units" in attributes and not is_udunits(attributes["units"]):
        yield f"unit {attributes['units']}"
    if attributes.get("standard_name") == "relative_humidity" and attributes.get("units") != "1":
        yield "a relative humidity that is no fraction"
    if "flag_values" in attributes or "flag_meanings" in attributes:
        values, meanings = attributes.get("flag_values"), attributes.get("flag_meanings", "").split()
        if values is None or values.dtype != variable.dtype or len(values) != len(meanings):
            yield "flags without meanings"
