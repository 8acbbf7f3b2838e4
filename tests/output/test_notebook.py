"""What a notebook shows of motors, drives and answers: tables, in which nothing of a file's text is markup."""

from __future__ import annotations

from dataclasses import replace
from html.parser import HTMLParser

import pytest

import trum_sym as ts


class Table(HTMLParser):
    """The cells of a page, and its elements."""

    def __init__(self, text):
        super().__init__()
        self.elements, self.cells = [], []
        self.feed(text)

    def handle_starttag(self, tag, _):
        self.elements.append(tag)
        if tag in ("td", "th"):
            self.cells.append("")

    def handle_data(self, data):
        if self.cells:
            self.cells[-1] += data


def test_a_motor_is_a_table_of_its_parameters(trum60):
    shown = Table(trum60._repr_html_())
    assert shown.cells[0].strip() == "TRUM-60"
    assert shown.elements.count("tr") == 1 + sum(1 for _ in trum60.parameters())
    place = [cell.strip() for cell in shown.cells].index("friction_coefficient")
    assert [cell.strip() for cell in shown.cells[place + 1 : place + 6]] == ["mu", "0.25", "1", "assumed", "0.2 to 0.3"]


def test_a_drive_is_a_table_with_units():
    cells = [cell.strip() for cell in Table(ts.Drive(prepressure=[1.0, 2.0])._repr_html_()).cells]
    assert cells[:6] == ["drive", "value", "unit", "prepressure", "[1. 2.]", "N"]


@pytest.mark.parametrize("kind", ["parameter", "distribution", "inputs", "point"])
def test_other_values_and_answers_show_themselves(trum60, kind):
    point = ts.evaluate(trum60)
    shown = {
        "parameter": trum60.radius,
        "distribution": ts.Distribution("uniform", 0.0, 1.0),
        "inputs": point.inputs,
        "point": point,
    }[kind]._repr_html_()
    assert Table(shown).elements[0] in ("table", "pre")


def test_a_name_from_a_file_is_no_markup(trum60):
    motor = replace(trum60, name="<script>alert(1)</script>\x1b[2J")
    shown = motor._repr_html_()
    assert "script" not in Table(shown).elements
    assert "\x1b" not in shown
    assert "script" not in Table(ts.evaluate(motor)._repr_html_()).elements
