"""The report's interactive part: made of what is here, complete without a network, its numbers the package's."""

from __future__ import annotations

import json
import re
import shlex
import shutil
import warnings

import numpy as np
import pytest

import trum_sym as ts
from derivations.codegen import wasm
from trum_sym.console import main
from trum_sym.inputs.drive import Drive
from trum_sym.inputs.motor import SPECS
from trum_sym.model.levels import LEVEL_NAMES
from trum_sym.quantities import QUANTITIES
from trum_sym.report.interactive import fragment

TOLERANCE = 1e-9
ROTOR_ALONE = ("load_torque", "friction_coefficient")  # the vibration does not depend on them
SETTINGS = [
    {},
    {"prepressure": 165, "frequency_difference": 2800, "on_periods": 12},
    {"start": "rest", "phase_lead": -1, "load_torque": 0.1},
    {"start": "steady", "frequency_difference": -1500, "load_torque": -0.05, "prepressure": 210},
    {"compliance": "flange", "load_torque": 0.05, "frequency_difference": 2000},
    {"load_inertia": 1e-3, "start": "rest", "phase_lead": -1},
    {"friction_coefficient": 0.15, "load_torque": 0.05},
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
    assert {"prepressure", "frequency_difference", "periods", "on_periods", "load_torque", "load_inertia"} <= settings
    assert {"start", "friction_coefficient"} <= settings
    assert settings <= {*Drive().numbers(), "start", *LEVEL_NAMES, *SPECS}
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
        values = {name: value for name, value in settings.items() if name in SPECS}
        drive = {name: value for name, value in settings.items() if name not in {*levels, *values}}
        return ts.evaluate(ts.load_motor().with_values(values), Drive(**drive), tolerance=TOLERANCE, **levels).figures


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
    for name in ("prepressure", "frequency_difference", "on_periods", "load_torque", "friction_coefficient"):
        before, drawn = shown_figures(page), page.execute_script(pictures)
        slider = page.find_element(By.CSS_SELECTOR, f"input[type=range][data-setting={name}]")
        slider.send_keys(Keys.ARROW_LEFT)
        settled(page)
        after, redrawn = shown_figures(page), page.execute_script(pictures)
        assert after["mean_speed"] != before["mean_speed"], name
        assert sum(a != b for a, b in zip(drawn, redrawn, strict=True)) >= (1 if name in ROTOR_ALONE else 4), name
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


# --- the moving picture -------------------------------------------------------------------------------------
def film(browser, settings=None):
    """The film of settings, and the histories that go with it, as arrays."""
    from selenium.webdriver.support.ui import WebDriverWait

    numbers(browser, f"trumMotor.set({json.dumps(settings or {})})")
    current = "return trumMotor.moving.film()?.serial === trumMotor.serial()"
    WebDriverWait(browser, 30).until(lambda browser: browser.execute_script(current))
    found = browser.execute_script(
        "const f = trumMotor.moving.film(), h = trumMotor.histories(); const list = (x) => [...x];"
        "return { film: f.film, count: f.count, columns: f.columns, points: f.points, length: f.length,"
        "heights: list(f.heights), along: list(f.along), up: list(f.up),"
        "speeds: f.speeds.map(list), ways: f.ways.map(list),"
        "h: ['w_A', 'w_B', 'W_c', 'theta', 'crest', 'level', 'rotor_speed'].map((name) => [name, list(h[name])]) }"
    )
    rows = found["count"] + 1
    for name, length in (("heights", "columns"), ("along", "points"), ("up", "points")):
        found[name] = np.array(found[name]).reshape(rows, found[length])
    return found, {name: np.array(values, float) for name, values in found["h"]}


@pytest.mark.browser
def test_the_wave_stands_where_the_phases_put_it_and_the_zone_is_its_top(page):
    found, at = film(page, {"load_torque": 0.1})
    place = np.linspace(0, found["length"], found["columns"])
    assert found["length"] == pytest.approx(4 * np.pi / 300)  # two waves of k_c = 300 1/m
    wave = at["w_A"][:, None] * np.sin(300 * place) + at["w_B"][:, None] * np.cos(300 * place)  # eq. 11
    top = np.abs(wave).max()
    assert found["heights"] == pytest.approx(wave, abs=1e-6 * top)
    crest = at["w_A"] * np.sin(300 * at["crest"]) + at["w_B"] * np.cos(300 * at["crest"])
    assert crest == pytest.approx(np.hypot(at["w_A"], at["w_B"]), rel=1e-12)  # nothing is higher
    assert at["level"] == pytest.approx(at["W_c"] * np.cos(at["theta"]), abs=1e-12 * top)
    share = (found["heights"] >= at["level"][:, None]).mean(axis=1)  # a column is 1/96 of a wave
    assert share == pytest.approx(at["theta"] / np.pi, abs=2 / found["columns"] + 1 / 96)
    period = round(found["count"] / 20)
    now = found["count"] // 2
    assert found["up"][now, -1] == pytest.approx(crest[now], rel=1e-6)
    assert abs(found["along"][now, -1]) < 1e-6 * top  # a crest has no slope
    path = (
        wave[now - period : now + 1]
        @ np.eye(found["columns"])[np.argmin(np.abs(place - at["crest"][now] % (2 * np.pi / 300)))]
    )
    assert found["up"][now] == pytest.approx(path, abs=0.03 * top)  # the next column is 1/96 of a wave away


@pytest.mark.browser
@pytest.mark.parametrize("settings", [{"load_torque": 0.05}, {"load_torque": 0.0, "load_inertia": 2e-3}], ids=str)
def test_the_rotor_starts_from_rest_as_an_independent_integration_does(page, settings):
    from orbit_reference import Reference

    found, at = film(page, settings)
    motor, drive = ts.load_motor(), Drive(**settings)
    turning = float(motor.rotor_inertia.value) + settings.get("load_inertia", 0.0)
    loaded = motor.with_values({"rotor_inertia": turning})
    reference = Reference(loaded, drive, ts.evaluate(motor, drive), tolerance=1e-9)
    rim = 0.0
    for speed, way in zip(found["speeds"][:3], found["ways"][:3], strict=False):
        state, *_ = reference.lap(rim, 1e-9)
        assert way[-1] == pytest.approx(
            rim * reference.cycle_time + state[1], abs=1e-5 * reference.scale * reference.cycle_time
        )
        rim += state[0]
        assert speed[-1] == pytest.approx(rim / reference.radius, abs=1e-5 * reference.scale / reference.radius)
    step = reference.cycle_time / found["count"]
    speed, way = np.array([0.0, *found["speeds"][0]]), np.array([0.0, *found["ways"][0]])
    ran = np.concatenate([[0.0], np.cumsum(step * (speed[1:] + speed[:-1]) / 2)]) * reference.radius
    assert way == pytest.approx(ran, abs=1e-3 * np.abs(way).max())
    if len(found["speeds"]) < 60:  # it came to the cycle that repeats itself
        last = np.array(found["speeds"][-1])
        assert last == pytest.approx(at["rotor_speed"][1:], abs=5e-3 * np.abs(last).max())


@pytest.mark.browser
def test_it_plays_pauses_steps_a_period_and_starts_from_rest_by_keyboard(page):
    from selenium.webdriver.common.by import By
    from selenium.webdriver.common.keys import Keys
    from selenium.webdriver.support.ui import WebDriverWait

    film(page)
    place = "return trumMotor.moving.place()"
    stands = "return !trumMotor.moving.playing()"
    button = {name: page.find_element(By.CSS_SELECTOR, f"[data-action={name}]") for name in ("play", "period", "rest")}
    told = page.find_element(By.CLASS_NAME, "trum-now")
    button["rest"].send_keys(Keys.ENTER)
    assert page.execute_script(place) == {"lap": 0, "sample": 0}
    assert "Cycle 1 of" in told.text
    assert "phase A off, phase B on" in told.text  # A rests first
    page.execute_script("document.querySelector('[data-pace]').value = 4")
    button["period"].send_keys(Keys.SPACE)
    WebDriverWait(page, 10).until(lambda browser: browser.execute_script(stands))
    assert page.execute_script(place) == {"lap": 0, "sample": 48}
    assert "period 2 of 20" in told.text
    drawing = "return document.querySelector('[data-moving]').toDataURL()"
    before = page.execute_script(drawing)
    button["play"].send_keys(Keys.ENTER)
    assert button["play"].text == "Pause"
    WebDriverWait(page, 10).until(lambda browser: browser.execute_script(place)["sample"] > 72)
    button["play"].send_keys(Keys.ENTER)
    assert button["play"].text == "Play"
    assert page.execute_script(stands)
    assert page.execute_script(drawing) != before
    stopped = page.execute_script(place)
    assert float(page.find_element(By.CSS_SELECTOR, "input[type=number][data-instant]").get_attribute("value")) == (
        pytest.approx(100 * stopped["sample"] / (48 * 20), abs=0.05)
    )
    assert page.find_element(By.CSS_SELECTOR, "[data-moving]").get_attribute("aria-label") == told.text
    film(page, {"prepressure": -1})
    assert "Nothing moves" in told.text
    film(page, {"prepressure": 180})


@pytest.mark.browser
def test_who_wants_no_motion_sees_steps(page):
    from selenium.webdriver.common.by import By

    page.execute_cdp_cmd(
        "Emulation.setEmulatedMedia", {"features": [{"name": "prefers-reduced-motion", "value": "reduce"}]}
    )
    film(page)
    page.find_element(By.CSS_SELECTOR, "[data-action=rest]").click()
    page.find_element(By.CSS_SELECTOR, "[data-action=period]").click()
    assert page.execute_script("return [trumMotor.moving.playing(), trumMotor.moving.place().sample]") == [False, 48]
    page.execute_cdp_cmd("Emulation.setEmulatedMedia", {"features": []})


@pytest.mark.browser
def test_a_drive_has_an_address_and_a_bad_one_changes_nothing(page):
    address = page.current_url.split("#")[0]
    found = numbers(page, "trumMotor.set({prepressure: 165, friction_coefficient: 0.3, start: 'rest'})")
    words = page.execute_script("return location.hash")
    assert words == "#prepressure=165&friction_coefficient=0.3&start=rest"
    for after, expected in ((words, found), ("#prepressure=-4&contact=wood&height=7&start=soon&load_torque=", None)):
        page.get("about:blank")
        page.get(address + after)
        assert settled(page)["mean_speed"] == (expected or evaluated({}))["mean_speed"] or expected is None
        taken = page.execute_script("return trumMotor.settings()")
        assert (taken["prepressure"], taken["start"]) == ((165, "rest") if expected else (180, "periodic"))
    page.execute_script("location.hash = '#prepressure=170'")
    from selenium.webdriver.support.ui import WebDriverWait

    WebDriverWait(page, 10).until(
        lambda browser: browser.execute_script("return trumMotor.settings().prepressure") == 170
    )


@pytest.mark.browser
def test_a_drive_copied_as_a_command_or_as_python_gives_its_figures(page, capsys):
    settings = {
        "prepressure": 165.5,
        "load_torque": 0.05,
        "friction_coefficient": 0.3,
        "compliance": "flange",
        "phase_lead": -1,
    }
    found = numbers(page, f"trumMotor.set({json.dumps(settings)})")
    page.execute_script("document.querySelector('[data-copy=command]').click()")
    command = page.execute_script("return document.querySelector('.trum-copied').textContent")
    program, *words = shlex.split(command)
    assert program == "trum-sym"
    capsys.readouterr()
    assert main([*words, "--json", "--tolerance", "1e-6"]) == 0
    printed = json.loads(capsys.readouterr().out)
    space: dict[str, object] = {}
    exec(page.execute_script("return trumMotor.elsewhere().python"), space)
    capsys.readouterr()
    for name in ("mean_speed", "max_speed", "stall_torque", "q_average"):
        size = abs(found["max_speed"]) if "speed" in name else abs(found[name])
        assert printed[name] == pytest.approx(found[name], abs=1e-5 * size), name
        assert getattr(space["point"], name) == pytest.approx(found[name], abs=2e-3 * size), name


def test_a_command_takes_the_motor_that_the_page_has(tmp_path):
    from trum_sym.report.interactive import _as_given

    assert _as_given(ts.load_motor("ring60"))["motor"] == "ring60"
    assert _as_given(ts.load_motor().with_values({"contact_radius": 0.026}))["set"] == {"contact_radius": 0.026}
    (tmp_path / "own.toml").write_text(ts.load_motor().text + "\n# mine\n")
    assert _as_given(ts.load_motor(tmp_path / "own.toml"))["motor"] == "my.toml"
