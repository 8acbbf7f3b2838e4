"""``trum-sym``: the console.  One module a command; heavy imports wait until it runs."""

from __future__ import annotations

import click

from trum_sym.console.calibrate import calibrate
from trum_sym.console.equations import equations
from trum_sym.console.evaluate import evaluate
from trum_sym.console.optimize import optimize
from trum_sym.console.pareto import pareto
from trum_sym.console.report import report
from trum_sym.console.robust import robust
from trum_sym.console.simulate import simulate
from trum_sym.console.speed_table import speed_table
from trum_sym.console.streams import spelling_streams
from trum_sym.console.sweep import sweep
from trum_sym.console.tolerance import tolerance

__all__ = ["main"]


@click.group(context_settings={"help_option_names": ["-h", "--help"], "max_content_width": 110})
@click.version_option(package_name="trum-sym")
def _cli() -> None:
    """Travelling-wave ultrasonic motors at very low speed (superimposed pulse driving).

    Exit codes: 0 done; 1 the work was done and its answer is no; 2 bad input.
    """


for _command in (
    evaluate,
    simulate,
    sweep,
    tolerance,
    optimize,
    pareto,
    robust,
    speed_table,
    calibrate,
    equations,
    report,
):
    _cli.add_command(_command)


def _one_line(message: str) -> str:
    return " ".join(message.split())


def main(arguments: list[str] | None = None) -> int:
    """Run the console; returns the exit code and never lets a traceback through for bad input."""
    import warnings

    shown = set()

    def show(message: Warning | str, *_: object, **__: object) -> None:
        text = _one_line(str(message))
        if text not in shown:
            shown.add(text)
            click.echo(f"trum-sym: warning: {text}", err=True)

    with spelling_streams(), warnings.catch_warnings():
        warnings.simplefilter("always")
        warnings.showwarning = show
        try:
            result = _cli.main(args=arguments, prog_name="trum-sym", standalone_mode=False)
        except click.exceptions.NoArgsIsHelpError as help_shown:
            click.echo(help_shown.format_message())
            return 2
        except click.ClickException as error:
            click.echo(f"trum-sym: {_one_line(error.format_message())}", err=True)
            return 2
        except click.Abort:
            click.echo("trum-sym: interrupted", err=True)
            return 130
        except ValueError as error:
            from trum_sym.errors import ParameterError

            if not isinstance(error, ParameterError):
                raise
            click.echo(f"trum-sym: {error}", err=True)
            return 2
        except ImportError as error:
            from trum_sym.errors import MissingExtraError

            if not isinstance(error, MissingExtraError):
                raise
            click.echo(f"trum-sym: {error}", err=True)
            return 2
        except RuntimeError as error:
            from trum_sym.errors import ConvergenceError, UnfinishedError

            if not isinstance(error, ConvergenceError | UnfinishedError):
                raise
            click.echo(f"trum-sym: {error}", err=True)
            return 1
    return result if isinstance(result, int) else 0
