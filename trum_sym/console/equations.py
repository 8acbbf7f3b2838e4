"""``trum-sym equations``."""

from __future__ import annotations

import click

from trum_sym.console.options import examples
from trum_sym.console.say import say

__all__ = ["equations"]


@click.command(
    epilog=examples(
        "trum-sym equations --verdict erratum",
        "trum-sym equations --severity structural",
        "trum-sym equations --equation 24",
    )
)
@click.option("--equation", metavar="ID", help="The paper's number, such as 6 or A13: its derivation written out.")
@click.option("--verdict", metavar="NAME", help="Only entries of this verdict, such as erratum or verified.")
@click.option(
    "--severity", metavar="NAME", help="Only errata that are typographical, conditional, quantitative or structural."
)
@click.option("--open", "open_page", is_flag=True, help="Show the ledger's page, with typeset formulas, in a browser.")
@click.option("--json", "as_json", is_flag=True, help="The records instead of a table, formulas in LaTeX among them.")
def equations(equation: str | None, verdict: str | None, severity: str | None, open_page: bool, as_json: bool) -> None:
    """The ledger: what the paper printed, what follows from first principles, the verdict and its effect."""
    from trum_sym.paper.ledger import (
        counted,
        filtered,
        ledger_path,
        load_ledger,
        load_pictures,
        select,
        table,
        written_out,
    )

    if open_page:
        import webbrowser

        page = ledger_path()
        address = page.as_uri() + (f"#eq-{select(load_ledger(), equation)['id']}" if equation else "")
        say(address)
        webbrowser.open(address)
        return
    records = load_ledger()
    chosen = filtered(records, verdict=verdict, severity=severity) if equation is None else [select(records, equation)]
    if as_json:
        import json

        say(json.dumps(chosen, indent=1))
    elif equation is not None:
        say(written_out(chosen[0], load_pictures(chosen[0]["id"])))
    else:
        say(table(chosen))
        say(f"\n{counted(chosen)}")
