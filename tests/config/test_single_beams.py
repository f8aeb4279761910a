"""Files of single test beams: what a configuration has of them, and what is wrong with a file, in one sentence."""

import copy
from statistics import fmean, stdev

import pytest
import yaml
from configurations import problems
from test_test_beams import ARRAY, SECTIONS

from stiction.config import files, test_beams
from stiction.config.messages import ConfigError

HEAD = "humidity,length_um,crack_length_um,stuck"
MEASURED = ["0.67,1500,705,", "0.67,1500,720.5,", "0.44,1500,950,", "0.44,1500,960,", "0.44,1500,970,"]
COUNTED = ["0.67,300,,yes", "0.67,300,,no", "0.67,300,,no", "0.44,300,,0", "0.67,400,,1"]


@pytest.fixture
def study(tmp_path):
    """Configuration file with an array in a CSV file of these lines, and further keys of the array."""

    def written(*lines, content=None, **keys):
        config = copy.deepcopy(SECTIONS)
        sizes = {key: value for key, value in ARRAY.items() if key not in ("length_um", "crack_lengths")}
        config["test_beams"]["first"] = sizes | {"file": "beams.csv"} | keys
        (tmp_path / "study.yaml").write_text(yaml.safe_dump(config))
        (tmp_path / "beams.csv").write_bytes("\n".join(lines).encode() if content is None else content)
        return tmp_path / "study.yaml"

    return written


def loaded(path):
    return files.load(path)["test_beams"]["first"]


def test_a_file_gives_means_and_counts(study):
    found = loaded(study("# measured on wafer 7", HEAD, *MEASURED, "", *COUNTED))
    assert "file" not in found
    assert found["length_um"] == 1500
    first = {"humidity": 0.44, "mean_um": 960, "std_um": 10, "beams": 3}
    second = {"humidity": 0.67, "mean_um": fmean([705, 720.5]), "std_um": stdev([705, 720.5]), "beams": 2}
    assert found["crack_lengths"] == [first, second]
    groups = [(0.44, 300, 0, 1), (0.67, 300, 1, 3), (0.67, 400, 1, 1)]
    assert found["stuck"] == [
        dict(zip(("humidity", "length_um", "stuck", "of"), group, strict=True)) for group in groups
    ]


def test_a_file_and_the_same_data_in_the_configuration_are_one(study):
    data = test_beams.summary(test_beams.beams("\n".join([HEAD, *MEASURED, *COUNTED])))
    config = copy.deepcopy(SECTIONS)
    del config["test_beams"]["first"]["length_um"], config["test_beams"]["first"]["crack_lengths"]
    config["test_beams"]["first"] |= data
    assert files.load(config) == files.load(study(HEAD, *MEASURED, *COUNTED))


def test_neither_the_order_of_rows_and_columns_nor_a_mark_of_the_order_of_bytes_matters(study):
    expected = loaded(study(HEAD, *MEASURED, *COUNTED))
    assert loaded(study("\ufeff" + HEAD, *COUNTED[::-1], *MEASURED[::-1])) == expected
    rows = [line.split(",") for line in (HEAD, *MEASURED, *COUNTED)]
    assert loaded(study(*(",".join(row[::-1]) for row in rows))) == expected
    assert loaded(study("humidity,length_um,crack_length_um", *(line[:-1] for line in MEASURED)))["length_um"] == 1500


def test_beams_may_be_counted_in_dry_air():
    humid, dry = (test_beams.summary(test_beams.beams(f"{HEAD}\n{air},500,,yes\n"))["stuck"] for air in ("0.44", "dry"))
    assert dry == [humid[0] | {"humidity": 0.0}]


def test_the_template_is_a_file(study):
    found = loaded(study(test_beams.TEMPLATE))
    assert [entry["beams"] for entry in found["crack_lengths"]] == [2]
    assert [(entry["stuck"], entry["of"]) for entry in found["stuck"]] == [(1, 2)]


@pytest.mark.parametrize(
    ("lines", "words"),
    [
        ([], "which is empty, must begin with the names of its columns: humidity,length_um"),
        (["# nothing"], "which is empty"),
        ([HEAD], "which holds no beam"),
        (["humidity,length_mm,stuck"], "row 1: column 'length_mm' is unknown, must be among humidity, length_um"),
        (["humidity;length_um;stuck"], "; separate columns by commas"),
        (["humidity,stuck"], "row 1: the columns are humidity, stuck, must have humidity and length_um"),
        (["humidity,length_um,length_um"], "each once"),
        ([HEAD, "67,1500,705,"], "row 2: humidity is '67', must be a number above 0, as a fraction of 1"),
        ([HEAD, "0.67,1500 nm,705,"], "row 2: length_um is '1500 nm', must be a number above 0, in µm"),
        ([HEAD, "nan,1500,705,"], "row 2: humidity is 'nan'"),
        ([HEAD, "0,67,1500,705,"], "row 2: commas separate 5 values, must be 4, with points in decimal numbers"),
        ([HEAD, "0.67,1500"], "row 2: commas separate 2 values"),
        (
            [HEAD, "# ok", "0.67,1500,1500,"],
            "row 3: crack_length_um is '1500', must be a number above 0, below the length",
        ),
        ([HEAD, "0.67,1500,,"], "row 2: it must have either crack_length_um or stuck"),
        ([HEAD, "0.67,1500,705,yes"], "row 2: it must have either crack_length_um or stuck"),
        ([HEAD, "0.67,1500,,maybe"], "row 2: stuck is 'maybe', must be yes or no"),
        (
            [HEAD, "0.67,1500,705,"],
            "row 2: crack_length_um must have different values in at least two rows at humidity",
        ),
        ([HEAD, *MEASURED, "0.67,1400,705,"], "row 7: length_um is 1400, must be 1500 as in row 2"),
        ([HEAD, *MEASURED, "0.67,1500,0.71,"], "row 7: crack_length_um is 0.71, but 720.5 in row 3: all must be in µm"),
        ([HEAD, "0.67,1500,0.71,", "0.67,1500,0.7,", "0.67,1500,705,"], "row 4: crack_length_um is 705, but 0.7 in"),
        ([HEAD, "0.67,1500,0.71,", "0.67,1500,705,"], "all must be in µm"),
        ([HEAD, "0.67," + 131073 * "5"], "row 2 of 131078 characters cannot be read: field larger than field limit"),
        ([HEAD + "," + 131073 * "x"], "row 1 of 131114 characters cannot be read: field larger than field limit"),
    ],
)
def test_what_is_wrong_with_a_file_is_one_sentence_with_key_file_and_row(study, lines, words):
    with pytest.raises(ConfigError) as refused:
        files.load(study(*lines))
    (sentence,) = refused.value.problems
    assert sentence.startswith("test_beams.first.file is 'beams.csv', ")
    assert words in sentence


def test_crack_lengths_that_scatter_by_a_factor_of_ten_are_in_one_unit():
    rows = ["0.67,1500,70,", "0.67,1500,700,", "0.44,1500,1.2,", "0.44,1500,12,"]
    assert [
        datum["beams"] for datum in test_beams.summary(test_beams.beams("\n".join([HEAD, *rows])))["crack_lengths"]
    ] == [
        2,
        2,
    ]


def test_a_damaged_or_missing_file_is_named(study):
    path = study(content=b"humidity,length_um,stuck\n0.67,300,\xff\n")
    with pytest.raises(
        ConfigError, match=r"beams\.csv', which cannot be read: line 2 holds a character that is not UTF-8"
    ):
        files.load(path)
    path.with_name("beams.csv").unlink()
    with pytest.raises(ConfigError, match=r"beams\.csv', which cannot be read: No such file"):
        files.load(path)


def test_a_file_takes_the_place_of_data(study):
    with pytest.raises(ConfigError, match="must come without stuck: the file has them"):
        files.load(study(HEAD, *MEASURED, stuck=[]))


@pytest.mark.parametrize(
    ("lines", "words"),
    [
        (["0.2,300,,yes"], "row 7: humidity is 0.2, must be at least 0.2903: in drier air"),
        (["0.66666,300,,yes"], "row 7: humidity is 0.66666, must have at most 4 decimals"),
        (["0.67,300,,no", "0.67,15,,yes"], "row 8: length_um is 15.0, must be in µm, above the thickness"),
        (["0.67,300000,,yes"], "row 7: length_um is 300000.0, must be a number at least 0.1 and at most 100000"),
        (["0.8,1500,2,", "0.8,1500,3,"], "row 7: the mean of crack_length_um at its humidity is 2.5, must be in µm"),
        (
            ["0.8,1500,50,", "0.8,1500,50,", "0.8,1500,1400,"],
            "row 7: the standard deviation of crack_length_um at its humidity is",
        ),
        (
            ["0.8,1500,700.0000001,", "0.8,1500,700,"],
            "row 7: the standard deviation of crack_length_um at its humidity is 7.07",
        ),
    ],
)
def test_values_that_no_beam_has_are_refused_with_their_row_as_well(study, lines, words):
    with pytest.raises(ConfigError) as refused:
        files.load(study(HEAD, *MEASURED, *lines))
    (sentence,) = refused.value.problems
    assert sentence.startswith(f"test_beams.first.file is 'beams.csv', {words}")


def test_rows_are_named_where_other_keys_depend_on_them(study):
    with pytest.raises(ConfigError, match=r"is 'touching', .*beams\.csv', row 2: humidity = 'dry'\)$"):
        files.load(study(HEAD, "dry,300,,yes"), {"attraction": {"reach": "touching"}})


def test_data_that_replace_those_of_a_file_have_no_row(study):
    count = {"humidity": 0.2, "length_um": 300, "stuck": 1, "of": 2}
    with pytest.raises(ConfigError, match=r"^test_beams\.first\.stuck\[0\]\.humidity is 0\.2, "):
        files.load(study(HEAD, *COUNTED), {"test_beams": {"first": {"stuck": [count]}}})


def test_files_are_those_of_the_configuration_that_names_them(tmp_path):
    (tmp_path / "beams.csv").write_text("\n".join([HEAD, *COUNTED]))
    array = {"test_beams": {"first": {"file": "beams.csv"}}}
    other = {"test_beams": {"first": {"file": "others.csv"}}}
    assert test_beams.with_files(array, array, tmp_path)["test_beams"]["first"]["stuck"][0]["of"] == 1
    assert test_beams.with_files(other, array, tmp_path) == other
    for broken in ({}, {"test_beams": 5}, {"test_beams": {"X": 1}}, {"test_beams": {"X": {"file": 7}}}):
        assert test_beams.with_files(broken, broken, tmp_path) == broken
    assert any(line.startswith("test_beams.X.file is 7") for line in problems({"test_beams": {"X": {"file": 7}}}))
