"""Beginning with a motor of one's own: template, check, list, difference, schema, page."""

from __future__ import annotations

import json
import tomllib
from dataclasses import replace
from pathlib import Path

import pytest
from refusals import MOTOR, MOTOR_TEXT

import trum_sym as ts
from trum_sym import console
from trum_sym.inputs.motor import SPECS
from trum_sym.inputs.motor_file import _KEYS
from trum_sym.inputs.motor_schema import page, schema, template

pytestmark = pytest.mark.filterwarnings("ignore::trum_sym.ValidityWarning")
ROOT = Path(__file__).parents[2]


def run(capsys, *words):
    code = console.main(["motor", *words])
    return code, capsys.readouterr().out


def test_the_template_loads_and_has_the_values_of_the_other_motor(motor_file):
    own = ts.load_motor(motor_file(template('my "first" motor')))
    assert own.name == 'my "first" motor'
    needed = {name for name, spec in SPECS.items() if spec.required}
    assert {n: p.value for n, p in own.parameters()} == {n: p.value for n, p in MOTOR.parameters() if n in needed}
    assert set(own.assumed()) == {name for name, spec in SPECS.items() if spec.required}
    assert (dict(own.box), own.published) == ({}, ())


@pytest.mark.parametrize("name", ["two\nlines", 'a "quoted" \\ one', "del\x7f and esc\x1b", "ä µ 電 😀"])
def test_a_template_loads_whatever_the_names_are(motor_file, trum60, name):
    own = ts.load_motor(motor_file(template(name, replace(trum60, name=name))))
    assert own.name == name
    assert own.radius.source == f"to do: value of {name}"


def test_each_optional_entry_of_the_template_may_be_taken_in(motor_file):
    lines = template("own").splitlines()
    optional = [name for name, spec in SPECS.items() if not spec.required]
    for name in optional:
        (place,) = (k for k, line in enumerate(lines) if line.startswith(f"# {name} = "))
        entry = lines[place].removeprefix("# ").replace("value = 0.0,", "value = 0.5,")
        changed = [*lines[:place], entry, *lines[place + 1 :]]
        assert getattr(ts.load_motor(motor_file("\n".join(changed))), name) is not None
    box = [line.removeprefix("# ") if "range = [" in line or line == "# [box]" else line for line in lines]
    assert set(ts.load_motor(motor_file("\n".join(box))).box) == {"prepressure", "frequency_difference"}
    start = lines.index("# [[published]]")
    taken = [*lines[:start], *(line.removeprefix("# ") for line in lines[start:])]
    taken = [line.replace('"mean_speed"  ', '"speed_volatility"  ').replace("arcsec/s", "%") for line in taken]
    assert ts.load_motor(motor_file("\n".join(taken))).published[0].sampling_period == 2e-3


def accepts(rules, value, where="$"):
    """A validator of what the schema uses: types, required and other keys, constants, lists."""
    kinds = {"object": dict, "string": str, "number": (int, float), "array": list}
    wrong = []
    if "type" in rules and not isinstance(value, kinds[rules["type"]]):
        return [f"{where}: no {rules['type']}"]
    if "const" in rules and value != rules["const"]:
        wrong.append(f"{where}: not {rules['const']}")
    if "enum" in rules and value not in rules["enum"]:
        wrong.append(f"{where}: none of {rules['enum']}")
    if isinstance(value, dict):
        wrong += [f"{where}: no {name}" for name in rules.get("required", []) if name not in value]
        known = rules.get("properties", {})
        if rules.get("additionalProperties") is False:
            wrong += [f"{where}: {name} is not known" for name in value if name not in known]
        wrong += [w for name in value if name in known for w in accepts(known[name], value[name], f"{where}.{name}")]
    if isinstance(value, list):
        if not rules.get("minItems", 0) <= len(value) <= rules.get("maxItems", len(value)):
            wrong.append(f"{where}: {len(value)} items")
        wrong += [w for k, item in enumerate(value) for w in accepts(rules["items"], item, f"{where}[{k}]")]
    return wrong


def test_the_schema_takes_what_the_reader_takes():
    rules = schema()
    assert accepts(rules, tomllib.loads(MOTOR_TEXT)) == []
    assert accepts(rules, tomllib.loads(template("own"))) == []
    parameters = rules["properties"]["parameters"]["properties"]
    assert list(parameters) == list(SPECS)
    assert all(set(entry["properties"]) == set(_KEYS) for entry in parameters.values())


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ("radius              = {", "raduis = {"),
        ('symbol = "R"', 'symbol = "r"'),
        ('unit = "mm", symbol = "R", source = "Table 1"', 'unit = "mm", symbol = "R"'),
        ("value = 72,", 'value = "72",'),
        ('output = "amplitude"', 'output = "amplitud"'),
        ("range = [6.0, 8.0]", "range = [6.0]"),
        ("[box]", "[boxes]"),
    ],
)
def test_the_schema_refuses_what_the_reader_refuses(motor_file, old, new):
    text = MOTOR_TEXT.replace(old, new, 1)
    assert text != MOTOR_TEXT
    with pytest.raises(ts.ParameterError):
        ts.load_motor(motor_file(text))
    assert accepts(schema(), tomllib.loads(text)) != []


def test_the_page_of_the_docs_is_made_of_the_schema():
    assert (ROOT / "docs" / "motor-file.md").read_text("utf-8") == page()


def test_new_writes_a_template_and_replaces_nothing(capsys, tmp_path, console_refuses):
    path = tmp_path / "PMT-30.toml"
    code, out = run(capsys, "new", str(path))
    assert code == 0
    assert "motor check" in out
    assert ts.load_motor(path).name == "PMT-30"
    path.write_text("mine", "utf-8")
    console_refuses("motor", "new", str(path), naming=("FILE.toml: got", "--force to replace it"))
    assert path.read_text("utf-8") == "mine"
    assert run(capsys, "new", str(path), "--force", "--name", "x")[0] == 0
    assert ts.load_motor(path).name == "x"


def test_check_says_what_is_left_and_ends_with_no(capsys, motor_file):
    path = motor_file(template("own"))
    code, out = run(capsys, "check", str(path))
    assert code == 1
    assert "to do: 37 values of the template: radius" in out
    assert "no range of prepressure in [box]" in out
    code, out = run(capsys, "check", "trum60")
    assert code == 0
    assert "assumed: friction_coefficient 0.25, 0.2 to 0.3: not given; usual" in out
    wrong = MOTOR_TEXT.replace("radius              = { value = 30.0", "radius              = { value = 60.0")
    code, out = run(capsys, "check", str(motor_file(wrong)))
    assert code == 1
    assert "contradictory or unusual: radius: 60 mm contradicts perimeter" in out


def test_check_notices_an_amplitude_above_the_free_one(capsys, motor_file):
    """Eq. 8 by hand: 12.6 um * 14.926 * 50^-0.678 = 13.25 um at 50 N, and 8.29 um at the stated 100 N."""
    low = MOTOR_TEXT.replace("fit_prepressure_min = { value = 100.0", "fit_prepressure_min = { value = 50.0")
    assert low != MOTOR_TEXT
    code, out = run(capsys, "check", str(motor_file(low)))
    assert code == 1
    assert "amplitude_factor: eq. 8 gives 13.25" in out
    assert "um at 50 N, the least prepressure of its fit, more than free_amplitude, 12.6 um" in out


def test_show_names_every_value_with_its_source(capsys):
    out = run(capsys, "show")[1]
    for name, parameter in MOTOR.parameters():
        (line,) = (line for line in out.splitlines() if line.split("  ")[0] == name)
        assert parameter.source in line
    assert "searches vary prepressure from 160 to 210 (Sect. 9)" in out
    found = json.loads(run(capsys, "show", "trum60", "--json")[1])
    assert found["parameters"]["radius"]["value"] == 0.03
    assert found["parameters"]["friction_coefficient"]["range"] == [0.2, 0.3]


def test_diff_names_what_differs(capsys, motor_file):
    path = motor_file(MOTOR_TEXT.replace("value = 12.6,", "value = 12.1,"))
    lines = run(capsys, "diff", "trum60", str(path))[1].splitlines()
    assert len(lines) == 3
    assert lines[2].split()[:6] == ["free_amplitude", "12.6", "12.1", "um", "-3.97", "%"]
    assert lines[0].split()[:2] == ["trum60", str(path)]  # both are called TRUM-60
    assert "the same values" in run(capsys, "diff", "trum60", "trum60")[1]


def test_what_is_still_the_templates_is_marked(capsys, motor_file):
    assert console.main(["evaluate", "--motor", str(motor_file(template("own"))), "--prepressure", "170"]) == 0
    out, err = capsys.readouterr()
    assert "values that are still those of a template" in out
    (line,) = (line for line in out.splitlines() if line.startswith("wavenumber"))
    assert line.endswith("*")
    assert "not given, so as for TRUM-60: --frequency-difference 3000, --load-torque 0.3" in err
