"""The report: complete, without network, the same on every run, refused in one line; read as text and in a browser."""

from __future__ import annotations

import os
import re
import shutil
import subprocess
import sys
from dataclasses import replace
from pathlib import Path

import pytest
from test_interactive import SETTINGS, enter, evaluated, numbers, settled, shown_figures
from test_ledger_page import HIDDEN, Reader

import trum_sym as ts
from trum_sym import report
from trum_sym.console import main
from trum_sym.paper.published import TABLE_2
from trum_sym.paper.tables import TABLE_1, TABLE_4, tables
from trum_sym.quantities import QUANTITIES
from trum_sym.report import output
from trum_sym.report.catalogue import PICTURES

TABLES = ["table-1", "table-assumed", "table-2", "table-3", "table-4", "table-5"]
whole_page = pytest.mark.slow  # it takes minutes to draw and judge; .ci/run draws it, and opens it in a browser


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    place = tmp_path_factory.mktemp("report") / "not" / "there"
    assert main(["report", str(place)]) == 0
    return place


@pytest.fixture(scope="module")
def text(folder):
    return (folder / "index.html").read_text("utf-8")


@pytest.fixture(scope="module")
def reader(text):
    return read(text)


@whole_page
def test_two_files_are_written_and_the_page_is_small(folder):
    assert sorted(path.name for path in folder.iterdir()) == ["index.html", "ledger.html"]
    assert (folder / "index.html").stat().st_size < 15_000_000
    ledger = Path(__file__).parents[2] / "generated" / "ledger.html"
    assert (folder / "ledger.html").read_text("utf-8") == ledger.read_text("utf-8")


def read(text):
    found = Reader()
    found.feed(text)
    return found


def test_a_page_of_a_few_pictures_is_well_formed_and_asks_nothing_of_any_network(monkeypatch, tmp_path, trum60):
    """For a motor that the paper is not about, which has no claims."""
    few = [picture for picture in PICTURES if picture.anchor in ("figure-25b", "torque-speed")]
    monkeypatch.setattr(sys.modules[report.page.__module__], "PICTURES", few)
    report.write_report(replace(trum60, name="Another <motor>", published=()), tmp_path)
    assert sorted(path.name for path in tmp_path.iterdir()) == ["index.html", "ledger.html"]
    text = (tmp_path / "index.html").read_text("utf-8")
    found = read(text)
    assert found.open == []
    assert len(set(found.ids)) == len(found.ids)
    assert {"figure-25b", "torque-speed", *TABLES} <= set(found.ids)
    assert text.count('class="claim"') == 0
    assert "Another &lt;motor&gt;" in text
    assert set(re.findall(r"https?://[^\s\"'<)]+", text)) == {"http://www.w3.org/2000/svg"}


@whole_page
def test_it_is_well_formed_with_unique_ids_and_links_that_lead_somewhere(reader):
    assert reader.open == []
    assert len(set(reader.ids)) == len(reader.ids)
    inner = {link[1:] for link in reader.links if link.startswith("#")}
    assert inner <= set(reader.ids)
    outer = {link for link in reader.links if not link.startswith(("#", "data:"))}
    assert outer == {"ledger.html"}


@whole_page
def test_it_asks_nothing_of_any_network(text):
    assert set(re.findall(r"https?://[^\s\"'<)]+", text)) == {"http://www.w3.org/2000/svg"}
    assert "@import" not in text


@whole_page
def test_every_figure_and_table_is_there_with_words_for_who_does_not_see_it(reader, text):
    for picture in PICTURES:
        (start,) = [m.end() for m in re.finditer(f'<figure id="{re.escape(picture.anchor)}"', text)]
        body = text[start : text.index("</figure>", start)]
        assert body.count("<svg") == 1
        assert 'role="img"' in body
        assert len(re.search(r"<title>(.+?)</title>", body)[1]) > 40
        assert "var(--ink)" in body  # follows light and dark
        assert "#1b1f24" not in body
    assert {*TABLES, "coupling", "coupling-frequency", "coupling-load", "coupling-pulses"} <= set(reader.ids)


@whole_page
def test_every_claim_is_shown_with_its_verdict_and_linked_from_what_shows_it(text):
    shown = re.findall(r'<article class="claim" id="(claim-[^"]+)" data-verdict="([^"]+)"', text)
    assert len(shown) >= 25
    assert len({verdict for _, verdict in shown}) == 4
    for name, _ in shown:
        assert text.count(f'href="#{name}"') == 2  # itself, and the figure or table that shows it
    assert len(re.findall(r"<tr>", text[text.index('id="readings-all"') :])) > 800
    for anchor, rows in (("claims-inertia", 24), ("trends-inertia", 12)):
        table = text[text.index(f'id="{anchor}"') :]
        assert table[: table.index("</table>")].count("<tr>") == rows + 1


@whole_page
def test_the_page_is_the_same_in_another_process(folder, tmp_path):
    environment = {**os.environ, "PYTHONHASHSEED": "4711", "TZ": "Asia/Tokyo", "SOURCE_DATE_EPOCH": "0"}
    subprocess.run(
        [sys.executable, "-m", "trum_sym", "report", tmp_path], env=environment, check=True, capture_output=True
    )
    assert (tmp_path / "index.html").read_bytes() == (folder / "index.html").read_bytes()


# --- tables --------------------------------------------------------------------------------------------------
def test_tables_hold_what_the_paper_prints_and_what_the_motor_has(trum60):
    one, assumed, two, three, four, five = tables(trum60)
    assert [table.anchor for table in (one, assumed, two, three, four, five)] == TABLES
    rows = {row[0]: row for row in one.rows}
    assert rows["R"][2:6] == ("60", "mm", "30", "−50.00 %")
    assert rows["E_m"][2:6] == ("5", "GPa", "5", "=")
    assert all(row[6] for row in one.rows if row[5] != "=")  # every difference has its reason
    assert {row[0] for row in one.rows if row[5] != "="} == {"R", "U_s"}  # a diameter, a peak-to-peak voltage
    assert len(one.rows) == len(TABLE_1) == 25
    coupled = {"m_r", "eta_m", "c_p", "eps_33T", "tan_delta"}
    section = {"b_p", "d_31", "s_11E", "μ", "r_c", "r_t", "h_f", "l_f", "E_f", "μ_f"}
    assert {row[0] for row in assumed.rows} == section | coupled
    for force, _, ours, _ in two.rows:
        assert float(ours) == pytest.approx(14.926 * float(force) ** -0.678 * 12.6, abs=6e-4)  # eq. 8
    assert [row[1] for row in two.rows] == [f"{1e6 * value:g}" for value in TABLE_2.values()]
    assert all(row[1].split()[0] == row[2].split()[0] for row in three.rows)


def number(cell):
    return float(cell.split(" (")[0].replace("−", "-"))


def test_table_4_is_evaluate_in_every_reading_and_table_5_the_six_points(trum60):
    *_, four, five = tables(trum60)
    assert four.rows[0][2:] == tuple(f"{value:g}" for value in TABLE_4.values())
    assert [row[1] for row in four.rows[1:]] == 6 * ["no", "a weight"]
    weight = trum60.with_values({"rotor_inertia": 4.5e-6 + 0.3 * 0.030 / 9.80665})
    for row in four.rows[1:]:
        start, lead = row[0].replace("−", "-").split(", lead ")
        motor = trum60 if row[1] == "no" else weight
        point = ts.evaluate(motor, ts.Drive(start=start, phase_lead=int(lead)), sampling_period=2e-3)
        assert number(row[5]) == pytest.approx(point.q_average, rel=1e-4)
        assert number(row[6]) == pytest.approx(point.q_volatility, rel=1e-4)
        assert number(row[4]) == pytest.approx(100 * point.speed_volatility, rel=1e-4)
        assert number(row[2]) == pytest.approx(point.mean_speed * 648000 / 3.141592653589793, rel=1e-4)
        # readings spread over a few of their deviations to either side of the mean
        assert 2 < number(row[3]) / (abs(number(row[2])) * number(row[4]) / 100) < 4
    assert [row[2:4] for row in five.rows[:3]] == [("180", "3300"), ("170", "3100"), ("160", "3000")]
    drive = ts.Drive(prepressure=190.0, frequency_difference=2800.0, start="rest", phase_lead=-1)
    measured = ts.evaluate(weight, drive, sampling_period=2e-3)
    assert number(five.rows[9][5]) == pytest.approx(measured.q_average, rel=1e-4)
    assert number(five.rows[9][6]) == pytest.approx(100 * measured.speed_volatility, rel=1e-4)


# --- what is refused, and what is left when something fails --------------------------------------------------
def test_a_file_in_place_of_the_folder_is_refused(console_refuses, tmp_path):
    file = tmp_path / "file"
    file.write_text("mine")
    console_refuses("report", str(file), naming=("DIR", "file", "a folder"))
    console_refuses("report", str(file / "below"), naming=("DIR", "a folder to write in"))
    assert file.read_text() == "mine"


def test_a_folder_that_cannot_be_written_to_is_refused(console_refuses):
    console_refuses("report", "/proc/self", naming=("DIR", "/proc/self", "a folder to write in"))


def test_an_unknown_motor_is_refused_before_anything_is_made(console_refuses, tmp_path):
    console_refuses("report", str(tmp_path / "out"), "--motor", "trum61", naming=("motor", "trum61"))
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("package", ["matplotlib", "jinja2"])
def test_a_missing_package_is_one_line(monkeypatch, tmp_path, capsys, package):
    monkeypatch.setitem(sys.modules, package, None)
    assert main(["report", str(tmp_path)]) == 2
    out, err = capsys.readouterr()
    assert out == ""
    assert err.splitlines()[-1].endswith("pip install 'trum-sym[report]'")
    assert "Traceback" not in err
    assert list(tmp_path.iterdir()) == []


def test_a_page_that_fails_leaves_the_old_one(monkeypatch, tmp_path, trum60):
    (tmp_path / "index.html").write_text("old")

    def fails(*_, **__):
        raise RuntimeError("no page")

    monkeypatch.setattr(output, "page", fails)
    with pytest.raises(RuntimeError, match="no page"):
        report.write_report(trum60, tmp_path)
    assert [path.name for path in tmp_path.iterdir()] == ["index.html"]
    assert (tmp_path / "index.html").read_text() == "old"


# --- in a browser: run with -m browser -----------------------------------------------------------------------
@pytest.fixture
def browser(tmp_path):
    from selenium import webdriver
    from test_ledger_page import SWITCHES

    chosen = webdriver.ChromeOptions()
    for switch in (*SWITCHES, f"--user-data-dir={tmp_path}"):
        chosen.add_argument(switch)
    chosen.binary_location = (
        shutil.which("chromium") or shutil.which("chromium-browser") or shutil.which("google-chrome")
    )
    chosen.set_capability("goog:loggingPrefs", {"browser": "ALL"})
    driver = webdriver.Chrome(options=chosen, service=webdriver.ChromeService(shutil.which("chromedriver")))
    driver.set_script_timeout(60)
    yield driver
    assert driver.get_log("browser") == []
    driver.quit()


@pytest.mark.browser
@pytest.mark.parametrize("width", [390, 1200])
def test_it_opens_and_shows_every_picture_within_the_width(browser, folder, width):
    browser.execute_cdp_cmd(
        "Emulation.setDeviceMetricsOverride",
        {"width": width, "height": 900, "deviceScaleFactor": 1, "mobile": width < 600},
    )
    browser.get((folder / "index.html").as_uri())
    sizes = browser.execute_script(
        "return [...document.querySelectorAll('.stop .wide > svg')].map(s => {"
        "const box = s.getBoundingClientRect(); return [s.closest('figure').id, box.width, box.height]; })"
    )
    assert [name for name, *_ in sizes] == [picture.anchor for picture in PICTURES]
    assert all(w > 500 and h > 100 for _, w, h in sizes)
    assert browser.execute_script("return document.documentElement.scrollWidth") <= width
    words = browser.execute_script(
        "return [...document.querySelectorAll('.stop svg text')].map(t => t.getBoundingClientRect().height)"
    )
    assert min(words) > 7


@pytest.mark.browser
def test_it_is_navigated_by_keyboard_filtered_and_turned_dark(browser, folder):
    from selenium.webdriver.common.by import By

    browser.get((folder / "index.html").as_uri())
    body = browser.find_element(By.TAG_NAME, "body")
    focused = []
    for key in "jjjk":
        body.send_keys(key)
        focused.append(browser.execute_script("return document.activeElement.id"))
    anchors = [picture.anchor for picture in PICTURES]
    assert focused == [anchors[0], anchors[1], anchors[2], anchors[1]]
    background = "return getComputedStyle(document.body).backgroundColor"
    ink = "return getComputedStyle(document.querySelector('#figure-3 svg text')).fill"
    before = (browser.execute_script(background), browser.execute_script(ink))
    browser.find_element(By.ID, "theme").click()
    after = (browser.execute_script(background), browser.execute_script(ink))
    assert before[0] != after[0]
    assert before[1] != after[1]
    browser.find_element(By.CSS_SELECTOR, '.filter button[data-verdict="contradicted"]').click()
    visible = [c for c in browser.find_elements(By.CLASS_NAME, "claim") if c.is_displayed()]
    assert {c.get_attribute("data-verdict") for c in visible} == {"contradicted"}
    hidden = browser.execute_script("return document.querySelector('.claim[hidden]').id")
    browser.execute_script(f"location.hash = '{hidden}'")
    assert browser.find_element(By.ID, hidden).is_displayed()
    browser.find_element(By.LINK_TEXT, "Ledger of equations").click()
    assert browser.title.startswith("The ledger")


@pytest.mark.browser
def test_its_sliders_give_the_figures_of_the_package(browser, folder):
    from selenium.webdriver.common.by import By
    from selenium.webdriver.common.keys import Keys

    browser.get((folder / "index.html").as_uri())
    settled(browser)
    before = shown_figures(browser)
    browser.find_element(By.CSS_SELECTOR, "input[type=range][data-setting=prepressure]").send_keys(Keys.ARROW_LEFT)
    settled(browser)
    assert shown_figures(browser)["mean_speed"] != before["mean_speed"]
    for settings in SETTINGS:
        browser.find_element(By.CSS_SELECTOR, "[data-action=reset]").click()
        enter(browser, settings)
        expected, every = evaluated(settings), numbers(browser, "trumMotor.figures()")
        for name in QUANTITIES:
            assert every[name] == pytest.approx(expected[name], rel=1e-9), name


@pytest.mark.browser
def test_a_narrow_screen_says_where_more_is_to_the_side(browser, folder):
    browser.execute_cdp_cmd(
        "Emulation.setDeviceMetricsOverride", {"width": 390, "height": 900, "deviceScaleFactor": 1, "mobile": True}
    )
    browser.get((folder / "index.html").as_uri())
    boxes = browser.execute_script(HIDDEN)
    assert sum(wide for wide, _ in boxes) > 20
    assert all(wide == said for wide, said in boxes)
