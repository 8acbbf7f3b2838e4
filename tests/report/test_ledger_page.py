"""The page: complete and without network, read as text always, opened in a browser on request."""

from __future__ import annotations

import json
import re
import shutil
from html.parser import HTMLParser
from pathlib import Path

import pytest
from lazily import lazily

ledger = lazily("derivations.ledger")
html = lazily("derivations.ledger.html")

ROOT = Path(__file__).parents[2]
PAGE = ROOT / "generated" / "ledger.html"
VOID = {"meta", "link", "input", "br", "img", "hr"}


class Reader(HTMLParser):
    def __init__(self):
        super().__init__()
        self.ids, self.links, self.articles, self.open, self.svgs = [], [], [], [], 0

    def handle_starttag(self, tag, attributes):
        found = dict(attributes)
        self.ids += [found["id"]] if "id" in found else []
        self.links += [found[key] for key in ("href", "src", "action", "data") if found.get(key)]
        self.articles += [(found["id"], found["data-verdict"])] if tag == "article" else []
        self.svgs += tag == "svg"
        if tag not in VOID:
            self.open.append(tag)

    def handle_startendtag(self, tag, attributes):
        self.handle_starttag(tag, attributes)
        if tag not in VOID:
            self.open.pop()

    def handle_endtag(self, tag):
        assert self.open.pop() == tag


@pytest.fixture(scope="module")
def text():
    return PAGE.read_text("utf-8")


@pytest.fixture(scope="module")
def reader(text):
    found = Reader()
    found.feed(text)
    return found


def test_every_entry_has_its_article_in_order(reader):
    assert reader.articles == [(html.anchor(e.id), e.verdict) for e in ledger.ENTRIES]


def test_it_is_well_formed_with_unique_ids_and_links_that_lead_somewhere(reader):
    assert reader.open == []
    assert len(set(reader.ids)) == len(reader.ids)
    assert {link[1:] for link in reader.links if link.startswith("#")} <= set(reader.ids)


def test_it_asks_nothing_of_any_network(reader, text):
    assert [link for link in reader.links if not link.startswith(("#", "data:"))] == []
    addresses = set(re.findall(r"https?://[^\s\"'<)]+", text))
    assert addresses <= {"http://www.w3.org/1998/Math/MathML"}
    assert "@import" not in text


def test_formulas_are_mathml_and_errors_are_drawn(reader, text):
    records = json.loads((ROOT / "generated" / "ledger.json").read_text("utf-8"))
    formulas = sum(
        len(r["printed_latex"] or []) + len(r["derived_latex"] or []) + sum(len(s["latex"]) for s in r["steps"])
        for r in records
    )
    assert text.count('class="formula"') == formulas
    assert reader.svgs == sum(e.picture is not None for e in ledger.ENTRIES) >= 5
    shown = re.sub(r"<[^>]+>", "", text[text.index("<article") : text.index('<section id="nomenclature"')])
    assert "\\" not in shown  # LaTeX that was not understood


def test_the_page_is_what_the_ledger_gives(text):
    records = json.loads((ROOT / "generated" / "ledger.json").read_text("utf-8"))
    assert html.page(records, ledger.ENTRIES) == text


# --- in a browser: run with -m browser ----------------------------------------------------------------------
SWITCHES = (
    "--headless",
    "--no-sandbox",
    "--disable-gpu",
    "--disable-quic",
    "--no-first-run",
    "--disable-sync",
    "--disable-background-networking",
    "--disable-component-update",
    "--window-size=1100,1400",
)


@pytest.fixture
def browser(tmp_path):
    from selenium import webdriver

    chosen = webdriver.ChromeOptions()
    for switch in (*SWITCHES, f"--user-data-dir={tmp_path}"):
        chosen.add_argument(switch)
    chosen.binary_location = (
        shutil.which("chromium") or shutil.which("chromium-browser") or shutil.which("google-chrome")
    )
    chosen.set_capability("goog:loggingPrefs", {"browser": "ALL"})
    driver = webdriver.Chrome(options=chosen, service=webdriver.ChromeService(shutil.which("chromedriver")))
    yield driver
    driver.quit()


@pytest.mark.browser
def test_it_opens_filters_searches_and_finds_its_anchors(browser):
    from selenium.webdriver.common.by import By

    def visible():
        return [a.get_attribute("id") for a in browser.find_elements(By.TAG_NAME, "article") if a.is_displayed()]

    browser.get(PAGE.as_uri())
    assert visible() == [html.anchor(e.id) for e in ledger.ENTRIES]
    records = json.loads((ROOT / "generated" / "ledger.json").read_text("utf-8"))
    for key, kind in (("severity", "structural"), ("verdict", "erratum")):
        browser.find_element(By.CSS_SELECTOR, f'button[data-kind="{kind}"]').click()
        assert visible() == [html.anchor(r["id"]) for r in records if r[key] == kind]
    browser.get(PAGE.as_uri() + "#eq-1")  # hidden by the filter until asked for
    assert "eq-1" in visible()
    box = browser.find_element(By.ID, "search")
    box.send_keys("(24)")
    assert "eq-24" in visible()
    assert len(visible()) < len(ledger.ENTRIES)
    heights = browser.execute_script(
        "return [...document.querySelectorAll('math')].map(m => m.getBBox ? 1 : m.offsetHeight)"
    )
    assert len(heights) > len(ledger.ENTRIES)
    assert [entry for entry in browser.get_log("browser") if entry["level"] in ("SEVERE", "WARNING")] == []


HIDDEN = """
for (const d of document.querySelectorAll('details')) d.open = true;
return new Promise((done) => setTimeout(() => done([...document.querySelectorAll('.wide')].map(
  (box) => [box.scrollWidth > box.clientWidth + 1, getComputedStyle(box, '::before').content.includes('side')])), 200));
"""


@pytest.mark.browser
def test_a_narrow_screen_says_where_more_is_to_the_side_and_keeps_the_pictures_readable(browser):
    browser.execute_cdp_cmd(
        "Emulation.setDeviceMetricsOverride", {"width": 390, "height": 900, "deviceScaleFactor": 1, "mobile": True}
    )
    browser.get(PAGE.as_uri())
    assert browser.execute_script("return document.documentElement.scrollWidth") <= 390
    boxes = browser.execute_script(HIDDEN)
    assert sum(wide for wide, _ in boxes) > 5
    assert all(wide == said for wide, said in boxes)
    pictures = browser.execute_script(
        "return [...document.querySelectorAll('figure svg')].map((s) => s.getBoundingClientRect().width)"
    )
    assert min(pictures) >= 38 * 16  # of 7 inches with labels of 9 points: 11 pixels
