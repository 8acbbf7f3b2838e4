"""``trum-sym``: the console.  One module a command, which is loaded when it is asked for; heavy imports wait until it
runs.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from importlib import import_module
from typing import Any

import click

from trum_sym.console.say import say
from trum_sym.console.streams import spelling_streams
from trum_sym.text import one_line

__all__ = ["main", "outcome"]


# What each is for, as its own --help begins: the list of commands does not load them
_SUMMARIES = {
    "evaluate": "One operating point; with no options, TRUM-60 at the paper's Table 3.",
    "sensitivities": "How the figures of one operating point change with what it depends on.",
    "simulate": "Time histories of one operating point on its periodic orbit.",
    "drive": "Any drive of both phases with the rotor's reaction on the wave: pulses, bursts, a phase difference, one "
    "phase.",
    "characteristics": "Speed, power and contact efficiency under load, speed by frequency and prepressure, stall by "
    "prepressure.",
    "admittance": "Admittance of a phase over frequency, without a rotor and under one, and its circuit.",
    "sweep": "Operating points on a grid: every number may be a range, in --set too.",
    "spread": "How uncertain parameters spread an operating point's figures, and which to measure first.",
    "optimize": "The operating point of least objective in a box of prepressure and frequency difference, under "
    "constraints.",
    "pareto": "Operating points that cannot be bettered in one figure without losing in another.",
    "robust": "The operating point whose worst case over spreads, or over samples, is the best.",
    "speed-table": "The drive for every mean speed of a range, for a controller to interpolate.",
    "track": "A speed in closed loop: an encoder's counts, a speed table, a PI controller of the frequency, and what "
    "drifts.",
    "calibrate": "Fit uncertain parameters of the motor to measured data.",
    "c-library": "Write the C library for a controller: sources, the motor's numbers, an example, Makefile and CMake "
    "file.",
    "fmu": "Write the motor as a co-simulation unit of FMI, with its C source and compiled for this machine.",
    "motor": "Motor files: a template to begin with, checks, lists, differences.",
    "equations": "The ledger: what the paper printed, what follows from first principles, the verdict and its effect.",
    "report": "The paper's figures, tables and claims, redrawn and judged: DIR/index.html, which needs no network.",
    "info": "Versions, instruction set and levels of the model: what a report of a fault should begin with.",
}


class _Commands(Mapping[str, click.Command]):
    """The commands by name, each with its module loaded on first use."""

    def __getitem__(self, name: str) -> click.Command:
        if name not in _SUMMARIES:
            raise KeyError(name)
        word = name.replace("-", "_")
        command: click.Command = getattr(import_module(f"trum_sym.console.{word}"), word)
        return command

    def __iter__(self) -> Iterator[str]:
        return iter(_SUMMARIES)

    def __len__(self) -> int:
        return len(_SUMMARIES)


class _Group(click.Group):
    """A group that ends without click's blank line where it is interrupted, and words errors for the console."""

    def format_commands(self, ctx: click.Context, formatter: click.HelpFormatter) -> None:  # noqa: ARG002
        """The list of commands, none of which is loaded."""
        limit = formatter.width - 6 - max(map(len, _SUMMARIES))
        rows = [(n, click.Command(n, help=text).get_short_help_str(limit)) for n, text in sorted(_SUMMARIES.items())]
        with formatter.section("Commands"):
            formatter.write_dl(rows)

    def invoke(self, ctx: click.Context) -> Any:  # noqa: ANN401
        """Run the command."""
        from trum_sym.errors import ParameterError

        try:
            return super().invoke(ctx)
        except KeyboardInterrupt:
            raise click.Abort from None
        except ParameterError as error:
            command = self.commands.get(ctx.invoked_subcommand or "")
            if command is None:
                raise
            from trum_sym.console.words import in_console_words

            raise in_console_words(error, command, ctx.meta) from None


@click.group(
    cls=_Group,
    commands=_Commands(),
    context_settings={"help_option_names": ["-h", "--help"], "max_content_width": 110},
)
@click.version_option(package_name="trum-sym")
def _cli() -> None:
    """Travelling-wave ultrasonic motors at very low speed (superimposed pulse driving).

    Exit codes: 0 done; 1 the work was done and its answer is no; 2 bad input, or no room for the result.
    """


_REFUSALS = {
    "can't start new thread": "the system refuses a new thread",
    "Plugin 'ipopt' is not found": "CasADi cannot load its solver IPOPT",
}


def main(arguments: list[str] | None = None) -> int:
    """Run the console; returns the exit code and never lets a traceback through for bad input or surroundings."""
    with spelling_streams():
        code, message = outcome(arguments)
        if message is not None:
            say(f"trum-sym: {message}", err=True)
    return code


def outcome(arguments: list[str] | None = None) -> tuple[int, str | None]:
    """Run the console; returns the exit code, and on one line why it is not 0 where that is not printed yet."""
    import warnings

    shown = set()

    def show(message: Warning | str, *_: object, **__: object) -> None:
        text = one_line(str(message))
        if text not in shown:
            shown.add(text)
            say(f"trum-sym: warning: {text}", err=True)

    with spelling_streams(), warnings.catch_warnings():
        warnings.simplefilter("always")
        warnings.showwarning = show
        try:
            result = _cli.main(args=arguments, prog_name="trum-sym", standalone_mode=False)
        except click.exceptions.NoArgsIsHelpError as help_shown:
            say(help_shown.format_message())
            return 2, None
        except click.ClickException as error:
            return 2, one_line(error.format_message())
        except click.Abort:
            return 130, "interrupted"
        except SystemExit:  # click's, where the pipe that it prints to is closed
            return 141, None
        except (ValueError, ImportError, RuntimeError, OSError, MemoryError, SystemError) as error:
            code, message = _of_surroundings(error)
            return code, one_line(message)
    return result if isinstance(result, int) else 0, None


def _of_surroundings(error: Exception) -> tuple[int, str]:
    """Exit code and message of what is no fault of this program; raises the rest."""
    from trum_sym.errors import ConvergenceError, MissingExtraError, ParameterError, UnfinishedError

    if isinstance(error, ConvergenceError | UnfinishedError):
        return 1, str(error)
    if isinstance(error, ParameterError | MissingExtraError):
        return 2, str(error)
    if isinstance(error, MemoryError | SystemError) or "not enough memory" in str(error):
        return 2, f"not enough memory, or a library's fault ({type(error).__name__}: {error})"
    if isinstance(error, OSError):
        where = f" {error.filename}" if error.filename is not None else ""
        return 2, f"the system refuses{where}: {error.strerror or error}"
    if isinstance(error, ImportError):
        return 2, f"a module cannot be loaded: {error}"
    if isinstance(error, UnicodeEncodeError) or "embedded null" in str(error):
        return 2, f"a path that the system does not take: {error}"
    for words, meaning in _REFUSALS.items():
        if words in str(error):
            return 2, meaning
    raise error
