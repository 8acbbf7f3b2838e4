"""A sample of ``python -m studies.c_matrix``: one compiler, two standards, threads; and that it notices faults."""

from __future__ import annotations

from c_coverage import ROOT

from studies.c_matrix import EXCEPTIONS, THREADS, excused, found, threads, warnings


def test_there_is_no_warning_without_a_named_reason():
    wrong, met = warnings(["gcc"], ["c99"], ["c++11"])
    assert wrong == []
    assert all(line.partition(": ")[2] in {reason for *_, reason in EXCEPTIONS} for line in met)


def test_a_warning_is_read_and_counts_unless_it_is_named():
    said = f"{ROOT}/trum_sym/_driver/trum_cycle.h:7:3: warning: declaration of 'x' shadows a local [-Wshadow]\n  x;\n"
    assert found(said) == [("trum_sym/_driver/trum_cycle.h", "-Wshadow", "declaration of 'x' shadows a local")]
    assert excused("trum_sym/_driver/trum_cycle.h", "-Wshadow") is None
    assert excused("trum_sym/_driver/orbit/balance.h", "-Wdeprecated-enum-float-conversion")
    assert excused("generated/trum_wave.c", "-Wconversion") is None


def test_four_threads_do_not_meet():
    assert threads() == []


def test_a_race_would_be_found():
    racing = THREADS.replace("static void* work", "static int seen;\nstatic void* work")
    assert threads(racing.replace("for (k = 0; k < POINTS; ++k) {", "for (k = 0; k < 1; ++k) {\n    ++seen;")) != []
