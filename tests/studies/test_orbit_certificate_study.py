"""The study of certificates: what it prints, that it takes up where its file ends, that it notices what is wrong."""

from __future__ import annotations

import json


def test_a_run_takes_up_where_its_file_ends_and_fails_on_what_is_wrong(tmp_path, monkeypatch, capsys):
    from studies import orbit_certificate

    main = orbit_certificate.main
    file = tmp_path / "points.jsonl"
    assert main(["2", str(file)]) == 0
    first = capsys.readouterr().out
    assert first.startswith("2 pulsed points, laps close at 1, of which certified: 1\n")
    assert "led back to it: 4" in first
    monkeypatch.setattr(orbit_certificate, "checked", None)  # nothing is computed again
    assert main(["2", str(file)]) == 0
    assert capsys.readouterr().out == first
    records = [json.loads(line) for line in file.read_text().splitlines()]
    for wrong in ({"state": 1.1}, {"back": 3}, {"discs": 1.5}, {"closed": False}):
        file.write_text("\n".join(json.dumps(record) for record in (records[0] | wrong, records[1])))
        assert main(["2", str(file)]) == 1, wrong


def test_it_says_what_it_takes(capsys):
    from studies.orbit_certificate import main

    assert main(["folds"]) == 2
    assert "or fold" in capsys.readouterr().err
