"""What a command loads: the first keystroke waits for it."""

from __future__ import annotations

import os
import subprocess
import sys

import pytest

from trum_sym import console

# What starts the process: of no command
_OURS = ("_editable", "_distutils_hack", "__main__", "__mp_main__", "sitecustomize", "usercustomize")
_DEAR = {"asyncio", "concurrent.futures", "difflib", "json", "logging", "numpy.ma", "subprocess", "unittest"}

HELP = {"console", "console.say", "console.streams", "text"}
EVALUATE = HELP | {
    "console.evaluate",
    "console.options",
    "console.words",
    "errors",
    "inputs",
    *(f"inputs.{name}" for name in ("carried", "checks", "choices", "csv_text", "distributions", "domain", "drive")),
    *(f"inputs.{name}" for name in ("motor", "motor_file", "plausible", "points", "reading", "shown", "units")),
    "_kernels",
    "model",
    *(f"model.{name}" for name in ("batch", "brush", "cycle", "inputs", "kernels", "levels", "operating_point")),
    *(f"model.{name}" for name in ("rotor", "stator", "string", "tables")),
    "output",
    *(f"output.{name}" for name in ("digits", "json_text", "progress", "result", "text_table")),
    "quantities",
    "values",
}


def loaded_by(*arguments):
    """Names of the modules that a command leaves loaded in a process of its own."""
    code = (
        "import sys; from trum_sym.console import main; main(sys.argv[1:]);"
        "sys.stderr.write('\\n'.join(['', *sys.modules]))"
    )
    done = subprocess.run([sys.executable, "-c", code, *arguments], capture_output=True, text=True, check=True)
    return set(done.stderr.split())


def foreign(modules):
    """Packages that are neither Python's own nor this one."""
    packages = {name.partition(".")[0] for name in modules}
    return {p for p in packages - set(sys.stdlib_module_names) - {"trum_sym"} if not p.startswith(_OURS)}


def own(modules):
    return {name.partition(".")[2] for name in modules if name.startswith("trum_sym.")}


def test_the_help_loads_no_command_and_no_numpy():
    modules = loaded_by("--help")
    assert own(modules) == HELP
    assert foreign(modules) == {"click", "lazy_loader"}


def test_evaluate_loads_what_a_point_needs_and_no_more():
    modules = loaded_by("evaluate")
    assert own(modules) == EVALUATE
    assert foreign(modules) == {"click", "lazy_loader", "numpy"}
    assert not modules & _DEAR


def test_evaluate_with_json_needs_no_tables():
    modules = loaded_by("evaluate", "--json")
    assert own(modules) == EVALUATE
    assert foreign(modules) == {"click", "lazy_loader", "numpy"}


@pytest.mark.parametrize("name", console._SUMMARIES)
def test_the_list_of_commands_says_what_their_own_help_begins_with(name):
    command = console._cli.commands[name]
    assert console._SUMMARIES[name] == command.get_short_help_str(1000)


def test_the_process_starts_no_threads_for_matrices():
    """Where nobody says otherwise: OpenBLAS starts one a core, which takes longer than all of evaluate's matrices."""
    code = (
        "import os, runpy, sys; sys.argv = ['trum-sym', '--version']\n"
        "os._exit = lambda _: print(os.environ['OPENBLAS_NUM_THREADS'])\n"
        "runpy.run_module('trum_sym', run_name='__main__')"
    )
    for given, found in ((None, "1"), ("2", "2")):
        surroundings = {name: value for name, value in os.environ.items() if name != "OPENBLAS_NUM_THREADS"}
        surroundings |= {} if given is None else {"OPENBLAS_NUM_THREADS": given}
        done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, env=surroundings)
        assert done.stdout.split()[-1] == found
