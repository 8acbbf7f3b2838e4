"""CSV as spreadsheets write it: what is a number, what separates, and what is refused with how to write it."""

from __future__ import annotations

import random

import numpy as np
import pytest
from refusals import MOTOR_TEXT, refusal

import trum_sym as ts
from studies import fuzz_parsers
from trum_sym.inputs.measurements import read_measurements
from trum_sym.sweeps.notation import parse

HEADER = "prepressure [N],amplitude [um]\n"
TAKEN = {
    "commas": HEADER + "100,8.5\n120,7\n",
    "semicolons": "prepressure [N];amplitude [um]\n100;8.5\n120;7\n",
    "semicolons, decimal commas": "prepressure [N];amplitude [um]\n100,0;8,5\n1,2e2;7\n",
    "tabs, decimal commas": "prepressure [N]\tamplitude [um]\n100\t8,5\n120\t7\n",
    "Excel's sep=;": "sep=;\nprepressure [N];amplitude [um]\n100;8,5\n120;7\n",
    "Excel's sep=,": "sep=,\r\nprepressure [N],amplitude [um]\r\n100,8.5\r\n120,7\r\n",
    "stated bars": "sep=|\nprepressure [N]|amplitude [um]\n100|8.5\n120|7\n",
    "byte order mark": "\ufeff" + HEADER + "100,8.5\n120,7\n",
    "byte order mark and sep": "\ufeffsep=;\nprepressure [N];amplitude [um]\n100;8,5\n120;7\n",
    "old line ends": HEADER.replace("\n", "\r") + "100,8.5\r120,7\r",
    "comments and blank lines": "# ours\n\n" + HEADER + "100,8.5\n  \n# break\n120,7\n",
    "signs and exponents": HEADER + "+1.0e2,8.5E+00\n.12e3,7.\n",
    "quotes and blanks": '"prepressure [N]" , "amplitude [µm]"\n'.replace(" ,", ",").replace(", ", ",")
    + ' 100 ,"8.5"\n120, 7\n',
    "a comma among three digits, with proof": "prepressure [N];amplitude [nm]\n100,0;8500,000\n120;7000,5\n".replace(
        ",5", ",0"
    ),
}
REFUSED = {
    "underscore": (HEADER + "1_90,8.5\n", ("prepressure: line 2: got 1_90", "digits 0 to 9")),
    "full width": (HEADER + "１９０,8.5\n", ("prepressure: line 2: got １９０", "digits 0 to 9")),
    "arabic": (HEADER + "١٩٠,8.5\n", ("prepressure: line 2", "digits 0 to 9")),
    "hexadecimal": (HEADER + "0x64,8.5\n", ("got 0x64",)),
    "not a number": (HEADER + "nan,8.5\n", ("got nan",)),
    "infinite": (HEADER + "100,inf\n", ("got inf",)),
    "too large": (HEADER + "100,1e999\n", ("got 1e999", "finite")),
    "unit in a cell": (HEADER + "100 N,8.5\n", ("got 100 N",)),
    "apostrophe": (HEADER + "1'900,8.5\n", ("got 1'900",)),
    "no-break space": (HEADER + "1\u00a0900,8.5\n", ("prepressure: line 2",)),
    "minus that is none": ("load_torque [Nm],mean_speed [rad/s]\n−0.1,8.5\n", ("load_torque: line 2",)),
    "thousands in quotes": (HEADER + '"1,900",8.5\n', ("got 1,900", "decimal commas need semicolons or tabs")),
    "decimal commas among commas": (HEADER + "100,5,8,5\n", ("line 2: got 4 cells", "decimal commas need semicolons")),
    "thousand or decimal": ("prepressure [N];amplitude [nm]\n100;8,500\n", ("8,500 in line 2", "may be thousands")),
    "both marks": ("prepressure [N];amplitude [um]\n100.5;8,5\n", ("8,5 in line 2", "not both")),
    "grouped": ("prepressure [N];amplitude [nm]\n100;1.234,5\n", ("got 1.234,5", "one decimal mark")),
    "blanks separate": ("prepressure [N] amplitude [um]\n100 8.5\n", ("commas, semicolons or tabs",)),
    "bars": ("prepressure [N]|amplitude [um]\n100|8.5\n", ("commas, semicolons or tabs",)),
    "sep of a letter": ("sep=x\nprepressure [N]xamplitude [um]\n", ("sep=x", "semicolons")),
    "last separator": ("prepressure [N];amplitude [um];\n100;8.5;\n", ("empty text",)),
    "many columns": (",".join(["prepressure [N]"] * 1001) + "\n", ("1001 columns", "at most 1000")),
    "two rows a line": (HEADER + '"1\n00",8.5\n', ("one row a line",)),
}


def written(path, text, encoding="utf-8"):
    path.write_bytes(text.encode(encoding))
    return path


@pytest.mark.parametrize("case", TAKEN)
def test_what_spreadsheets_write_is_read(tmp_path, case):
    found = read_measurements(written(tmp_path / "data.csv", TAKEN[case]))
    assert found.columns["prepressure"].tolist() == [100.0, 120.0]
    assert found.columns["amplitude"].tolist() == pytest.approx([8.5e-6, 7e-6], rel=1e-15)


BLANKS = [chr(code) for code in range(0x110000) if chr(code).isspace() and chr(code) not in "\t\n\r"]


@pytest.mark.parametrize("blank", BLANKS, ids=lambda blank: f"U+{ord(blank):04X}")
def test_blanks_of_any_kind_around_a_number_are_left_off_in_files_and_quantities(tmp_path, blank):
    around = f"{blank}100{blank}"  # float() itself takes some of them and not others
    path = written(tmp_path / "data.csv", f"{HEADER}{around},{blank}8.5\n120{blank},7\n")
    assert read_measurements(path).columns["prepressure"].tolist() == [100.0, 120.0]
    assert parse("prepressure", f"@{path}", "N").values.tolist() == [100.0, 120.0]
    for text in (around, f"{around}:200:2", f"{around},200"):
        assert np.ravel(parse("prepressure", text, "N"))[0] == 100.0


@pytest.mark.parametrize("case", REFUSED)
def test_what_is_open_is_refused_with_how_to_write_it(tmp_path, case):
    text, naming = REFUSED[case]
    with refusal(*naming):
        read_measurements(written(tmp_path / "data.csv", text))


@pytest.mark.parametrize("case", [name for name in TAKEN if "comment" not in name])
def test_a_column_of_a_sweep_is_read_the_same_way(tmp_path, case):
    path = written(tmp_path / "data.csv", TAKEN[case])
    assert parse("prepressure", f"@{path}", "N").values.tolist() == [100.0, 120.0]


@pytest.mark.parametrize("case", ["underscore", "full width", "thousand or decimal", "both marks", "sep of a letter"])
def test_a_column_of_a_sweep_is_refused_the_same_way(tmp_path, case):
    with refusal("prepressure"):
        parse("prepressure", f"@{written(tmp_path / 'data.csv', REFUSED[case][0])}", "N")


@pytest.mark.parametrize(("encoding", "need"), [("utf-16", "save it as UTF-8"), ("latin-1", "not UTF-8 text")])
def test_another_encoding_is_named(tmp_path, encoding, need):
    with refusal(need):
        read_measurements(written(tmp_path / "data.csv", HEADER.replace("um", "µm") + "100,8.5\n", encoding))
    with refusal("motor", need):
        ts.load_motor(written(tmp_path / "motor.toml", MOTOR_TEXT + "# µ\n", encoding))


def test_a_motor_file_may_begin_with_a_byte_order_mark(tmp_path):
    path = written(tmp_path / "motor.toml", MOTOR_TEXT, "utf-8-sig")
    assert ts.load_motor(path) == ts.load_motor("trum60")
    from trum_sym.inputs.motor_writer import write_motor

    write_motor(ts.load_motor(path).with_values({"contact_radius": 0.026}), path, path)
    assert path.read_text("utf-8").startswith("# TRUM-60")
    assert ts.load_motor(path).contact_radius.value == 0.026


def test_files_have_limits(tmp_path, monkeypatch):
    from trum_sym.inputs import csv_text, motor_file

    monkeypatch.setattr(csv_text, "MAX_ROWS", 3)
    with refusal("more than 3 rows"):
        read_measurements(written(tmp_path / "data.csv", HEADER + "100,8.5\n" * 4))
    with refusal("motor", "more than 1000000 bytes"):
        ts.load_motor(written(tmp_path / "motor.toml", MOTOR_TEXT + "#" * 1_000_000))
    monkeypatch.setattr(motor_file, "_MAX_PUBLISHED", 3)
    with refusal("published", "up to 3 tables"):
        ts.load_motor(written(tmp_path / "motor.toml", MOTOR_TEXT))


@pytest.mark.parametrize(
    "content", ["a." * 200_000 + "a = 1", "a = " + "[" * 100_000, "a = " + "{b=" * 100_000, "[a." * 9]
)
def test_a_motor_file_nested_without_end_is_refused(tmp_path, content):
    with refusal("motor"):
        ts.load_motor(written(tmp_path / "motor.toml", content))


# --- A sample of what ``python -m studies.fuzz_parsers`` does --------------------------------------------------------


@pytest.mark.parametrize("name", fuzz_parsers.TARGETS)
def test_parsers_answer_or_refuse_mutated_input(name):
    rng = random.Random(1)
    for _ in range(60 if name == "motor" else 200):
        fuzz_parsers.once(name, fuzz_parsers.mutated(rng, name))


FOUND = {  # by fuzzing, each once an error of another kind
    "unit": ["N58", "1 r22 r22 r22 r22 r22 r22 r22 r22 r22 r22 r22 r22 r22 r22 r22 r22 r22", "((((%)99)99)99)99"],
    "swept": ["1e308:-1e308:3", "inf:1:3", "1:2:by=1e-320", "0:1e308:by=1e-300"],
    "distribution": ["normal:26 mm:25 m", "normal:2 r22 r22 r22 r22 r22 r22 r22 r22 r22 r22 r22 r22 r22 r22:3"],
}


@pytest.mark.parametrize(("name", "text"), [(name, text) for name, texts in FOUND.items() for text in texts])
def test_what_fuzzing_found_stays_mended(name, text):
    fuzz_parsers.once(name, text.encode())
