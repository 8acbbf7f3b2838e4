"""The report: the paper's figures, tables and claims redrawn and judged, as one page that needs no network."""

from __future__ import annotations

from trum_sym.report.output import check_folder, write_report
from trum_sym.report.page import page

__all__ = ["check_folder", "page", "write_report"]
