"""The report's interactive part: made of what is here, complete without a network, its numbers the package's."""

from __future__ import annotations

import json
import re
import shutil
import warnings

import numpy as np
import pytest

import trum_sym as ts
from derivations.codegen import wasm
from trum_sym.console import main
from trum_sym.inputs.drive import Drive
from trum_sym.model.levels import LEVEL_NAMES
from trum_sym.quantities import QUANTITIES
from trum_sym.report.interactive import fragment

TOLERANCE = 1e-9
SETTINGS = [
    {},
    {"prepressure": 165, "frequency_difference": 2800, "on_periods": 12},
    {"start": "rest", "phase_lead": -1, "load_torque": 0.1},
    {"start": "steady", "frequency_difference": -1500, "load_torque": -0.05, "prepressure": 210},
    {"compliance": "flange", "load_torque": 0.05, "frequency_difference": 2000},
    {"load_inertia": 1e-3, "start": "rest", "phase_lead": -1},
    {"periods": 31, "on_periods": 22, "load_torque": 0, "frequency_difference": 1234.5},
]


@pytest.fixture(scope="module")
def text():
    return fragment(ts.load_motor())


def test_the_module_is_made_of_what_is_here():
    assert wasm.stale() == []


@pytest.fixture
def copied(tmp_path, monkeypatch):
    """The module, its record and its sources in another place, where they may be spoiled."""
    record = json.loads(wasm.RECORD.read_text("utf-8"))
    for name in [*record["sources"], *(path.relative_to(wasm.ROOT).as_posix() for path in (wasm.MODULE, wasm.RECORD))]:
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        shutil.copy(wasm.ROOT / name, tmp_path / name)
    for name in ("MODULE", "RECORD"):
        monkeypatch.setattr(wasm, name, tmp_path / getattr(wasm, name).relative_to(wasm.ROOT))
    monkeypatch.setattr(wasm, "ROOT", tmp_path)
    assert wasm.stale() == []
    return tmp_path


@pytest.mark.parametrize("source", ["generated/trum_friction.c", "trum_sym/_driver/orbit/step.h"])
def test_a_changed_source_makes_it_stale(copied, source, capsys):
    with (copied / source).open("a") as file:
        file.write("\n")
    assert wasm.command(check=True) == 1
    assert f"{source} has changed" in capsys.readouterr().out


def test_a_new_kernel_a_lost_source_and_another_module_make_it_stale(copied):
    (copied / "generated" / "trum_new.c").write_text("")
    (copied / "generated" / "trum60.h").unlink()
    wasm.MODULE.write_bytes(wasm.MODULE.read_bytes()[:-1])
    found = "\n".join(wasm.stale())
    for word in ("trum_new.c is new", "trum60.h has changed", "motor.wasm is not the module"):
        assert word in found


def test_it_asks_nothing_of_any_network(text):
    assert set(re.findall(r"https?://[^\s\"'<)]+", text)) == {"http://www.w3.org/2000/svg"}
    assert not re.search(r"\b(fetch|XMLHttpRequest|importScripts|WebSocket)\b|@import|url\(", text)
    ids = re.findall(r'\bid="([^"]+)"', text)
    assert len(set(ids)) == len(ids)
    assert set(re.findall(r'\bfor="([^"]+)"', text)) <= set(ids)


def test_every_control_sets_a_field_of_the_drive_and_every_cell_shows_a_figure(text):
    settings = set(re.findall(r'data-setting="(\w+)"', text))
    assert {"prepressure", "frequency_difference", "on_periods", "load_torque", "load_inertia", "start"} <= settings
    assert settings <= {*Drive().numbers(), "start", *LEVEL_NAMES}
    cells = dict(re.findall(r'data-figure="(\w+)"(?: data-factor="([\d.e]+)")?></td><td>', text))
    assert {"mean_speed", "speed_volatility", "q_average", "contact_fraction"} <= set(cells)
    for name, factor in cells.items():
        scale = {"arcsec/s": 180 * 3600 / np.pi, "%": 100, "µm": 1e6, "ms": 1e3}
        shown = "%" if name == "contact_fraction" else QUANTITIES[name].shown
        assert float(factor or 1) == pytest.approx(scale.get(shown, 1), rel=1e-15), name


def test_a_motor_of_arrays_is_refused():
    motor = ts.load_motor().with_values({"contact_radius": [0.025, 0.026]})
    with pytest.raises(ts.ParameterError, match="contact_radius"):
        fragment(motor)


# --- in a browser: run with -m browser ----------------------------------------------------------------------
@pytest.fixture(scope="module")
def browser(tmp_path_factory):
    from selenium import webdriver
    from test_ledger_page import SWITCHES

    chosen = webdriver.ChromeOptions()
    for switch in (*SWITCHES, f"--user-data-dir={tmp_path_factory.mktemp('profile')}"):
        chosen.add_argument(switch)
    chosen.binary_location = (
        shutil.which("chromium") or shutil.which("chromium-browser") or shutil.which("google-chrome")
    )
    chosen.set_capability("goog:loggingPrefs", {"browser": "ALL"})
    driver = webdriver.Chrome(options=chosen, service=webdriver.ChromeService(shutil.which("chromedriver")))
    driver.set_script_timeout(60)
    yield driver
    driver.quit()


@pytest.fixture
def page(browser, text, tmp_path):
    """A page with nothing but the fragment, computed once."""
    path = tmp_path / "page.html"
    head = '<meta charset="utf-8"><meta name="viewport" content="width=device-width"><link rel="icon" href="data:,">'
    path.write_text(
        f'<!DOCTYPE html>\n<html lang="en"><head>{head}<title>motor</title></head><body>{text}</body></html>'
    )
    browser.get(path.as_uri())
    settled(browser)
    yield browser
    assert browser.get_log("browser") == []


def numbers(browser, expression):
    """An object of numbers that the page has, or promises; JSON has no infinity and no NaN."""
    script = (
        f"const done = arguments[0]; Promise.resolve({expression}).then("
        "(found) => done(Object.entries(found).map(([name, value]) => [name, String(value)])))"
    )
    return {name: float(value) for name, value in browser.execute_async_script(script)}


def settled(browser):
    """The figures when all that was asked for is computed."""
    return numbers(browser, "trumMotor.set({})")


def shown_figures(browser):
    """What the table of the page shows, in full precision."""
    cells = "[...document.querySelectorAll('[data-figure]')].map((cell) => [cell.dataset.figure, cell.dataset.value])"
    return numbers(browser, f"Object.fromEntries({cells})")


def enter(browser, settings):
    """Give settings as a reader does: numbers typed into the fields, words chosen from the lists."""
    from selenium.webdriver.common.by import By
    from selenium.webdriver.common.keys import Keys
    from selenium.webdriver.support.ui import Select

    for name, value in settings.items():
        if name in ("start", "phase_lead", *LEVEL_NAMES):
            Select(browser.find_element(By.CSS_SELECTOR, f"select[data-setting={name}]")).select_by_value(str(value))
        else:
            field = browser.find_element(By.CSS_SELECTOR, f"input[type=number][data-setting={name}]")
            field.send_keys(Keys.CONTROL, "a")
            field.send_keys(str(value), Keys.TAB)
    return settled(browser)


def evaluated(settings):
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", ts.ValidityWarning)
        levels = {name: value for name, value in settings.items() if name in LEVEL_NAMES}
        drive = {name: value for name, value in settings.items() if name not in LEVEL_NAMES}
        return ts.evaluate(ts.load_motor(), Drive(**drive), tolerance=TOLERANCE, **levels).figures


@pytest.mark.browser
@pytest.mark.parametrize("settings", SETTINGS, ids=str)
def test_the_browser_has_the_figures_of_the_package(page, settings):
    enter(page, settings)
    found, expected = shown_figures(page), evaluated(settings)
    every = numbers(page, "trumMotor.figures()")
    for name in QUANTITIES:
        assert every[name] == pytest.approx(expected[name], rel=1e-9), name
    assert found == {name: every[name] for name in found}
    assert len(found) >= 10


@pytest.mark.browser
def test_it_begins_with_what_the_console_prints(page, capsys):
    assert main(["evaluate", "--json"]) == 0
    printed = json.loads(capsys.readouterr().out)  # to its own, coarser tolerance
    found = numbers(page, "trumMotor.figures()")
    largest = max(abs(printed["min_speed"]), abs(printed["max_speed"]))
    for name, value in printed.items():
        if name in ("mean_speed", "min_speed", "max_speed"):
            assert found[name] == pytest.approx(value, rel=0, abs=1e-3 * largest), name
        elif name in QUANTITIES:
            assert found[name] == pytest.approx(value, rel=1e-2 if name in ("speed_volatility",) else 1e-3), name


@pytest.mark.browser
def test_random_drives_agree_too(page):
    rng = np.random.default_rng(5)
    for _ in range(25):
        settings = {
            "prepressure": float(rng.integers(100, 221)),
            "frequency_difference": float(rng.integers(-50, 51) * 100),
            "on_periods": float(rng.integers(10, 20)),
            "load_torque": float(rng.integers(-50, 51) / 100),
            "start": str(rng.choice(["periodic", "steady", "rest"])),
            "phase_lead": float(rng.choice([1, -1])),
        }
        found, expected = numbers(page, f"trumMotor.set({json.dumps(settings)})"), evaluated(settings)
        for name in QUANTITIES:  # both within their bounds: rounding may choose another step
            allowed = 2 * (expected.get(f"{name}_error") or 0.0)
            close = {"rel": 1e-8 if name == "contact_fraction" else 1e-9}
            assert found[name] == pytest.approx(expected[name], **close) or abs(found[name] - expected[name]) <= allowed


@pytest.mark.browser
def test_histories_are_those_of_simulate(page):
    numbers(page, 'trumMotor.set({load_torque: 0.05, contact: "hertz"})')
    script = "return Object.entries(trumMotor.histories()).map(([name, values]) => [name, [...values]])"
    found = {name: np.array(values) for name, values in page.execute_script(script)}
    drive = Drive(load_torque=0.05)
    orbit = ts.simulate(ts.load_motor(), drive, samples_per_period=48, contact="hertz", tolerance=TOLERANCE)
    for name in ("w_A", "w_B", "zeta_x", "Q", "theta", "rotor_speed"):
        expected = orbit[name].values
        assert found[name][:-1] == pytest.approx(expected, rel=0, abs=1e-8 * np.abs(expected).max()), name
    assert found["W_c"][:-1] == pytest.approx(np.hypot(orbit["w_A"], orbit["w_B"]), rel=1e-12)


@pytest.mark.browser
def test_sliders_move_numbers_and_pictures_by_keyboard(page):
    from selenium.webdriver.common.by import By
    from selenium.webdriver.common.keys import Keys

    pictures = "return [...document.querySelectorAll('svg:not([data-plot=load])')].map((svg) => svg.innerHTML)"
    names = page.execute_script(
        "return [...document.querySelectorAll('svg')].map((svg) => svg.getAttribute('aria-label'))"
    )
    assert all(len(name) > 30 for name in names)
    for name in ("prepressure", "frequency_difference", "on_periods", "load_torque"):
        before, drawn = shown_figures(page), page.execute_script(pictures)
        slider = page.find_element(By.CSS_SELECTOR, f"input[type=range][data-setting={name}]")
        slider.send_keys(Keys.ARROW_LEFT)
        settled(page)
        after, redrawn = shown_figures(page), page.execute_script(pictures)
        assert after["mean_speed"] != before["mean_speed"], name
        assert sum(a != b for a, b in zip(drawn, redrawn, strict=True)) >= (1 if name == "load_torque" else 5), name
    drawn = page.execute_script(pictures)
    page.find_element(By.CSS_SELECTOR, "input[type=range][data-instant]").send_keys(Keys.ARROW_RIGHT * 20)
    assert all(a != b for a, b in zip(drawn, page.execute_script(pictures), strict=True))


@pytest.mark.browser
@pytest.mark.parametrize("settings", [{}, {"on_periods": 20, "frequency_difference": 500, "compliance": "flange"}])
def test_speed_under_load_is_that_of_evaluate(page, settings):
    from selenium.webdriver.support.ui import WebDriverWait

    enter(page, settings)
    shown = "return document.querySelector('[data-plot=load] path.line')?.getAttribute('d')"
    WebDriverWait(page, 20).until(lambda browser: browser.execute_script(shown))
    current = "return trumMotor.underLoad().serial === trumMotor.serial()"
    WebDriverWait(page, 20).until(lambda browser: browser.execute_script(current))
    found = page.execute_script("const { loads, speeds } = trumMotor.underLoad(); return [loads, speeds.map(String)]")
    loads, speeds = np.array(found[0]), np.array(found[1], float)
    assert loads[0] == 0
    assert loads[-1] == pytest.approx(0.25 * 180 * 0.0265 * 23 / 24)
    for k in (0, 7, 20):
        point = evaluated({**settings, "load_torque": float(loads[k])})
        size = max(abs(point["min_speed"]), abs(point["max_speed"]))
        assert speeds[k] == pytest.approx(point["mean_speed"], abs=1e-4 * size)


@pytest.mark.browser
def test_the_slider_of_the_inertia_goes_by_decades_from_nothing(page):
    from selenium.webdriver.common.by import By
    from selenium.webdriver.common.keys import Keys

    slider, number = (
        page.find_element(By.CSS_SELECTOR, f"input[type={kind}][data-setting=load_inertia]")
        for kind in ("range", "number")
    )
    assert (slider.get_attribute("value"), number.get_attribute("value")) == ("0", "0")
    slider.send_keys(Keys.END)
    swing = {}
    for value in (1e-2, 9.55e-3):  # half a percent of four decades lower, to three digits
        settled(page)
        assert float(number.get_attribute("value")) == page.execute_script("return trumMotor.settings().load_inertia")
        assert float(number.get_attribute("value")) == value
        swing[value] = np.subtract(*(shown_figures(page)[name] for name in ("max_speed", "min_speed")))
        slider.send_keys(Keys.ARROW_LEFT)
    assert swing[1e-2] < swing[9.55e-3]
    enter(page, {"load_inertia": 1e-4})
    assert float(slider.get_attribute("value")) == 50  # two of four decades
    slider.send_keys(Keys.HOME)
    settled(page)
    assert page.execute_script("return trumMotor.settings().load_inertia") == 0


@pytest.mark.browser
def test_what_the_motor_cannot_do_is_said_and_bad_numbers_are_not_taken(page):
    from selenium.webdriver.common.by import By

    note = page.find_element(By.CLASS_NAME, "trum-note")
    enter(page, {"load_torque": 5})
    assert "no speed balances the load" in note.text
    assert np.isnan(shown_figures(page)["mean_speed"])
    enter(page, {"load_torque": 0.1, "prepressure": 60})
    assert "measured at other prepressures" in note.text
    before = shown_figures(page)
    enter(page, {"prepressure": -3})
    assert shown_figures(page) == before
    page.find_element(By.CSS_SELECTOR, "[data-action=reset]").click()
    settled(page)
    assert page.execute_script("return trumMotor.settings().prepressure") == 180


@pytest.mark.browser
@pytest.mark.parametrize("width", [390, 1200])
def test_it_fits_the_width(page, width):
    page.execute_cdp_cmd(
        "Emulation.setDeviceMetricsOverride",
        {"width": width, "height": 900, "deviceScaleFactor": 1, "mobile": width < 500},
    )
    sizes = page.execute_script(
        "return [document.documentElement.scrollWidth, innerWidth, "
        "...[...document.querySelectorAll('.trum svg')].map((s) => s.getBoundingClientRect().width)]"
    )
    assert sizes[0] <= sizes[1] == width
    assert min(sizes[2:]) > 250
    page.execute_cdp_cmd("Emulation.clearDeviceMetricsOverride", {})
