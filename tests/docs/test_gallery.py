"""The gallery runs, prints figures that hold, and the pictures on a page are what it draws."""

from __future__ import annotations

import base64
import io
import re
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from lazily import lazily

import trum_sym as ts

ROOT = Path(__file__).parents[2]
PICTURES = {
    "evaluate": "pulses",
    "starts": "starts",
    "torque_speed": "torque-speed",
    "load_region": "load-region",
    "optimize": "optimum",
    "own_motor": "own-motor",
}
ON_A_PAGE = ("evaluate", "starts", "torque_speed", "load_region")
image = lazily("matplotlib.image")
NUMBER = re.compile(r"-?\d+\.?\d*(?:e-?\d+)?")


@pytest.fixture(scope="module")
def drawn(tmp_path_factory):
    """What each script prints and draws."""
    folder = tmp_path_factory.mktemp("gallery")
    printed = {}
    for name in PICTURES:
        done = subprocess.run(
            [sys.executable, ROOT / "examples" / f"gallery_{name}.py", folder],
            capture_output=True,
            text=True,
            encoding="utf-8",
            check=True,
        )
        printed[name] = done.stdout
        assert (folder / f"{PICTURES[name]}.svg").stat().st_size < 400_000
    return printed, folder


def images(text):
    """The text without its embedded images, and these."""
    found = re.findall(r"data:image/png;base64,([^\"]+)", text)
    pixels = [image.imread(io.BytesIO(base64.b64decode(data))) for data in found]
    drawing = re.sub(r"data:image/png;base64,[^\"]+", "", text)
    return re.sub(r'(id="|#)[^")]+', r"\1", drawing), pixels  # ids are hashes of what they name


def differ(ours, stored):
    """Why two pictures are not the same but for rounding; nothing if they are."""
    (text, pixels), (old, old_pixels) = images(ours), images(stored)
    if NUMBER.sub("#", text) != NUMBER.sub("#", old):
        return "another drawing"
    numbers, olds = (np.array(NUMBER.findall(part), float) for part in (text, old))
    if not np.allclose(numbers, olds, rtol=0, atol=0.02):
        return f"numbers differ by up to {np.max(np.abs(numbers - olds))}"
    if any(a.shape != b.shape or np.mean(np.abs(a - b)) > 2e-3 for a, b in zip(pixels, old_pixels, strict=True)):
        return "another image"
    return ""


@pytest.mark.parametrize("name", ON_A_PAGE)
def test_the_stored_picture_is_what_the_script_draws(drawn, name):
    file = f"{PICTURES[name]}.svg"
    stored = (ROOT / "docs" / "pictures" / file).read_text("utf-8")
    found = differ((drawn[1] / file).read_text("utf-8"), stored)
    assert not found, f"{file}: {found}; run python examples/gallery_{name}.py docs/pictures"


def test_the_page_on_claims_has_what_the_region_s_script_prints(drawn):
    text = (ROOT / "docs" / "claims.md").read_text("utf-8")
    block = text.split("<!-- examples/gallery_load_region.py -->\n```\n")[1].split("```")[0]
    assert NUMBER.sub("#", block) == NUMBER.sub("#", drawn[0]["load_region"])
    numbers = [np.array(NUMBER.findall(part), float) for part in (block, drawn[0]["load_region"])]
    assert numbers[0] == pytest.approx(numbers[1], rel=0.02, abs=5e-4)  # a bound of 0.005 % hangs on the steps taken


def test_every_stored_picture_is_on_a_page():
    text = "".join(page.read_text("utf-8") for page in (ROOT / "README.md", *(ROOT / "docs").glob("*.md")))
    stored = [path for kind in ("svg", "png") for path in (ROOT / "docs").rglob(f"*.{kind}")]
    shown = re.findall(r"!\[[^]]+\]\((?:docs/)?([^)]+)\)", text)
    assert {path.relative_to(ROOT / "docs").as_posix() for path in stored} == set(shown)


def test_a_stale_picture_is_noticed(drawn):
    text = (drawn[1] / "pulses.svg").read_text("utf-8")
    path = text.index(' d="M ') + len(' d="M ')
    moved = text[:path] + re.sub(r"^\S+", "1.0", text[path:], count=1)
    assert "numbers differ" in differ(moved, text)
    assert differ(text.replace("w_A (µm)", "w_A (mm)"), text) == "another drawing"
    map_text = (drawn[1] / "optimum.svg").read_text("utf-8")
    first = re.search(r"base64,([^\"]+)", map_text)[1]
    pixels = image.imread(io.BytesIO(base64.b64decode(first)))
    buffer = io.BytesIO()
    image.imsave(buffer, pixels[::-1], format="png")
    turned = map_text.replace(first, base64.b64encode(buffer.getvalue()).decode(), 1)
    assert differ(turned, map_text) == "another image"


def test_the_printed_figures_are_those_of_the_motor(drawn):
    motor, text = ts.load_motor("trum60"), drawn[0]
    point = ts.evaluate(motor, ts.Drive(load_torque=0.1))
    assert f"{point.q_average:10.1f} 1/s" in text["evaluate"]
    assert [line.split()[0] for line in text["starts"].splitlines()[1:]] == ["periodic", "steady", "rest"]
    assert "soft layer" in text["own_motor"]
    assert float(re.search(r"soft layer .* contact (\S+)", text["own_motor"])[1]) > float(
        re.search(r"TRUM-60 .* contact (\S+)", text["own_motor"])[1]
    )  # a softer layer is pressed in further


def test_the_optimum_creeps_at_the_speed_asked_for(drawn):
    found = re.search(r"([\d.]+) N, ([\d.]+) Hz", drawn[0]["optimize"])
    drive = ts.Drive(prepressure=float(found[1]), frequency_difference=float(found[2]))
    point = ts.evaluate(ts.load_motor("trum60"), drive, tolerance=1e-9)
    swing = point.max_speed - point.min_speed
    assert abs(point.mean_speed - 633 * np.pi / 648000) < 1e-4 * swing  # the place is printed to 0.01 N and Hz
    assert "v_s 633.0 arcsec/s" in drawn[0]["optimize"]
