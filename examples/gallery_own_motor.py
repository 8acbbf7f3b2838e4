"""A motor of one's own: a file that changes TRUM-60 here and there, and a measured value in place of the model's.

    python examples/gallery_own_motor.py [FOLDER]

Prints both motors' figures; with a folder, also draws own-motor.svg there.
"""

from __future__ import annotations

import sys
import tempfile
from importlib.resources import files
from pathlib import Path

import trum_sym as ts
from trum_sym import plots


def main(folder: Path | None = None) -> None:
    """Write a motor file, load it, compare."""
    text = (files("trum_sym") / "data" / "trum60.toml").read_text("utf-8")
    text = text[: text.index("[[published]]")].replace('name = "TRUM-60"', 'name = "soft layer"')
    text = text.replace("layer_young_modulus = { value = 5.0,", "layer_young_modulus = { value = 1.0,")
    with tempfile.TemporaryDirectory() as place:
        path = Path(place) / "soft.toml"
        path.write_text(text, encoding="utf-8")
        soft = ts.load_motor(str(path))
    measured = soft.with_values({"resonance_frequency": "39.703 kHz"}, source="measured")
    panels = plots.blank(2, 2, height=5.0, height_ratios=(3, 1), sharey="row")
    for motor, axes in zip((ts.load_motor("trum60"), measured), (panels[::2], panels[1::2]), strict=True):
        point = ts.evaluate(motor)
        print(f"{motor.name:<11} f_n {point.resonance_frequency:8.1f} Hz   contact {point.contact_fraction:.3f}")
        plots.contact_zone(motor, axes=axes)
        axes[0].set_title(motor.name)
    if folder is not None:
        plots.save(panels[0].figure, folder / "own-motor.svg")


if __name__ == "__main__":
    main(Path(sys.argv[1]) if len(sys.argv) > 1 else None)
