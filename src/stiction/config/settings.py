"""The configuration: read it, and refuse what cannot run with the key, its value and what would be allowed.

The schema bounds every key by itself. What must hold between keys is a law below: a function of their values
that returns ``None`` or the sentence that the values break. Values keep the units of their keys.
"""

import difflib
import functools
import itertools
import math
import re
from collections import Counter
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import yaml
from jsonschema import Draft202012Validator, validators

from stiction.config.cases import NAMEABLE, decimals, merged
from stiction.config.units import si
from stiction.errors import NotConverged
from stiction.surface import maxent
from stiction.surface.spectrum import CutoffSelfAffine, correlation_length
from stiction.surface.translation import LARGEST_SCORE


class ConfigError(ValueError):
    """A configuration that cannot run; one line per problem."""

    @property
    def problems(self):
        """The lines, each of which names a key [tuple of str]."""
        return self.args

    def __str__(self):
        return "\n".join(self.problems)


def read(path):
    """Mapping in one YAML file.

    Raises
    ------
    ConfigError
        If the file cannot be read, is no mapping, or gives a key twice.
    """
    try:
        with Path(path).open(encoding="utf-8") as file:
            content = yaml.load(file, _UniqueKeys)
    except Exception as reason:  # PyYAML lets through whatever it meets: !!bool x is a KeyError
        raise ConfigError(f"{path} cannot be read: {' '.join(str(reason).split())}") from reason
    if not isinstance(content, dict):
        raise ConfigError(f"{path} holds {_shown(content)}, must be sections such as 'contact: {{samples: 5000}}'")
    return content


def load(paths, schema):
    """Configuration in YAML files, later ones changing single keys of earlier ones, validated.

    Parameters
    ----------
    paths : sequence of str or Path
        Files, the complete one first.
    schema : dict
        JSON schema of the configuration.

    Returns
    -------
    dict

    Raises
    ------
    ConfigError
        With all problems found.
    """
    config = functools.reduce(merged, map(read, paths))
    validate(config, schema)
    return config


def _twins(items):
    """Those of the items that occur more than once."""
    return [item for item, count in Counter(items).items() if count > 1]


class _UniqueKeys(yaml.SafeLoader):
    """YAML in which no mapping gives a key twice: PyYAML would drop the first value without a word."""

    def construct_mapping(self, node, deep=False):  # noqa: ARG002
        keys = [key for key, _ in node.value if key.tag != "tag:yaml.org,2002:merge"]
        # Deep construction also refuses a mapping that contains itself.
        mapping = super().construct_mapping(node, deep=True)
        for key in _twins(self.construct_object(key, deep=True) for key in keys):
            raise yaml.constructor.ConstructorError(None, None, f"key {key!r} is given twice", node.start_mark)
        return mapping


_UniqueKeys.add_constructor("tag:yaml.org,2002:map", _UniqueKeys.construct_mapping)


@dataclass(frozen=True)
class _Problem:
    path: tuple  #: keys and list indices from the root
    said: str  #: the rest of the sentence that begins with the path

    def __str__(self):
        return f"{_dotted(self.path)} {self.said}"


def validate(config, schema):
    """Check a configuration against its schema and the laws between its keys.

    Parameters
    ----------
    config : dict
        Merged configuration.
    schema : dict
        JSON schema of the configuration.

    Raises
    ------
    ConfigError
        With all problems found, one line each: full key, value, what would be allowed.
    """
    faults = _schema_problems(config, schema)
    problems = faults + _law_problems(config, [fault.path for fault in faults])
    if problems:
        raise ConfigError(*dict.fromkeys(map(str, problems)))


def _schema_problems(config, schema):
    """Keys that break the schema, each by itself."""
    try:
        return [problem for error in _Strict(schema).iter_errors(config) for problem in _explained(error, schema)]
    except (ValueError, RecursionError) as reason:
        # Python refuses to print very long integers and very deep nesting, which jsonschema does in each error.
        return [_Problem((), f"cannot be printed ({reason}): must hold short numbers in few levels")]


def _is_number(_, value):
    """Whether a value is a finite real number; truth values, NaN and infinities are not."""
    return isinstance(value, int | float) and not isinstance(value, bool) and abs(value) < 1e300


def _is_integer(_, value):
    """Whether a value is a whole number written as one: 5000.0 is not."""
    return _is_number(_, value) and isinstance(value, int)


_Strict = validators.extend(
    Draft202012Validator,
    type_checker=Draft202012Validator.TYPE_CHECKER.redefine_many({"number": _is_number, "integer": _is_integer}),
)


def _explained(error, schema):
    """Problems behind one error of jsonschema."""
    path, value = tuple(error.absolute_path), error.instance
    if "propertyNames" in error.absolute_schema_path:
        return [_Problem((*path, value), f"is no name, must be letters and digits, a letter first{_name_hint(value)}")]
    if error.validator == "required":
        missing = [(*path, key) for key in error.validator_value if key not in value]
        return [_Problem(key, f"is missing, must be {_allowed(_entry(schema, key))}") for key in missing]
    if error.validator == "additionalProperties":
        known = list(error.schema["properties"])
        return [_Problem((*path, key), _unknown(key, value[key], known)) for key in value if key not in known]
    return [_Problem(path, f"is {_shown(value)}, must be {_allowed(error.schema)}{_hint(value, error.schema)}")]


def _entry(schema, path):
    """Part of the schema that describes the key at ``path``, which has no list on its way."""
    for key in path:
        schema = schema.get("properties", {}).get(key) or schema["additionalProperties"]
    return schema


#: Keywords of the schema in words.
_KINDS = {"array": "a list", "integer": "a whole number", "number": "a number", "object": "a section", "string": "text"}
_BOUNDS = {"exclusiveMinimum": "above", "minimum": "at least", "exclusiveMaximum": "below", "maximum": "at most"}


def _allowed(entry):
    """What a schema entry allows, in words, with meaning and unit."""
    words = [f"one of {', '.join(entry['enum'])}" if "enum" in entry else _KINDS[entry["type"]]]
    words.append(" and ".join(f"{word} {entry[bound]}" for bound, word in _BOUNDS.items() if bound in entry))
    if entry.get("properties"):
        words.append(f"with the keys {', '.join(entry['properties'])}")
    if "minItems" in entry or "minProperties" in entry:
        words.append("with at least one entry")
    return f"{' '.join(filter(None, words))}: {entry['description']}"


def _unknown(key, value, known):
    """Sentence about a key that the schema does not know."""
    with_unit = [name for name in known if name.startswith(f"{key}_")]
    question = _question(with_unit or _closest(key, known))
    unit = " Keys carry their unit." if with_unit else ""
    return f"is unknown (value {_shown(value)}), must be one of {', '.join(known)}{question}{unit}"


def _closest(word, known):
    """The one of ``known`` that ``word`` misspells, as a list of at most one."""
    return difflib.get_close_matches(str(word), known, n=1)


def _question(meant):
    """Ask whether the first of ``meant`` was meant; nothing if there is none."""
    return f"; did you mean {meant[0]}?" if meant else ""


def _hint(value, entry):
    """How a value of the wrong kind may have come about, or nothing."""
    if value is None:
        return "; nothing was written after the key"
    if isinstance(value, bool):
        return "; YAML reads yes, no, on, off, true and false as truth values"
    if entry["type"] == "array" and not isinstance(value, list):
        return f"; write [{value}]"
    if isinstance(value, str):
        return _question(_closest(value.lower(), entry["enum"])) if "enum" in entry else _number_hint(value, entry)
    if isinstance(value, float) and entry["type"] == "integer" and value.is_integer():
        return f"; write it without a decimal point: {value:.15g}"
    return ""


def _number_hint(text, entry):
    """How to write a number that YAML read as text."""
    parts = re.fullmatch(r"([-+]?\d+(?:[.,]\d*)?)(?:[eE]([-+]?\d{1,2}))?\s*([^\W\d][^%]*)?", text)
    if entry["type"] not in ("number", "integer") or not parts:
        return ""
    mantissa, exponent, unit = parts[1].replace(",", "."), parts[2], parts[3]
    value = float(f"{mantissa}e{exponent or 0}")
    whole = entry["type"] == "integer" and value.is_integer()
    written = f"{value:.15g}" if whole else f"{float(mantissa)}e{int(exponent):+d}" if exponent else mantissa
    if exponent and not unit:
        return f"; YAML reads {text} as text, write {written}"
    return f"; write {written} without quotes, unit or decimal comma"


def _name_hint(name):
    """Why YAML may not have read a name as text."""
    if isinstance(name, bool):
        return "; YAML reads yes, no, on, off, true and false as truth values"
    return ", at most 32 of them" if isinstance(name, str) else "; YAML read it as something other than text"


def _dotted(path):
    """Path as in ``pairs.a.humidities[1]``."""
    text = "".join(f"[{key}]" if type(key) is int else f".{_plain(key)}" for key in path)
    return text.removeprefix(".") or "configuration"


def _plain(key):
    """A key as it is if that is one word, else as Python shows it."""
    return key if isinstance(key, str) and re.fullmatch(r"\w+", key) else _shown(key)


def _shown(value):
    """Value as one short line."""
    text = repr(value)
    return text if len(text) <= 100 else f"{text[:80]} …"


_LAWS = []


def law(*keys):
    """Register a relation between keys; it is asked only about values that pass the schema.

    The values are the arguments of the relation, in order; the first key is the one to blame. In a key ``*`` is each
    name of a section or each place in a list in turn, the same in all keys, and ``#`` the list of a section's names.
    """

    def register(relation):
        _LAWS.append((keys, relation))
        return relation

    return register


def _law_problems(config, faults):
    """Laws that the configuration breaks, where the keys they ask for are without fault."""
    asked = ((relation, keys) for laws, relation in _LAWS for keys in _spelled_out(laws, config))
    return [problem for relation, keys in asked for problem in _judged(relation, keys, config, faults)]


def _spelled_out(keys, config):
    """The paths of the keys, once for each choice of what the ``*`` stand for."""
    paths = [tuple(key.split(".")) for key in keys]
    sections = list(dict.fromkeys(path[: path.index("*")] for path in paths if "*" in path))
    choices = itertools.product(*(_members(config, section) for section in sections))
    return [[_chosen(path, dict(zip(sections, choice, strict=True))) for path in paths] for choice in choices]


def _chosen(path, members):
    """A path in which ``*`` is the chosen member of its section."""
    if "*" not in path:
        return path
    depth = path.index("*")
    return (*path[:depth], members[path[:depth]], *path[depth + 1 :])


def _members(config, path):
    """Names in a section or places in a list; none if there is neither."""
    try:
        found = _value(config, path)
    except (KeyError, TypeError):
        return []
    return range(len(found)) if isinstance(found, list) else _names(found)


def _judged(relation, paths, config, faults):
    """The problem, if any, of one relation at the values of the paths."""
    if any(_overlap(path, fault) for path in paths for fault in faults):
        return []
    try:
        values = [_value(config, path) for path in paths]
    except KeyError:  # an optional key that is not given
        return []
    said = relation(*values)
    if said is None:
        return []
    return [_Problem(paths[0], f"is {_shown(values[0])}, {said}{_given(paths[1:], values[1:])}")]


def _given(paths, values):
    """The other values that a broken law asked for."""
    others = [
        f"{_dotted(path)} = {_shown(value)}" for path, value in zip(paths, values, strict=True) if path[-1] != "#"
    ]
    return f" (given {', '.join(others)})" if others else ""


def _overlap(path, fault):
    """Whether a fault lies at, above or below a path."""
    depth = min(len(path), len(fault))
    return path[:depth] == fault[:depth]


def _value(config, path):
    """Value at a path."""
    for key in path:
        config = _names(config) if key == "#" else config[key]
    return config


def _names(section):
    """Names in a section; none if it is no section."""
    return [name for name in section if isinstance(name, str)] if isinstance(section, dict) else []


@law("run.pairs")
def selection_has_no_twins(names):
    """A pair runs once."""
    twins = _twins(names)
    return f"must name each pair once; {_shown(twins[0])} is there twice" if twins else None


@law("run.pairs", "pairs.#")
@law("studies.plasticity.distance_nm", "pairs.#")
def selected_pairs_exist(names, pairs):
    """Only defined pairs can run."""
    return next((f"{said}; {_shown(name)} is not" for name in names if (said := name_is_defined(name, pairs))), None)


@law("pairs.*.beam", "surfaces.#")
@law("pairs.*.substrate", "surfaces.#")
@law("figures.pair", "pairs.#")
def name_is_defined(name, defined):
    """Only what is defined can be referred to."""
    return None if name in defined else f"must be one of {', '.join(defined)}{_question(_closest(name, defined))}"


@law("pairs.*.humidities")
def cases_have_names_of_their_own(humidities):
    """A humidity of a pair has one name, and no other has it."""
    nameless = [humidity for humidity in humidities if not decimals(humidity)]
    if nameless:
        return f"must each {NAMEABLE}; {nameless[0]} has more"
    twins = _twins(humidities)
    return f"must hold each humidity once; {twins[0]} is there twice" if twins else None


@law("figures.humidity")
def humidity_of_the_figures_has_a_name(humidity):
    """The humidity of the figures is a case like the others."""
    return None if decimals(humidity) else f"must {NAMEABLE}"


@law("surfaces.*.kurtosis", "surfaces.*.skewness")
def heights_have_a_density(kurtosis, skewness):
    """Heights with these moments exist, and the maximum-entropy density of Eq. (3) among them."""
    if kurtosis <= skewness**2 + 1:
        return f"must be above skewness² + 1 = {skewness**2 + 1:.6g}"
    try:
        density = maxent.solve(skewness, kurtosis)
        density.quantile_of_normal(np.array([-LARGEST_SCORE, LARGEST_SCORE]))
    except (ValueError, NotConverged) as reason:
        return f"must allow a density of the heights: {reason}"
    return None


@law("surfaces.*.published_psd.corner_rad_per_um", "surfaces.*.published_psd.cutoff_rad_per_um")
def corner_lies_below_the_cutoff(corner, cutoff):
    """Roughness decays between the corner and the cut-off, Eq. (7)."""
    return None if corner < cutoff else "must be below the cut-off"


@law("surfaces.*.published_psd.floor_nm4", "surfaces.*.published_psd.plateau_nm4")
def spectrum_falls(floor, plateau):
    """The power law of Eq. (7) has a negative exponent."""
    return None if floor < plateau else "must be below the plateau"


@law("surfaces.*.published_psd.cutoff_rad_per_um", "sampling.spacing_nm")
def grid_carries_the_roughness(cutoff, spacing):
    """The cut-off lies within the Nyquist number of the grid."""
    nyquist = math.pi / spacing * 1e3
    return None if cutoff <= nyquist else f"must be at most the Nyquist number of the grid, {nyquist:.6g} rad/µm"


@law("studies.readings.spacing_nm.*", "surfaces.*.published_psd.cutoff_rad_per_um")
def other_grid_carries_the_roughness(spacing, cutoff):
    """The cut-off lies within the Nyquist number of the grid of a reading."""
    largest = math.pi / cutoff * 1e3
    return None if spacing <= largest else f"must be at most {largest:.6g} nm, for the Nyquist number of the grid"


@law("studies.readings.spacing_nm.*", "character.spacing_nm", "surfaces.*.psd")
def other_grid_carries_an_identified_spectrum(spacing, coarse, psd):
    """The cut-off of an identified spectrum is the Nyquist number of the grid of Table I."""
    return None if spacing <= coarse or psd == "published" else "must be at most that of Table I"


@law("identification.patch_um", "surfaces.*.published_psd")
@law("sampling.strip_length_um", "surfaces.*.published_psd")
@law("sampling.margin_um", "surfaces.*.published_psd")
def length_exceeds_the_correlation(length, psd):
    """Strips are samples of the field, and the opposite edges of a strip do not know of each other."""
    try:
        bound = _correlation_length(**psd)
    except ValueError:
        return None  # no spectrum or none that decays; other laws say so
    return None if length > bound else f"must be above the correlation length of the surface, {bound:.3g} µm"


@functools.cache
def _correlation_length(**psd):
    """Correlation length of a published spectrum [µm]."""
    return 1e6 * correlation_length(CutoffSelfAffine(**si(psd)))


@law("sampling.strip_length_um", "sampling.spacing_nm", "contact.every")
@law("beam.width_um", "sampling.spacing_nm", "contact.every")
def strip_is_whole_on_the_grid(side, spacing, every):
    """Both sides of a strip are whole numbers of the spacings at which contact is sought."""
    step = spacing * every
    return None if _is_multiple(side * 1e3, step) else f"must be a whole number of contact points {step:g} nm apart"


@law("studies.readings.spacing_nm.*", "contact.every", "sampling.strip_length_um", "beam.width_um")
@law("studies.readings.every.*", "sampling.spacing_nm", "sampling.strip_length_um", "beam.width_um")
def strip_is_whole_under_a_reading(changed, other, *sides):
    """As above; step in points times distance of points, whichever of both a reading changes."""
    whole = all(_is_multiple(side * 1e3, changed * other) for side in sides)
    return None if whole else "must divide both sides of a strip into whole contact points"


@law("identification.patch_um", "sampling.spacing_nm")
def patch_is_whole_on_the_grid(side, spacing):
    """The side of a patch is a whole number of grid spacings."""
    return None if _is_multiple(side * 1e3, spacing) else f"must be a whole number of grid spacings of {spacing} nm"


@law("character.spacing_nm", "sampling.spacing_nm")
def summits_are_sought_on_the_grid(coarse, spacing):
    """Table I is sampled at every n-th height of the grid."""
    return None if _is_multiple(coarse, spacing) else f"must be a multiple of the grid spacing of {spacing} nm"


@law("character.spacing_nm", "identification.patch_um")
@law("character.spacing_nm", "sampling.strip_length_um")
@law("character.spacing_nm", "beam.width_um")
def strip_can_hold_a_summit(coarse, side):
    """A summit has eight neighbours."""
    return None if 3 * coarse <= side * 1e3 else f"must be at most a third of a side of {side} µm"


@law("contact.chunks", "contact.samples")
def chunks_are_not_empty(chunks, samples):
    """Every job has a sample."""
    return None if chunks <= samples else "must be at most the number of samples"


@law("chaos.order", "contact.samples")
def samples_carry_the_chaos(order, samples):
    """There are no more polynomials in four variables, App. B, than samples to fit them."""
    carried = next(n for n in itertools.count(order, -1) if math.comb(n + 4, 4) <= samples)
    return None if order == carried else f"must be at most {carried}, or {math.comb(order + 4, 4)} samples are needed"


@law("beam.length_um", "sampling.strip_length_um", "beam.elements")
def strips_fill_the_elements(length, strip, elements):
    """Every element holds the same whole number of strips, its integration points (Fig. 6)."""
    if _is_multiple(length, strip * elements):
        return None
    return f"must be a multiple of strip_length x elements = {strip * elements:.6g} µm: whole strips on each element"


@law("studies.readings.strips_per_element.*", "beam.length_um", "sampling.strip_length_um")
def strips_fill_finer_elements(strips, length, strip):
    """As above, in a reading; two elements at least."""
    if _is_multiple(length, strip * strips) and length > 1.5 * strip * strips:
        return None
    return "must divide the strips along the beam into whole elements, at least two"


@law("studies.mesh.elements_um", "studies.mesh.strips_um", "beam.length_um")
def a_mesh_is_whole(elements, strips, length):
    """Figure 19 leaves out lengths that do not fill each other and the beam, but not all."""
    fitting = (
        _is_multiple(length, element) and _is_multiple(element, strip) for element in elements for strip in strips
    )
    return None if any(fitting) else "must hold a part of the beam that is a multiple of one of the strips"


@law("pairs.*.gap_um", "beam.length_um")
@law("beam.width_um", "beam.length_um")
@law("beam.thickness_um", "beam.length_um")
def beam_is_slender(size, length):
    """The beam is longer than it is wide, thick and deflected (Euler-Bernoulli)."""
    return None if size < length else "must be below the length of the beam"


def _is_multiple(whole, part):
    """Whether ``whole`` is 1, 2, 3 … times ``part`` but for rounding."""
    return math.isclose(whole, round(whole / part) * part, rel_tol=1e-9)
