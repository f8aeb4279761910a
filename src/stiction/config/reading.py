"""Strict reading of one configuration file, and a check before Snakemake reads files and arguments.

Snakemake reads files before the Snakefile can check them, and prints tracebacks or sentences without the name of the
file. This module imports little, so that the check takes a fraction of a second.
"""

import re
from collections.abc import Iterable, Iterator, Mapping
from functools import cache
from itertools import chain
from pathlib import Path
from typing import Any

import yaml

from stiction.config.memory import GRID
from stiction.config.messages import ConfigError, duplicates, one_line
from stiction.regular_files import require_regular

#: Configuration of the paper: a copy of ``config.yaml`` in the root folder, which users may edit.
PAPER = Path(__file__).with_name("paper.yaml")
#: Numbers that YAML 1.1 reads in base 60 and in base 8.
_BASE_60 = re.compile(r"[-+]?\d[\d_]*(:[0-5]?\d)+(\.[\d_]*)?")
_BASE_8 = re.compile(r"[-+]?0[0-7_]+")
#: Most characters of a value, those of a path in Linux.
LONGEST = 4096
#: Most values of a file. An alias counts as what it repeats: a few lines can stand for more values than a memory holds.
MOST = 100_000
#: Messages of the parser and their likely causes.
_CAUSES = {
    "'\\t' that cannot start any token": "indent with spaces, not with tabs",
    "expected a single document": "remove the line --- that starts a second document",
}


def read(path: str | Path) -> dict:
    """Mapping in one YAML file.

    Raises
    ------
    ConfigError
        If the file cannot be read, is not a mapping, contains a key twice or a number that YAML misreads; one line
        with the name of the file and, where it is known, the line.
    """
    try:
        content = yaml.load(text(path), _Strict)
    except Exception as reason:  # PyYAML does not wrap all exceptions: !!bool x raises a KeyError
        message = _one_line(reason)
        causes = [f"; {cause}" for symptom, cause in _CAUSES.items() if symptom in message]
        raise ConfigError(f"{path} cannot be read: {message}{''.join(causes)}") from reason
    if not isinstance(content, dict):
        held = "is empty" if content is None else f"holds {one_line(content)}"
        raise ConfigError(f"{path} {held}, must be sections such as 'contact: {{samples: 5000}}'")
    return content


@cache
def paper() -> dict:
    """Complete configuration of the paper, read once. Not to be changed."""
    config = read(PAPER)
    return config | {"sampling": GRID | config["sampling"]}


def is_stated(config: Mapping[str, Any], section: str, key: str) -> bool:
    """Whether a key has another value than by default."""
    return config[section][key] != paper()[section][key]


def _one_line(reason):
    """Error in one line, the parser's with the line of the file first."""
    mark = getattr(reason, "problem_mark", None)
    if mark is None:
        return " ".join((getattr(reason, "strerror", None) or str(reason)).split())
    return f"line {mark.line + 1}, column {mark.column + 1}: {' '.join(filter(None, (reason.context, reason.problem)))}"


def text(path: str | Path) -> str:
    """Text of a file in UTF-8."""
    require_regular(path)
    data = Path(path).read_bytes()
    if data.startswith((b"\xff\xfe", b"\xfe\xff")) or b"\0" in data[:2]:  # without a mark, but an ASCII letter
        raise ValueError("it is text in UTF-16, must be UTF-8: save it as UTF-8")
    try:
        return data.decode("utf-8")
    except UnicodeDecodeError as reason:
        line = data[: reason.start].count(b"\n") + 1
        raise ValueError(f"line {line} holds a character that is not UTF-8: save the file as UTF-8") from reason


class _Strict(yaml.SafeLoader):
    """YAML loader without duplicate keys (PyYAML drops the first value) and numbers in base 60 or 8.

    It also rejects texts and files so large that nothing else is sure to end, such as a message that shows a value. The
    loader in C is ten times as fast, and ends the process at a million open brackets.
    """

    def construct_document(self, node):
        """Construct a document of at most `MOST` values."""
        if (values := _number_of_values(node, {})) > MOST:
            message = f"the file has {values:.6g} values, with aliases written out, must have at most {MOST}"
            raise yaml.constructor.ConstructorError(None, None, message, node.start_mark)
        return super().construct_document(node)

    def construct_scalar(self, node):
        """Construct a scalar of at most `LONGEST` characters."""
        if isinstance(node, yaml.ScalarNode) and len(node.value) > LONGEST:
            message = f"a value has {len(node.value)} characters, must have at most {LONGEST}"
            raise yaml.constructor.ConstructorError(None, None, message, node.start_mark)
        return super().construct_scalar(node)

    def construct_mapping(self, node, deep=False):  # noqa: ARG002
        """Construct a mapping without duplicate keys."""
        keys = [key for key, _ in node.value if key.tag != "tag:yaml.org,2002:merge"]
        # Deep construction also rejects a mapping that contains itself.
        mapping = super().construct_mapping(node, deep=True)
        for key in duplicates(self.construct_object(key, deep=True) for key in keys):
            raise yaml.constructor.ConstructorError(None, None, f"key {key!r} is given twice", node.start_mark)
        return mapping

    def construct_number(self, node):
        """Number, unless YAML reads another one than is written."""
        construct = self.construct_yaml_int if node.tag.endswith(":int") else self.construct_yaml_float
        value, text = construct(node), str(node.value)
        for pattern, base in ((_BASE_60, 60), (_BASE_8, 8)):
            if pattern.fullmatch(text) and (base == 60 or value != int(text)):
                message = f"YAML reads {text} in base {base}, as {one_line(value)}: write the number that is meant"
                raise yaml.constructor.ConstructorError(None, None, message, node.start_mark)
        return value


def _number_of_values(node, counted):
    """Number of values of a node, with those of its aliases. A node in itself is refused when it is constructed."""
    if id(node) not in counted:
        counted[id(node)] = 0
        children = node.value if isinstance(node, yaml.CollectionNode) else ()
        children = chain.from_iterable(children) if isinstance(node, yaml.MappingNode) else children
        counted[id(node)] = 1 + sum(_number_of_values(child, counted) for child in children)
    return counted[id(node)]


_Strict.add_constructor("tag:yaml.org,2002:map", _Strict.construct_mapping)
_Strict.add_constructor("tag:yaml.org,2002:int", _Strict.construct_number)
_Strict.add_constructor("tag:yaml.org,2002:float", _Strict.construct_number)


#: Options of Snakemake that take a number of jobs.
_NUMBERS = ("--cores", "-c", "--jobs", "-j", "--local-cores")
#: Value that begins as an option does.
_NEGATIVE = re.compile(r"-\d+")


def problems(files: Iterable[str], arguments: Iterable[str]) -> Iterator[str]:
    """Yield one line for each unreadable file and each argument refused by Snakemake.

    With less than one job at a time, Snakemake waits for ever.
    """
    arguments = list(arguments)
    for file in _files(files, arguments):
        try:
            read(file)
        except ConfigError as error:
            yield str(error)
    for setting in _values(arguments, ("--config", "-C")):
        name, equals, _ = setting.partition("=")
        if not (equals and name.isidentifier()):
            yield (
                f"--config {setting} must be a key of the first level and its value, such as --config seed=1; "
                "put other changes into a file: CONFIG=mine.yaml"
            )
    for number in _values(arguments, _NUMBERS):
        if _NEGATIVE.fullmatch(number) or (number.isdecimal() and int(number) == 0):
            yield f"the number of jobs at the same time is {number}, must be at least 1, or all"


def contents(files: Iterable[str], arguments: Iterable[str]) -> list[dict]:
    """Content of every file, also of those among Snakemake's arguments. Raises the errors of `read`."""
    return [read(file) for file in _files(files, arguments)]


def _files(files, arguments):
    """Files of the configuration, those of the command first."""
    return [*files, *_values(arguments, ("--configfile", "--configfiles"))]


def _values(arguments, options):
    """Words after some options, up to the next option, and words attached to an option, as in -c2."""
    is_in_option = False
    for word in arguments:
        if word.startswith("-") and not _NEGATIVE.fullmatch(word):
            option, equals, value = word.partition("=") if word.startswith("--") else (word[:2], word[2:], word[2:])
            is_in_option = option in options
            if is_in_option and equals:
                yield value.removeprefix("=")
        elif is_in_option:
            yield word
