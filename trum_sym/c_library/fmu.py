"""``trum-sym fmu``: the motor as a co-simulation unit of FMI 3.0 or 2.0, with its C source."""

from __future__ import annotations

import hashlib
import io
import platform
import shutil
import subprocess
import sys
import tempfile
import zipfile
from collections.abc import Mapping
from importlib.metadata import version
from pathlib import Path
from typing import NamedTuple
from xml.sax.saxutils import quoteattr

from trum_sym.c_library.numbers import motor_header
from trum_sym.c_library.sources import amalgamated, configured, library, unit
from trum_sym.errors import ParameterError
from trum_sym.inputs.drive import Drive
from trum_sym.inputs.motor import Motor
from trum_sym.model.levels import LevelChoice

__all__ = ["VARIABLES", "Variable", "built", "compiled"]

_MODEL = "trum"


class Variable(NamedTuple):
    """A variable of the unit; its place in :data:`VARIABLES` plus one is its value reference."""

    name: str
    type: str
    causality: str
    unit: str
    text: str
    start: str = ""


VARIABLES = (
    Variable("prepressure", "Float64", "input", "N", "Force that presses the rotor onto the stator"),
    Variable("frequency_difference", "Float64", "input", "Hz", "Drive frequency less resonance"),
    Variable("load_torque", "Float64", "input", "N.m", "Torque on the rotor against positive rotation"),
    Variable("periods", "Float64", "input", "", "Drive periods in a cycle, a whole number"),
    Variable("on_periods", "Float64", "input", "", "Periods of a cycle in which a phase is on, a whole number"),
    Variable("speed", "Float64", "output", "rad/s", "Speed of the rotor"),
    Variable("angle", "Float64", "output", "rad", "Angle of the rotor"),
    Variable("encoder", "Int64", "output", "", "Counts of the encoder"),
    Variable("contact_fraction", "Float64", "output", "", "Mean half-angle of the contact over pi, rotor held"),
    Variable("envelope_A", "Float64", "output", "m", "Amplitude of phase A"),
    Variable("envelope_B", "Float64", "output", "m", "Amplitude of phase B"),
    Variable("mean_speed", "Float64", "output", "rad/s", "Mean speed of the orbit that the rotor tends to"),
    Variable("start_speed", "Float64", "parameter", "rad/s", "Speed at the start, unless settled", "0"),
    Variable("settled", "Boolean", "parameter", "", "Whether the rotor starts on its orbit", "true"),
    Variable("encoder_counts", "Int64", "parameter", "", "Counts of the encoder in a turn", "2097152"),
)
"""What the unit takes and gives, after the time."""

_UNITS = {
    "N": 'kg="1" m="1" s="-2"',
    "Hz": 's="-1"',
    "N.m": 'kg="1" m="2" s="-2"',
    "rad/s": 'rad="1" s="-1"',
    "rad": 'rad="1"',
    "m": 'm="1"',
    "s": 's="1"',
}


def _variability(variable: Variable) -> str:
    if variable.causality == "output":
        return "discrete" if variable.type == "Int64" else "continuous"
    return {"parameter": "fixed", "input": "discrete"}[variable.causality]


def _start(variable: Variable, drive: Drive) -> str:
    start = f"{float(getattr(drive, variable.name))!r}" if variable.causality == "input" else variable.start
    return f' start="{start}"' if start else ""


def _about(motor: Motor) -> str:
    return (
        f"modelName={quoteattr(motor.name)} "
        'description="Travelling-wave ultrasonic motor under superimposed pulse driving" '
        f'version="{version("trum-sym")}" license="MIT" generationTool="trum-sym"'
    )


_COMMON = [
    "  <UnitDefinitions>",
    *(f'    <Unit name="{name}"><BaseUnit {base}/></Unit>' for name, base in _UNITS.items()),
    "  </UnitDefinitions>",
    '  <LogCategories><Category name="logStatusError"/></LogCategories>',
    '  <DefaultExperiment startTime="0" stopTime="0.01" stepSize="0.0001"/>',
    "  <ModelVariables>",
]
_OUTPUTS = [place for place, variable in enumerate(VARIABLES, 1) if variable.causality == "output"]


def description(motor: Motor, drive: Drive, token: str) -> str:
    """``modelDescription.xml`` of FMI 3.0."""
    lines = ['<?xml version="1.0" encoding="UTF-8"?>']
    lines.append(f'<fmiModelDescription fmiVersion="3.0" instantiationToken="{token}" {_about(motor)}>')
    lines.append(
        f'  <CoSimulation modelIdentifier="{_MODEL}" canHandleVariableCommunicationStepSize="true" '
        'canBeInstantiatedOnlyOncePerProcess="false"/>'
    )
    time = 'name="time" valueReference="0" causality="independent" variability="continuous" unit="s"'
    lines += [*_COMMON, f"    <Float64 {time}/>"]
    for place, variable in enumerate(VARIABLES, 1):
        parts = [f'name="{variable.name}"', f'valueReference="{place}"', f'causality="{variable.causality}"']
        parts += [f'variability="{_variability(variable)}"', f'description="{variable.text}"']
        parts += [f'unit="{variable.unit}"'] * bool(variable.unit)
        lines.append(f"    <{variable.type} {' '.join(parts)}{_start(variable, drive)}/>")
    lines += ["  </ModelVariables>", "  <ModelStructure>"]
    lines += [f'    <Output valueReference="{place}"/>' for place in _OUTPUTS]
    lines += [f'    <InitialUnknown valueReference="{place}"/>' for place in _OUTPUTS]
    return "\n".join([*lines, "  </ModelStructure>", "</fmiModelDescription>", ""])


def description_2(motor: Motor, drive: Drive, token: str) -> str:
    """``modelDescription.xml`` of FMI 2.0, whose whole numbers have 32 bits: encoder counts are real there."""
    lines = ['<?xml version="1.0" encoding="UTF-8"?>']
    lines.append(f'<fmiModelDescription fmiVersion="2.0" guid="{token}" {_about(motor)}>')
    lines.append(f'  <CoSimulation modelIdentifier="{_MODEL}" canHandleVariableCommunicationStepSize="true">')
    lines.append('    <SourceFiles><File name="trum_fmi2.c"/></SourceFiles>')
    lines += ["  </CoSimulation>", *_COMMON]
    for place, variable in enumerate(VARIABLES, 1):
        parts = [f'name="{variable.name}"', f'valueReference="{place}"', f'causality="{variable.causality}"']
        parts += [f'variability="{_variability(variable)}"', f'description="{variable.text}"']
        parts += ['initial="calculated"'] * (variable.causality == "output")
        kind = {"Float64": "Real", "Int64": "Integer"}.get(variable.type, variable.type)
        if variable.name == "encoder":
            kind = "Real"
        unit = f' unit="{variable.unit}"' if variable.unit else ""
        lines.append(f"    <ScalarVariable {' '.join(parts)}><{kind}{unit}{_start(variable, drive)}/></ScalarVariable>")
    unknown = [f'      <Unknown index="{place}"/>' for place in _OUTPUTS]
    lines += ["  </ModelVariables>", "  <ModelStructure>", "    <Outputs>", *unknown, "    </Outputs>"]
    lines += ["    <InitialUnknowns>", *unknown, "    </InitialUnknowns>"]
    return "\n".join([*lines, "  </ModelStructure>", "</fmiModelDescription>", ""])


_BUILD = f"""\
<?xml version="1.0" encoding="UTF-8"?>
<fmiBuildDescription fmiVersion="3.0">
  <BuildConfiguration modelIdentifier="{_MODEL}">
    <SourceFileSet language="C99">
      <SourceFile name="trum_fmi3.c"/>
    </SourceFileSet>
    <Library name="m" external="true"/>
  </BuildConfiguration>
</fmiBuildDescription>
"""


def sources(motor: Motor, drive: Drive, levels: LevelChoice, fmi: int) -> tuple[dict[str, str], str]:
    """The unit's C files, and its token: a hash of them."""
    files = amalgamated(configured(library(), {"TRUM_REAL_BITS": "64"}))
    names = ("TRUM_MY_MOTOR_H", "MY_MOTOR_NAME", "my_motor", "my_drive")
    numbers = "\n".join([*motor_header(motor, drive, levels, names), ""])
    files |= {"motor.h": numbers, **unit(fmi)}
    digest = hashlib.sha256("".join(files[name] for name in sorted(files)).encode()).hexdigest()
    token = "{" + "-".join((digest[:8], digest[8:12], digest[12:16], digest[16:20], digest[20:32])) + "}"
    files["motor.h"] = f'#define TRUM_TOKEN "{token}"\n{numbers}'
    return files, token


def _platform(fmi: int) -> tuple[str, str] | None:
    """The folder in a unit for this machine, and the ending of its libraries; None where that is not known."""
    machine = {"AMD64": "x86_64", "arm64": "aarch64"}.get(platform.machine(), platform.machine())
    system, ending = {"linux": ("linux", ".so"), "darwin": ("darwin", ".dylib")}.get(sys.platform, ("", ""))
    if not system or (fmi == 2 and machine != "x86_64"):
        return None
    return (f"{machine}-{system}" if fmi == 3 else f"{system}64"), ending


def compiled(files: Mapping[str, str], fmi: int) -> dict[str, bytes]:
    """The unit compiled for this machine, by its place in the archive; empty where there is no compiler, or no place.

    Raises
    ------
    ParameterError
        If the compiler fails.
    """
    here, compiler = _platform(fmi), shutil.which("cc")
    if here is None or compiler is None:
        return {}
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        for file, text in files.items():
            (folder / file).write_text(text, "utf-8")
        target = folder / f"{_MODEL}{here[1]}"
        command = [compiler, "-std=c99", "-O2", "-ffp-contract=off", "-fPIC", "-shared", "-fvisibility=hidden"]
        done = subprocess.run(
            [*command, f"trum_fmi{fmi}.c", "-o", target.name, "-lm"], cwd=folder, capture_output=True, text=True
        )
        if done.returncode:
            said = next((line for line in done.stderr.splitlines() if "error:" in line), "it fails")
            raise ParameterError("compiler", compiler, f"one that compiles C99, or --sources-only ({said})")
        return {f"binaries/{here[0]}/{target.name}": target.read_bytes()}


def built(
    motor: Motor, drive: Drive, levels: LevelChoice, *, fmi: int = 3, binary: bool = True
) -> tuple[bytes, list[str]]:
    """The archive's bytes, and the names in it.

    Parameters
    ----------
    motor, drive
        Of one point, whose numbers are the inputs' start values: no arrays.
    levels : LevelChoice
        Words of the model's levels.
    fmi : 3 or 2
        Version of the standard.
    binary : bool
        Compile it for this machine as well.

    Raises
    ------
    ParameterError
        For a load that hangs on a string, which may go slack, or a compiler that fails.
    """
    if drive.load != "torque":
        raise ParameterError("load", drive.load, "torque: the unit does not follow a string that may go slack")
    files, token = sources(motor, drive, levels, fmi)
    model = description(motor, drive, token) if fmi == 3 else description_2(motor, drive, token)
    content: dict[str, bytes] = {"modelDescription.xml": model.encode()}
    if fmi == 3:
        content["sources/buildDescription.xml"] = _BUILD.encode()
    content |= {f"sources/{name}": text.encode() for name, text in files.items()}
    if binary:
        content |= compiled(files, fmi)
    archive = io.BytesIO()
    with zipfile.ZipFile(archive, "w", zipfile.ZIP_DEFLATED) as target:
        for name, data in content.items():
            target.writestr(zipfile.ZipInfo(name, (2021, 11, 10, 0, 0, 0)), data, zipfile.ZIP_DEFLATED)
    return archive.getvalue(), list(content)
