from __future__ import annotations

import signal
import sys

import pytest
from refusals import assert_one_clear_line

from trum_sym import console

LOADED = pytest.StashKey[set[str]]()


def pytest_configure():
    """Hear signals that nohup or ``&`` had ignored, so that commands which tests start hear them, too."""
    hangup = getattr(signal, "SIGHUP", signal.SIGINT)  # not on every system
    for number, heard in ((signal.SIGINT, signal.default_int_handler), (hangup, signal.SIG_DFL)):
        if signal.getsignal(number) is signal.SIG_IGN:
            signal.signal(number, heard)


def pytest_collection_finish(session):
    session.config.stash[LOADED] = set(sys.modules)


@pytest.fixture
def loaded_by_collecting(pytestconfig):
    """Names of the modules that were imported when the tests had been collected, before any of them ran."""
    return pytestconfig.stash[LOADED]


@pytest.fixture(scope="session")
def trum60():
    import trum_sym as ts

    return ts.load_motor("trum60")


@pytest.fixture
def console_refuses(capsys):
    def refuse(*arguments, naming):
        code = console.main(list(arguments))
        out, err = capsys.readouterr()
        doubts = [line for line in err.splitlines(keepends=True) if line.startswith("trum-sym: warning: ")]
        err = err.removeprefix("".join(doubts))  # of the motor's values come first, as load_motor gives them
        assert code == 2
        assert out == ""
        assert err.endswith("\n")
        assert err.startswith("trum-sym: ")
        assert not err.startswith("trum-sym: warning")
        assert_one_clear_line(err, *naming)
        return err

    return refuse


@pytest.fixture
def motor_file(tmp_path):
    def write(content):
        path = tmp_path / "motor.toml"
        path.write_bytes(content if isinstance(content, bytes) else content.encode())
        return path

    return write
