"""The built site in a browser, from a folder: no complaint, nothing runs over a narrow screen, and search finds."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
PAGES = ("index", "tutorial", "how-to", "api", "api/trum_sym.evaluate", "console/evaluate", "ledger/eq-24", "kernels")


@pytest.fixture(scope="module")
def site(tmp_path_factory):
    """The site built anew, or the one that ``.ci/run`` has built just before and names."""
    if "TRUM_SITE" in os.environ:
        return Path(os.environ["TRUM_SITE"]).resolve()
    folder = tmp_path_factory.mktemp("site")
    subprocess.run([sys.executable, "-m", "docs", "--out", folder], cwd=ROOT, check=True)
    return folder / "html"


@pytest.fixture
def browser(tmp_path):
    from selenium import webdriver

    chosen = webdriver.ChromeOptions()
    for switch in ("--headless", "--no-sandbox", "--disable-gpu", "--no-first-run", f"--user-data-dir={tmp_path}"):
        chosen.add_argument(switch)
    chosen.binary_location = shutil.which("chromium") or shutil.which("google-chrome")
    chosen.set_capability("goog:loggingPrefs", {"browser": "ALL"})
    driver = webdriver.Chrome(options=chosen, service=webdriver.ChromeService(shutil.which("chromedriver")))
    yield driver
    driver.quit()


def complaints(driver):
    return [entry for entry in driver.get_log("browser") if entry["level"] in ("SEVERE", "WARNING")]


UNNAMED = """return [...document.querySelectorAll('button, summary')].filter(
  (one) => one.checkVisibility() && !one.ariaLabel && !one.textContent.trim()).map((one) => one.outerHTML)"""


@pytest.mark.browser
def test_pages_open_from_a_folder_at_both_widths_in_light_and_dark(site, browser):
    for width, mode in ((1280, "light"), (1280, "dark"), (390, "light"), (390, "dark")):
        size = {"width": width, "height": 900, "deviceScaleFactor": 1, "mobile": width < 500}
        browser.execute_cdp_cmd("Emulation.setDeviceMetricsOverride", size)
        features = [{"name": "prefers-color-scheme", "value": mode}]
        browser.execute_cdp_cmd("Emulation.setEmulatedMedia", {"features": features})
        for page in PAGES:
            browser.get((site / f"{page}.html").as_uri())
            assert browser.execute_script("return document.documentElement.dataset.theme") == mode
            assert browser.execute_script("return document.documentElement.scrollWidth") <= width, page
            assert browser.execute_script(UNNAMED) == []
            assert complaints(browser) == []


@pytest.mark.browser
def test_the_search_works_without_a_server(site, browser):
    from selenium.webdriver.support.ui import WebDriverWait

    browser.get((site / "search.html").as_uri() + "?q=prepressure")
    found = "return document.querySelectorAll('ul.search li').length > 5"
    assert WebDriverWait(browser, 30).until(lambda driver: driver.execute_script(found))
    assert complaints(browser) == []
