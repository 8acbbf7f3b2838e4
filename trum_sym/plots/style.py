"""One style for all pictures: restrained, safe for the colour-blind, text that stays text."""

from __future__ import annotations

import io
import re
from collections.abc import Callable, Sequence
from contextlib import AbstractContextManager
from functools import wraps
from pathlib import Path
from typing import TYPE_CHECKING, Any, ParamSpec, TypeAlias, TypeVar
from xml.sax.saxutils import escape

import numpy as np

from trum_sym.errors import MissingExtraError, ParameterError
from trum_sym.output.files import write_bytes

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

__all__ = [
    "COLOURS",
    "GRID",
    "INK",
    "Panels",
    "blank",
    "figure_of",
    "legend",
    "panels",
    "save",
    "styled",
    "svg",
    "without_tex",
    "write_picture",
]

Panels: TypeAlias = "Axes | Sequence[Axes] | None"
P = ParamSpec("P")
T = TypeVar("T")
_BACKGROUND = '</title><rect width="100%" height="100%" fill="white"/>'

# Okabe and Ito's colours, in an order in which neighbours also differ in lightness
COLOURS = ("#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9")
INK, GRID = "#1b1f24", "#d0d7de"

_RC: dict[Any, Any] = {
    "font.family": "sans-serif",
    "font.size": 9,
    "axes.titlesize": 9,
    "axes.titlelocation": "left",
    "axes.linewidth": 0.6,
    "axes.grid": True,
    "axes.axisbelow": True,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.edgecolor": INK,
    "axes.labelcolor": INK,
    "axes.titlecolor": INK,
    "axes.formatter.useoffset": False,
    "axes.facecolor": "none",
    "figure.facecolor": "none",
    "grid.color": GRID,
    "grid.linewidth": 0.4,
    "image.cmap": "cividis",
    "legend.frameon": False,
    "legend.fontsize": 8,
    "legend.handlelength": 1.6,
    "lines.linewidth": 1.2,
    "text.color": INK,
    "text.usetex": False,
    "xtick.color": INK,
    "ytick.color": INK,
    "svg.fonttype": "none",
    "path.simplify": True,
    "path.simplify_threshold": 0.3,
}


def styled(draw: Callable[P, Figure]) -> Callable[P, Figure]:
    """Draw in the house style.

    Raises
    ------
    MissingExtraError
        Without matplotlib.
    """

    @wraps(draw)
    def in_style(*arguments: P.args, **options: P.kwargs) -> Figure:
        with _style():
            return draw(*arguments, **options)

    return in_style


def without_tex(draw: Callable[P, T]) -> Callable[P, T]:
    """Draw without TeX, whatever a ``matplotlibrc`` in the folder says: a motor's name is no program.

    Raises
    ------
    MissingExtraError
        Without matplotlib.
    """

    @wraps(draw)
    def drawn(*arguments: P.args, **options: P.kwargs) -> T:
        try:
            import matplotlib
        except ImportError as error:
            raise MissingExtraError("a picture", str(error.name), "report") from None
        with matplotlib.rc_context({"text.usetex": False}):
            return draw(*arguments, **options)

    return drawn


def _style() -> AbstractContextManager[None]:
    try:
        import matplotlib
        from cycler import cycler
    except ImportError as error:
        raise MissingExtraError("figures", str(error.name), "report") from None
    settings: AbstractContextManager[None] = matplotlib.rc_context({**_RC, "axes.prop_cycle": cycler(color=COLOURS)})
    return settings


def blank(rows: int = 1, columns: int = 1, height: float = 2.8, **options: Any) -> list[Axes]:  # noqa: ANN401
    """Empty axes of a new figure in the house style, row by row, for several pictures in one.

    Parameters
    ----------
    rows, columns : int
        Of the panels.
    height : float, inch
        The figure is 7.2 inches wide.
    options
        For ``Figure.subplots``.
    """
    with _style():
        return panels(None, rows, columns, height, **options)


def panels(axes: Panels, rows: int = 1, columns: int = 1, height: float = 2.8, **options: Any) -> list[Axes]:  # noqa: ANN401
    """The axes to draw in: those given, or a new figure's, row by row.

    Parameters
    ----------
    axes : Axes, sequence of Axes or None
        As many as the figure has panels.
    rows, columns : int
        Of the panels.
    height : float, inch
        Of a new figure, which is 7.2 inches wide.
    options
        For ``Figure.subplots``.

    Raises
    ------
    ParameterError
        For another number of axes.
    """
    if axes is not None:
        given = list(np.ravel(np.asarray(axes, dtype=object)))
        if len(given) != rows * columns:
            raise ParameterError("axes", f"{len(given)} axes", f"{rows * columns} of them, one a panel")
        return given
    from matplotlib.figure import Figure

    figure = Figure(figsize=(7.2, height), layout="constrained")
    return list(np.ravel(figure.subplots(rows, columns, squeeze=False, **options)))


def figure_of(axes: Axes) -> Figure:
    """The whole figure that axes belong to."""
    figure = axes.get_figure(root=True)
    if figure is None:
        raise ParameterError("axes", "axes that were removed from their figure", "axes of a figure")
    return figure


def legend(axes: Axes, **options: Any) -> None:  # noqa: ANN401
    """A legend above the axes, where it covers no data."""
    count = len(axes.get_legend_handles_labels()[1])
    axes.legend(
        **{
            "loc": "lower left",
            "bbox_to_anchor": (0.0, 1.0),
            "ncols": min(count, 4),
            "borderaxespad": 0.2,
            "columnspacing": 1.2,
            **options,
        }
    )


def write_picture(name: str, figure: Figure, target: Path) -> None:
    """Write a picture in the format of its suffix, whole or not at all.

    Parameters
    ----------
    name : str
        What a refusal calls the file.
    figure : Figure
        Any.
    target : Path
        A .png, .svg or .pdf file.

    Raises
    ------
    ParameterError
        If the file cannot be written.
    """
    content = io.BytesIO()
    with _style():
        figure.savefig(content, format=target.suffix[1:], dpi=150, facecolor="white")
    write_bytes(name, content.getvalue(), target)


def save(figure: Figure, target: Path) -> None:
    """Write the figure as an SVG file on white: the same bytes on every run.

    Parameters
    ----------
    figure : Figure
        Any.
    target : Path
        Its stem starts the ids inside.
    """
    element = svg(figure, target.stem, target.stem)
    space = ' xmlns="http://www.w3.org/2000/svg"'
    opened = element.replace("<svg", f"<svg{space}", 1).replace("</title>", _BACKGROUND, 1)
    write_bytes("picture", f"{opened}\n".encode(), target)


def svg(figure: Figure, salt: str, title: str) -> str:
    """The figure as an SVG element for a page: the same bytes on every run, ids of its own, a title for readers.

    Parameters
    ----------
    figure : Figure
        Any.
    salt : str
        Starts every id, so that pictures on one page do not share them.
    title : str
        What a screen reader says.
    """
    import matplotlib
    from matplotlib.backends.backend_svg import FigureCanvasSVG

    FigureCanvasSVG(figure)
    buffer = io.StringIO()
    with matplotlib.rc_context({**_RC, "svg.hashsalt": salt}):
        figure.savefig(buffer, format="svg", metadata={"Date": None, "Creator": None}, dpi=150)
    text = buffer.getvalue()
    element = re.sub(r"<metadata>.*?</metadata>", "", text[text.index("<svg") :], flags=re.S)
    element = re.sub(r' xmlns(:xlink)?="[^"]*"', "", element).replace("xlink:href", "href")
    element = re.sub(r' id="image\w+"', "", element)  # equal images would share it, and nothing refers to it
    names = {old: f"{salt}-{old}" for old in re.findall(r'id="([^"]+)"', element)}
    element = re.sub(r'(id="|="#|url\(#)([^")]+)', lambda found: found[1] + names.get(found[2], found[2]), element)
    element = re.sub(
        r'width="[^"]+pt" height="[^"]+pt" ', "", re.sub(r"<!--.*?-->\s*", "", element, flags=re.S), count=1
    )
    opened = re.search(r"<svg[^>]*", element)
    assert opened is not None
    return f'{opened[0]} role="img"><title>{escape(title)}</title>{element[opened.end() + 1 :]}'.strip()
