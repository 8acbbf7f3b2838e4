"""The ledger as one page that needs no network: MathML, a filter, a search, an anchor per entry, pictures."""

from __future__ import annotations

import re
from collections.abc import Iterable
from html import escape
from typing import Any, Literal

from latex2mathml.converter import convert

from derivations.ledger.model import Entry
from derivations.ledger.pictures import svg
from derivations.nomenclature import CLASHES, NOMENCLATURE
from trum_sym.paper.ledger import SEVERITIES, VERDICTS, counted

__all__ = ["page"]


_STYLE = """
:root { color-scheme: light dark; --page: #fff; --ink: #1b1f24; --soft: #57606a; --line: #d0d7de; --wash: #f6f8fa;
  --link: #0969da; --bad: #b42318; }
@media (prefers-color-scheme: dark) { :root { --page: #14171b; --ink: #e4e8ec; --soft: #9aa5b1; --line: #39424c;
  --wash: #1d2228; --link: #6cb0ff; --bad: #ff8f85; } }
* { box-sizing: border-box; }
body { font: 16px/1.5 system-ui, sans-serif; color: var(--ink); background: var(--page); margin: 0 auto;
  max-width: 74rem; padding: 1rem; overflow-wrap: anywhere; }
a, summary { color: var(--link); } h2 a { text-decoration: none; }
header p { max-width: 48rem; } h1 { margin-bottom: .2rem; } h2 { margin: 0; font-size: 1.15rem; }
.bar { position: sticky; top: 0; background: var(--page); border-bottom: 1px solid var(--line); padding: .5rem 0;
  z-index: 1; display: flex; flex-wrap: wrap; gap: .25rem; align-items: center; }
.bar button, .bar input { font: inherit; font-size: .9rem; padding: .1rem .6rem; border: 1px solid var(--line);
  border-radius: 1rem; background: var(--page); color: var(--ink); }
.bar input { flex: 0 1 9rem; min-width: 5rem; }
.bar button[aria-pressed=true] { background: var(--ink); color: var(--page); }
article { border: 1px solid var(--line); border-radius: .5rem; margin: 1rem 0; padding: 1rem; scroll-margin-top: 8rem; }
article[hidden] { display: none; } .place { color: var(--soft); font-size: .9rem; }
.tag { border-radius: 1rem; padding: 0 .6rem; font-size: .85rem; margin-left: .5rem; white-space: nowrap; }
.tag, .index a { color: #fff; background: #57606a; }
.verified { background: #1a7f37 !important; } .erratum { background: #b42318 !important; }
.approximation { background: #8a5d00 !important; } .reconstructed { background: #0860ca !important; }
.empirical { background: #6639ba !important; }
.pair { display: grid; grid-template-columns: minmax(0, 1fr); gap: .5rem; margin: .6rem 0; }
.box { background: var(--wash); border-radius: .4rem; padding: .4rem .8rem; }
.box h3 { margin: 0 0 .3rem; font-size: .85rem; color: var(--soft); font-weight: 600; }
.formula { margin: .35rem 0; overflow-y: hidden; padding: .15rem 0; } math { font-size: 1.05rem; }
.box .formula { --page: var(--wash); }
/* a shadow where more is hidden, and words where the script runs */
.wide, .formula { overflow-x: auto; background: linear-gradient(90deg, var(--page) 40%, transparent) 0 / 3rem 100%,
  linear-gradient(270deg, var(--page) 40%, transparent) 100% / 3rem 100%,
  linear-gradient(90deg, var(--soft), transparent) 0 / .8rem 100%,
  linear-gradient(270deg, var(--soft), transparent) 100% / .8rem 100%; background-repeat: no-repeat;
  background-attachment: local, local, scroll, scroll; }
.scrolls::before { content: "\\2194  more to the side"; position: sticky; left: 0; display: block; width: max-content;
  font-size: .8rem; color: var(--soft); }
math[display=block] { width: max-content; min-width: 100%; }
details { margin: .4rem 0; } summary { cursor: pointer; } ol { padding-left: 1.8rem; } ol > li { margin: .5rem 0; }
li.against { color: var(--bad); } sub, sup { line-height: 0; font-size: .75em; }
figure { margin: .6rem 0; background: #fff; border-radius: .4rem; } svg { display: block; width: 100%; height: auto; }
table { border-collapse: collapse; }
td, th { border: 1px solid var(--line); padding: .15rem .5rem; text-align: left; vertical-align: top; }
.index { margin: .5rem 0; } .index a { display: inline-block; min-width: 2.2rem; text-align: center;
  border-radius: .3rem; margin: .1rem; text-decoration: none; padding: 0 .3rem; font-size: .85rem; }
@media (max-width: 40rem) { body { padding: .5rem; } article { padding: .7rem; } .bar { position: static; }
  figure svg { min-width: 38rem; } }
"""

_SCRIPT = """
const entries = [...document.querySelectorAll('article')], box = document.querySelector('#search');
const buttons = [...document.querySelectorAll('.bar button')], shown = document.querySelector('#shown');
let chosen = 'all';
function refresh() {
  const words = box.value.toLowerCase().split(/\\s+/).filter(Boolean);
  let count = 0;
  for (const e of entries) {
    const text = e.dataset.words;
    const kinds = [e.dataset.verdict, e.dataset.severity, e.dataset.copy];
    e.hidden = !((chosen === 'all' || kinds.includes(chosen)) && words.every(w => text.includes(w)));
    count += !e.hidden;
  }
  shown.textContent = count + ' of ' + entries.length;
}
for (const b of buttons) b.addEventListener('click', () => {
  chosen = b.dataset.kind;
  for (const other of buttons) other.setAttribute('aria-pressed', other === b);
  refresh();
});
box.addEventListener('input', refresh);
function reveal() {
  const id = decodeURIComponent(location.hash.slice(1));
  const target = id && document.getElementById(id);
  if (target && target.hidden) { box.value = ''; buttons[0].click(); target.scrollIntoView(); }
}
window.addEventListener('hashchange', reveal);
const wide = [...document.querySelectorAll('.wide')];
function hint() { for (const b of wide) b.classList.toggle('scrolls', b.scrollWidth > b.clientWidth + 1); }
window.addEventListener('resize', hint);
document.addEventListener('toggle', hint, true);
refresh(); reveal(); hint();
"""


_GREEK = {
    "alpha": "α",
    "beta": "β",
    "delta": "δ",
    "Delta": "Δ",
    "epsilon": "ε",
    "zeta": "ζ",
    "theta": "θ",
    "Theta": "Θ",
    "kappa": "κ",
    "lambda": "λ",
    "mu": "μ",
    "xi": "ξ",
    "pi": "π",
    "rho": "ρ",
    "sigma": "σ",
    "tau": "τ",
    "phi": "φ",
    "varphi": "φ",
    "psi": "ψ",
    "Psi": "Ψ",
    "omega": "ω",
}
_SYMBOL = re.compile(rf"\b(?:({'|'.join(_GREEK)}|[A-Za-z])((?:_[A-Za-z0-9]+)+)|({'|'.join(_GREEK)}))(?![A-Za-z])")


def _symbol(found: re.Match[str]) -> str:
    letter, index = found[1] or found[3], (found[2] or "").lstrip("_")
    if index.startswith("omega"):  # Delta_omega, Delta_omega_add
        letter, index = "Δω", index.removeprefix("omega").lstrip("_")
    return f"<i>{_GREEK.get(letter, letter)}</i>" + (f"<sub>{index.replace('_', ' ')}</sub>" if index else "")


def _prose(text: str) -> str:
    """A sentence with its symbols set as such: omega_n, W_maxf, xi^2."""
    marked = _SYMBOL.sub(_symbol, escape(text))
    return re.sub(r"\^(-?\d+)", r"<sup>\1</sup>", marked)


def _mathml(formula: str, display: Literal["block", "inline"] = "inline") -> str:
    """A formula as MathML, indices of several letters upright."""
    return str(convert(re.sub(r"_\{([A-Za-z]{2,}\d?)\}", r"_{\\mathrm{\1}}", formula), display=display))


def _math(formula: str) -> str:
    return f'<div class="formula">{_mathml(formula, "block")}</div>'


def _formulas(title: str, formulas: Iterable[str] | None) -> str:
    body = "".join(_math(f) for f in formulas or ()) or "<p>missing from the paper</p>"
    return f'<div class="box"><h3>{escape(title)}</h3>{body}</div>'


def _steps(steps: list[dict[str, Any]]) -> str:
    marks = {None: "", True: " ✓", False: " ✗"}
    items = [f"<li>{_prose(s['text'])}{marks[s['holds']]}{''.join(_math(f) for f in s['latex'])}</li>" for s in steps]
    return f"<ol>{''.join(items)}</ol>"


def _evidence(found: list[dict[str, Any]]) -> str:
    rows = [
        f'<li class="{"for" if e["ok"] else "against"}">{"✓" if e["ok"] else "✗"} {escape(e["about"])}, '
        f"<b>{escape(e['kind'].replace('_', ' '))}</b>: {_prose(e['detail'])}</li>"
        for e in found
    ]
    return f"<ul>{''.join(rows)}</ul>"


def anchor(name: str) -> str:
    """The id of an entry's article: eq-6, eq-A13, or the word itself."""
    return f"eq-{name}" if name.removeprefix("A").isdigit() else name


def _label(name: str) -> str:
    return f"({name})" if name.removeprefix("A").isdigit() else name


def _computed_with(conditions: dict[str, str] | None) -> str:
    if not conditions:
        return ""
    listed = "; ".join(f"{key.replace('_', ' ')} {value}" for key, value in conditions.items())
    return f'<p class="place">Computed with {_prose(listed)}.</p>'


def _tags(r: dict[str, Any]) -> str:
    """How bad, and whether the copy of the text is doubtful."""
    words = [r["severity"]] + (["doubtful copy"] if r["copy"] == "doubtful" else [])
    return "".join(f'<span class="tag">{escape(word)}</span>' for word in words if word)


def _sureness(r: dict[str, Any]) -> str:
    """Severity and sureness in sentences, with both outcomes where the verdict hangs on a doubtful sign."""
    said = []
    if r["severity"]:
        said.append(f"<p><b>Severity.</b> {escape(r['severity'].capitalize())}: {_prose(r['severity_detail'])}.</p>")
    elif r["conditional"]:
        said.append("<p><b>Conditional.</b> Judged against the reconstruction of the supplement that is missing.</p>")
    if r["copy"] == "doubtful":
        items = [
            f"<li>{_prose(o['what'])}: <b>{escape(o['verdict'])}</b>; {_prose(o['detail'])}</li>"
            for o in r["other_readings"]
        ]
        outcome = f"<ul>{''.join(items)}</ul>" if items else " The verdict does not hang on it."
        said.append(f"<div><b>Copy.</b> What it may have lost: {_prose(r['copy_doubt'])}.{outcome}</div>")
    return "".join(said)


def _confirmed_by(r: dict[str, Any]) -> str:
    """By which algebra systems a verdict is confirmed, by which means, and what the second one found."""
    second = r["second_opinion"]
    systems = f"<b>Confirmed by:</b> {escape(', '.join(second['confirmed_by']) if r['confirmed'] else 'nobody')}"
    if second["undecided"]:
        return f'<p class="place">{systems} ({escape(second["undecided"])}).</p>'
    means = (
        f' <span class="place">(Maxima by {escape("; ".join(second["methods"]))})</span>' if second["methods"] else ""
    )
    return f"<p>{systems}{means}.</p>"


def _second(r: dict[str, Any]) -> str:
    """What Maxima found, as a list like the evidence."""
    words = {"printed": "printed", "standing": "reconstructed" if r["verdict"] == "reconstructed" else "put right"}
    found = [
        {"ok": f["ok"], "about": words[part], "kind": "Maxima", "detail": f"{f['detail']} ({f['method']})"}
        for part, findings in r["second_opinion"]["findings"].items()
        for f in findings
    ]
    return f"<details><summary>Second opinion</summary>{_evidence(found)}</details>" if found else ""


def _article(r: dict[str, Any], picture: str) -> str:
    said = (
        r["id"],
        _label(r["id"]),
        r["title"],
        r["reason"],
        r["effect"],
        r["place"],
        r["verdict"],
        r["severity"] or "",
    )
    words = " ".join(said).lower()
    corrected = {"erratum": "put right", "reconstructed": "reconstructed"}.get(r["verdict"], "derived")
    found_by = f"<p>Found by: {escape(', '.join(r['found_by']).replace('_', ' '))}.</p>" if r["found_by"] else ""
    figure = f'<figure><div class="wide">{picture}</div></figure>' if picture else ""
    return (
        f'<article id="{escape(anchor(r["id"]))}" data-verdict="{r["verdict"]}" data-severity="{r["severity"] or ""}" '
        f'data-copy="{r["copy"]}" data-words="{escape(words)}">'
        f'<h2><a href="#{escape(anchor(r["id"]))}">{escape(_label(r["id"]))}</a> {_prose(r["title"])}'
        f'<span class="tag {r["verdict"]}">{r["verdict"]}</span>{_tags(r)}</h2>'
        f'<p class="place">{escape(r["place"])}</p><p>{_prose(r["reason"])}</p>{found_by}{_confirmed_by(r)}'
        f'<div class="pair">{_formulas("printed", r["printed_latex"])}'
        f"{_formulas(corrected, r['derived_latex'])}</div>"
        f"{_sureness(r)}<p><b>Effect.</b> {_prose(r['effect'])}</p>{_computed_with(r['effect_at'])}{figure}"
        f"<details open><summary>Derivation</summary>{_steps(r['steps'])}</details>"
        f"<details><summary>Evidence</summary>{_evidence(r['evidence'])}</details>{_second(r)}</article>"
    )


def _nomenclature() -> str:
    rows = [
        f"<tr><td>{_mathml(e.latex)}</td><td>{escape(e.unit)}</td><td>{escape(e.where)}</td>"
        f"<td>{_prose(e.meaning)}</td></tr>"
        for e in NOMENCLATURE.values()
    ]
    clashes = [
        f"<tr><td>{_mathml(letter)}</td><td>{_prose('; '.join(meanings))}</td></tr>"
        for letter, meanings in CLASHES.items()
    ]
    head = "<tr><th>symbol</th><th>unit</th><th>defined</th><th>meaning</th></tr>"
    return (
        f'<section id="nomenclature"><h2>Symbols</h2><details><summary>{len(rows)} symbols</summary><div class="wide">'
        f"<table>{head}{''.join(rows)}</table></div></details><h2>One letter, several "
        f"meanings</h2><details><summary>{len(clashes)} "
        f"letters</summary><div class='wide'><table>{''.join(clashes)}</table></div></details></section>"
    )


def page(records: list[dict[str, Any]], entries: Iterable[Entry]) -> str:
    """The page of a whole ledger."""
    pictures = {e.id: svg(e.picture(), anchor(e.id)) for e in entries if e.picture is not None}
    kinds = {
        **{v: sum(r["verdict"] == v for r in records) for v in VERDICTS},
        **{s: sum(r["severity"] == s for r in records) for s in SEVERITIES},
        "doubtful": sum(r["copy"] == "doubtful" for r in records),
    }
    buttons = f'<button data-kind="all" aria-pressed="true">all {len(records)}</button>' + "".join(
        f'<button data-kind="{kind}" aria-pressed="false">{kind} {count}</button>' for kind, count in kinds.items()
    )
    counts = "; ".join(counted(records).splitlines())
    index = "".join(
        f'<a class="{r["verdict"]}" href="#{escape(anchor(r["id"]))}">{escape(r["id"])}</a>' for r in records
    )
    articles = "\n".join(_article(r, pictures.get(r["id"], "")) for r in records)
    return (
        '<!DOCTYPE html>\n<html lang="en"><head><meta charset="utf-8"><meta name="viewport" '
        'content="width=device-width"><link rel="icon" href="data:,"><title>The ledger: every equation judged</title>'
        f"<style>{_STYLE}</style></head><body><header><h1>The ledger</h1><p>Every numbered equation of <i>Research on "
        "Low-Speed Driving Model of Ultrasonic Motor Based on Beat Traveling Wave Theory</i> (Actuators 2021, 10(11), "
        "304), the definitions between them, its tables and statements: what is printed, what follows from first "
        "principles, the verdict, the evidence, and what the difference does to TRUM-60 at the operating point of "
        "Table 3 (180 N, 3000 Hz, 14 of 20 pulses). A tick marks a step or finding that is checked by machine each "
        f"time this page is made.</p><p>{escape(counts)}. An erratum is typographical if no figure changes, "
        "conditional if it is judged against our reconstruction of the supplement, structural if no change of a few "
        "signs mends it, else quantitative. A copy is doubtful where the text at hand may have lost a "
        "sign.</p></header>"
        f'<div class="bar">{buttons}<input id="search" type="search" placeholder="search" aria-label="search">'
        f'<span id="shown"></span></div><nav class="index">{index}</nav>\n{articles}\n{_nomenclature()}'
        f"<script>{_SCRIPT}</script></body></html>\n"
    )
