"""What stands at the repository's root for those who cite or check it, and the pages that are made of the ledger."""

from __future__ import annotations

import datetime
import json
import re
import tomllib
from pathlib import Path

import pytest
import yaml
from lazily import lazily

article = lazily("derivations.ledger.article")
codecheck = lazily("derivations.codecheck")
protocol = lazily("derivations.ledger.protocol")

ROOT = Path(__file__).parents[2]
# required and allowed by the schema of the Citation File Format 1.2.0
REQUIRED = {"cff-version", "message", "title", "authors"}
ALLOWED = REQUIRED | {
    "abstract",
    "commit",
    "contact",
    "date-released",
    "doi",
    "identifiers",
    "keywords",
    "license",
    "license-url",
    "preferred-citation",
    "references",
    "repository",
    "repository-artifact",
    "repository-code",
    "type",
    "url",
    "version",
}


@pytest.fixture(scope="module")
def project():
    return tomllib.loads((ROOT / "pyproject.toml").read_text("utf-8"))["project"]


@pytest.fixture(scope="module")
def records():
    return json.loads((ROOT / "generated" / "ledger.json").read_text("utf-8"))


def test_the_citation_file_is_one(project):
    found = yaml.safe_load((ROOT / "CITATION.cff").read_text("utf-8"))
    assert found.keys() >= REQUIRED
    assert found.keys() <= ALLOWED
    assert (found["cff-version"], found["type"]) == ("1.2.0", "software")
    assert (str(found["version"]), found["license"]) == (project["version"], project["license"])
    assert all(author.keys() & {"name", "family-names"} for author in found["authors"])
    datetime.date.fromisoformat(found["date-released"])


def test_codemeta_says_the_same(project):
    found = json.loads((ROOT / "codemeta.json").read_text("utf-8"))
    cited = yaml.safe_load((ROOT / "CITATION.cff").read_text("utf-8"))
    assert found["@type"] == "SoftwareSourceCode"
    assert found["version"] == project["version"]
    assert found["license"].endswith(project["license"])
    assert [author["name"] for author in found["author"]] == [author["name"] for author in cited["authors"]]
    assert found["keywords"] == cited["keywords"]
    assert found["softwareRequirements"] == [re.match(r"[\w-]+", d)[0] for d in project["dependencies"]]


def test_the_manifest_lists_files_that_are_kept_and_made():
    found = yaml.safe_load((ROOT / "codecheck.yml").read_text("utf-8"))
    files = [item["file"] for item in found["manifest"]]
    assert files == codecheck.listed()
    assert all((ROOT / name).is_file() for name in files)
    assert all(item["comment"] for item in found["manifest"])
    assert (ROOT / found["paper"]["reference"]).read_text("utf-8").startswith(f"# {found['paper']['title']}")


def test_the_manifests_files_are_made_and_compared(tmp_path, monkeypatch, capsys):
    made = {name: (ROOT / name).read_text("utf-8") for name in codecheck.listed()}
    monkeypatch.setattr("derivations.codecheck._made", lambda: made)
    assert codecheck.command(str(tmp_path / "out")) == 0
    assert (tmp_path / "out" / "docs" / "referee.md").read_text("utf-8") == made["docs/referee.md"]
    made["docs/referee.md"] += "another word"
    del made["docs/article.md"]
    assert codecheck.command(str(tmp_path / "out")) == 1
    said = capsys.readouterr().out
    assert "docs/referee.md: DIFFERS" in said
    assert "docs/article.md: made by nothing" in said
    (tmp_path / "file").write_text("", "utf-8")
    assert codecheck.command(str(tmp_path / "file")) == 2


def test_the_article_and_the_referees_page_are_what_the_ledger_gives(records):
    assert (ROOT / "docs" / "article.md").read_text("utf-8") == article.page(records)
    assert (ROOT / "docs" / "referee.md").read_text("utf-8") == protocol.page(records)


def test_the_type_of_replication_is_said():
    for page in ("article.md", "referee.md"):
        assert article.REPLICATION in (ROOT / "docs" / page).read_text("utf-8")


def test_another_verdict_is_another_article(records):
    changed = [{**r, "verdict": "verified", "severity": None} if r["id"] == "6" else r for r in records]
    assert article.page(changed) != article.page(records)
    assert protocol.page(changed) != protocol.page(records)


def test_premises_rest_on_entries(records):
    names = {r["id"] for r in records}
    assert {name for _, entries, _ in protocol.PREMISES for name in entries} <= names
