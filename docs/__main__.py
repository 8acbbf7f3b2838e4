"""``python -m docs``: the documentation site, with warnings as errors and every internal link followed.

The sources are the pages in ``docs/``; ``docs/site/`` adds what is made of other sources: the ledger's entries, the
kernels, the C header, the console's help, the records of ``--json``.  Pages and pictures are put together in
``build/site/source``, the site is ``build/site/html``.
"""

from __future__ import annotations

import argparse
import shutil
import sys
import time
from pathlib import Path

from docs.site import links, staging

ROOT = Path(__file__).parents[1]


def main(arguments: list[str] | None = None) -> int:
    """Build the site; 0 if it has no warning, no broken link, and loads nothing from a network."""
    parser = argparse.ArgumentParser("python -m docs", description="Build the documentation site.")
    parser.add_argument("--out", type=Path, default=ROOT / "build" / "site", help="folder of the site's files")
    out = parser.parse_args(arguments).out.resolve()
    begin = time.perf_counter()
    try:
        from sphinx.cmd.build import main as sphinx
    except ImportError as error:
        print(f"the site needs {error.name}: pip install -e '.[docs]'", file=sys.stderr)
        return 2
    staging.stage(ROOT, out / "source")
    for folder in ("doctrees", "html"):
        shutil.rmtree(out / folder, ignore_errors=True)
    options = ["-b", "html", "-W", "--keep-going", "-n", "-q", "-j", "auto", "-c", str(ROOT / "docs" / "site")]
    failed = sphinx([*options, "-d", str(out / "doctrees"), str(out / "source"), str(out / "html")])
    wrong = links.check(out / "html")
    print("\n".join(wrong), file=sys.stderr, end="\n" * bool(wrong))
    pages = len(list((out / "html").rglob("*.html")))
    took = time.perf_counter() - begin
    print(f"{pages} pages in {took:.0f} s, {len(wrong)} links and sources wrong: {out / 'html' / 'index.html'}")
    return 1 if failed or wrong else 0


if __name__ == "__main__":
    sys.exit(main())
