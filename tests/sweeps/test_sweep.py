"""Sweeps: their figures are those of single points, whatever the chunks; ranges, files, estimates, bad input."""

from __future__ import annotations

import io
import itertools
import pickle
import time
import tracemalloc
import warnings

import numpy as np
import pytest
from lazily import lazily
from refusals import refusal

import trum_sym as ts
from trum_sym.console import main
from trum_sym.model import batch
from trum_sym.model.levels import Levels
from trum_sym.output.progress import Progress, duration
from trum_sym.quantities import ERRORS, QUANTITIES
from trum_sym.sweeps import engine
from trum_sym.sweeps.grid import PARAMETERS, chunk_shape
from trum_sym.sweeps.notation import parse
from trum_sym.sweeps.plan import make_plan
from trum_sym.sweeps.task import Found, compute

xr = lazily("xarray")

DRIVE = ts.Drive(periods=4, on_periods=3, load_torque=0.1)
LEVELS = Levels()
SMALL = ["--periods", "4", "--on-periods", "3", "--load-torque", "0.1"]


def plan_of(motor, outputs=("q_average",), chunk=None, drive=DRIVE, **ranges):
    return make_plan(motor, drive, LEVELS, None, 1e-3, outputs, chunk, ranges)


# --- Figures ---------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("chunk", [1, 7, 100])
def test_every_point_has_the_bits_of_evaluate(trum60, chunk):
    forces, frictions, loads = [150.0, 180.0, 210.0], [0.2, 0.3], [0.1, 2.0]
    drive = ts.Drive(periods=4, on_periods=3)
    found = ts.sweep(
        trum60, drive, chunk=chunk, prepressure=forces, friction_coefficient=frictions, load_torque=np.array(loads)
    )
    assert found.sizes == {"prepressure": 3, "friction_coefficient": 2, "load_torque": 2}
    assert set(found.data_vars) == {*QUANTITIES, *ERRORS, "converged", "status"}
    for i, j, k in itertools.product(range(3), range(2), range(2)):
        motor = trum60.with_values({"friction_coefficient": frictions[j]})
        drive = ts.Drive(prepressure=forces[i], load_torque=loads[k], periods=4, on_periods=3)
        one = ts.evaluate(motor, drive, tolerance=1e-6)
        here = found.isel(prepressure=i, friction_coefficient=j, load_torque=k)
        for name in (*QUANTITIES, *ERRORS, "converged"):
            assert np.array_equal(here[name].item(), getattr(one, name), equal_nan=True), name
        assert here.status == (1 if np.isnan(one.mean_speed) else 0)
    assert int((found.status == 1).sum()) == 6, "2 N m is more than friction carries"


def test_what_evaluate_refuses_is_nan_and_says_so_and_nothing_else_is(trum60):
    periods, on_periods, damping = [4, 6, 8], [2, 3, 5, 8], [0.0, 0.006]
    drive = ts.Drive(frequency_difference=0.0, load_torque=0.1)
    ranges = {"periods": periods, "on_periods": on_periods, "damping_ratio": damping}
    found = ts.sweep(trum60, drive, outputs=("mean_speed", "converged", "q_average"), **ranges)
    for i, j, k in itertools.product(range(3), range(4), range(2)):
        here = found.isel(periods=i, on_periods=j, damping_ratio=k)
        try:
            one = ts.evaluate(
                trum60.with_values({"damping_ratio": damping[k]}),
                ts.Drive(frequency_difference=0.0, load_torque=0.1, periods=periods[i], on_periods=on_periods[j]),
            )
        except ts.ParameterError:
            assert here.status == 3
            assert np.isnan(here.mean_speed)
            assert np.isnan(here.q_average)
            assert not here.converged
        else:
            assert here.status == 0
            assert (here.mean_speed, here.q_average) == (one.mean_speed, one.q_average)
    assert int((found.status == 3).sum()) == 24 - 6


def test_a_point_that_does_not_settle_costs_only_itself(trum60, monkeypatch):
    from trum_sym.model import stator

    monkeypatch.setattr(stator, "_MAX_ITERATIONS", 13)
    forces = np.linspace(100, 220, 13)
    found = ts.sweep(trum60, DRIVE, amplitude="forced", outputs=("amplitude",), prepressure=forces)
    alone = []
    for force in forces:
        try:
            alone.append(ts.evaluate(trum60, ts.Drive(prepressure=force), amplitude="forced").amplitude)
        except ts.ConvergenceError:
            alone.append(np.nan)
    assert 0 < np.isnan(alone).sum() < 13
    assert found.amplitude.values == pytest.approx(alone, rel=1e-12, nan_ok=True)
    assert np.array_equal(found.status == 3, np.isnan(alone))


@pytest.mark.parametrize(
    ("outputs", "kernels"),
    [
        (("drive_frequency", "amplitude"), set()),
        (("q_average",), {"cycle_sums"}),
        (("stall_torque",), {"rotor_orbit"}),
        (("q_ratio", "mean_speed"), {"cycle_sums", "rotor_orbit"}),
    ],
)
def test_only_what_the_outputs_need_is_computed(trum60, monkeypatch, outputs, kernels):
    called, original = set(), batch.call
    monkeypatch.setattr(batch, "call", lambda kernel, values: called.add(kernel) or original(kernel, values))
    ts.sweep(trum60, DRIVE, outputs=outputs, prepressure=[150, 180])
    assert called & {"cycle_sums", "rotor_orbit"} == kernels


@pytest.mark.parametrize("name", PARAMETERS)
def test_every_number_can_be_swept(trum60, name):
    optional = {"resonance_frequency": 39e3, "amplitude": 5e-6, "neutral_axis": 2.8e-3, "wavenumber": 300.0}
    optional |= {"phase_coverage": 0.5, "layer_loss_factor": 0.1}  # which no more than 1 may be
    stiff = dict.fromkeys(("layer_stiffness", "contact_stiffness", "tangential_stiffness"), 3e10)
    start = {**ts.Drive().numbers(), "sampling_period": 2e-3, **stiff, **optional}
    drive = ts.Drive(load="weight", load_radius=0.03) if name == "load_radius" else ts.Drive()
    value = start[name] if name in start else getattr(trum60, name).value
    value = 0.03 if name == "load_radius" else value
    other = -value if name == "phase_lead" else value + 1 if value == round(value) and value < 1e3 else value * 1.001
    found = ts.sweep(trum60, drive, outputs=("q_average",), **{name: [value, other]})
    assert found[name].units == PARAMETERS[name][1]
    assert not found.status.any()


def test_values_of_one_dimension_vary_together(trum60):
    force, difference = np.array([150.0, 180.0, 180.0]), np.array([2000.0, 3000.0, 2500.0])
    found = ts.sweep(
        trum60,
        DRIVE,
        outputs=("q_average",),
        prepressure=xr.DataArray(force, dims="run"),
        load_torque=[0.1, 0.2],
        frequency_difference=xr.DataArray(difference, dims="run"),
    )
    assert found.q_average.dims == ("run", "load_torque")
    assert set(found.coords) == {"prepressure", "frequency_difference", "load_torque"}
    one = ts.evaluate(trum60, ts.Drive(periods=4, on_periods=3, prepressure=force, frequency_difference=difference))
    assert np.array_equal(found.q_average[:, 1], one.q_average)


# --- Grids and chunks ------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("shape", [(7,), (10, 11), (3, 1, 50, 4), (1000, 1000, 10)])
@pytest.mark.parametrize("points", [1, 6, 100, 16384])
def test_chunks_cover_the_grid_once_and_hold_no_more_points_than_asked(trum60, shape, points):
    chunk = chunk_shape(shape, points)
    assert np.prod(chunk) <= points
    assert np.prod(chunk) * 2 > min(points, np.prod(shape)) / 2, "nor far fewer"
    names = ("prepressure", "load_torque", "switching_phase", "frequency_difference")
    ranges = {name: 100 + np.arange(n, dtype=float) for name, n in zip(names, shape, strict=False)}
    if np.prod(shape) / np.prod(chunk) > 300:
        return
    plan = plan_of(trum60, chunk=points, **ranges)
    seen = np.zeros(shape, int)
    for index in np.ndindex(plan.chunks):
        task = plan.task(index)
        where = np.ix_(*(np.searchsorted(ranges[n], task.values[n].ravel()) for n in ranges))
        seen[where] += 1
        assert seen[where].shape == task.shape
    assert (seen == 1).all()


def test_a_grid_is_never_laid_out(trum60):
    ranges = {"prepressure": "100:200:2001", "frequency_difference": "1000:5000:2001", "load_torque": "0.01:0.1:2001"}
    tracemalloc.start()
    try:
        plan = plan_of(trum60, **ranges)  # 8e9 points
        task = plan.task((3, 1, 0))
        peak = tracemalloc.get_traced_memory()[1]
    finally:
        tracemalloc.stop()
    assert plan.grid.size == 2001**3
    assert peak < 30e6
    assert len(pickle.dumps(task)) < 100_000


def test_no_more_chunks_are_under_way_than_the_pool_takes(trum60):
    class Counting(engine.Here):
        most = now = 0

        def threads(self):
            return 3

        def submit(self, task):
            self.now += 1
            self.most = max(self.most, self.now)
            return super().submit(task)

        def result(self, future):
            self.now -= 1
            return super().result(future)

    plan, pool = plan_of(trum60, ("amplitude",), 5, prepressure=np.linspace(100, 220, 200)), Counting()
    taken = 0

    def tasks():
        nonlocal taken
        for i in range(40):
            taken += 1
            assert taken - i <= 1
            yield plan.task((i,))

    found = list(engine.compute_all(tasks(), pool, lambda: None))
    pool.close()
    assert len(found) == 40
    assert pool.most == 6


def test_a_chunk_keeps_to_its_thread(trum60, monkeypatch):
    plan = plan_of(trum60, ("q_average", "stall_torque"), prepressure=np.linspace(150, 180, 1100))
    task = plan.sample(1100)
    monkeypatch.setattr(batch, "_in_threads", None)
    assert not compute(task).figures["status"].any()
    with pytest.raises(TypeError):
        ts.evaluate(trum60, ts.Drive(prepressure=np.linspace(150, 180, 1100)))


def test_a_worker_with_another_kernel_is_refused(trum60):
    task = plan_of(trum60, prepressure=[150, 180]).task((0,))
    assert isinstance(compute(task), Found)
    task.identity["kernels_sha256"] = "other"
    with refusal("worker", "kernels_sha256", "need other"):
        compute(task)


def future(error):
    """A future of Dask that has failed."""

    class Failed:
        key = "chunk"
        released = False

        def result(self):
            raise error

        def release(self):
            self.released = True

    return Failed()


@pytest.fixture
def cluster(trum60):
    found = engine.Cluster.__new__(engine.Cluster)
    found._address, found._deaths = "tcp://head:8786", {}
    found._tasks = {"chunk": plan_of(trum60, prepressure=[150, 180]).task((0,))}
    return found


def test_a_chunk_that_kills_its_workers_is_tried_again_but_not_for_ever(cluster):
    from distributed import KilledWorker

    killed, task = future(KilledWorker("chunk", None, 3)), cluster._tasks["chunk"]
    for _ in range(3):
        assert cluster.result(killed) is None
        cluster._tasks["chunk"] = task
    with pytest.raises(ts.UnfinishedError, match=r"workers die of chunk \(0,\)"):
        cluster.result(killed)
    assert killed.released, "so that no worker's death has it computed again"


def test_workers_without_the_package_are_named(cluster):
    with refusal("scheduler: got tcp://head:8786", "workers with this trum-sym", "No module"):
        cluster.result(future(ModuleNotFoundError("No module named 'trum_sym'")))


def test_work_that_is_not_wanted_any_more_ends_within_a_block(trum60):
    asked = iter([False, True])
    task = plan_of(trum60, prepressure=np.linspace(150, 180, 2000)).task((0,))
    with pytest.raises(batch.StoppedError):
        compute(task, lambda: next(asked))


# --- Notation --------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("text", "values"),
    [
        ("160:210:3", [160, 185, 210]),
        ("210 : 160 : 3", [210, 185, 160]),
        ("1:2:by=0.25", [1, 1.25, 1.5, 1.75, 2]),
        ("2:1:by=-0.5", [2, 1.5, 1]),
        ("0:0.3:by=0.1", [0, 0.1, 0.2, 0.3]),
        ("1 kN:2 kN:by=500 N", [1000, 1500, 2000]),
        ("180,160,0.2e3", [180, 160, 200]),
        ("1 kN, 500 mN", [1000, 0.5]),
        ("180 N", 180),
    ],
)
def test_ranges_are_read(text, values):
    assert parse("prepressure", text, "N") == pytest.approx(values, rel=1e-15)


@pytest.mark.parametrize(
    ("text", "need"),
    [
        ("160:210:by=7", "a step that divides the range, which here is 7.14286 steps"),
        ("160:210:by=-10", "a step that leads from the first end to the second"),
        ("160:210:by=0", "a finite step that is not 0"),
        ("160:nan:by=1", "finite ends"),
        ("160:210:by=", "a number between"),
        ("160:210:step=10", "LOW:HIGH:by=STEP"),
        ("160:160:5", "a range of two values or more"),
        ("160:210:1", "from 2 to 10000000"),
        ("160:210:0", "from 2 to 10000000"),
        ("160:210:-3", "from 2 to 10000000"),
        ("160:210:2.5", "from 2 to 10000000"),
        ("160:210:99999999", "from 2 to 10000000"),
        ("160:210:1e-9", "from 2 to 10000000"),
        ("160:210:by=1e-9", "a step that divides"),
        ("160:210", "LOW:HIGH:COUNT"),
        ("160:210:3:4", "LOW:HIGH:COUNT"),
        (":210:3", "a number between"),
        ("160,", "a number between"),
        (",", "a number between"),
        ("1 kN:2000:3", "a unit on every number, or on none (then in N)"),
        ("1,2,3 kN", "a unit on every number, or on none"),
        ("160:strong:3", "a number in N"),
        ("160 Hz:170 Hz:3", "a number in N"),
    ],
)
def test_what_is_no_range_is_refused(text, need):
    with refusal("prepressure", need):
        parse("prepressure", text, "N")


def test_columns_of_a_file_are_read_with_their_units(trum60, tmp_path):
    file = tmp_path / "design.csv"
    file.write_text("\ufeffprepressure [kN], run ,friction_coefficient\n0.15,a,0.2\n\n0.18,b,0.25\n")
    ranges = {"prepressure": f"@{file}", "load_torque": "0.1,0.2", "friction_coefficient": f"@{file}"}
    found = ts.sweep(trum60, DRIVE, outputs=("stall_torque",), **ranges)
    assert found.stall_torque.dims == ("row", "load_torque")
    assert found.prepressure.values == pytest.approx([150, 180], rel=1e-15)
    one = ts.evaluate(trum60, ts.Drive(prepressure=180, load_torque=0.2, periods=4, on_periods=3))
    assert found.stall_torque[1, 1] == one.stall_torque


@pytest.mark.parametrize(
    ("content", "need"),
    [
        (b"force\n1\n", "the columns force in @"),
        (b"prepressure,prepressure\n1,2\n", "a CSV file with a column prepressure"),
        (b"", "a CSV file with a header line"),
        (b"prepressure\n", "0 rows in @"),
        (b"prepressure\n1\nmany\n", "many in line 3 of @"),
        (b"prepressure\n1\n\n-3\n", "got -3"),
        (b"a,prepressure\n1\n", "1 columns in line 2 of @"),
        (b"prepressure [Hz]\n1\n", "1 Hz in line 2 of @"),
        (b"prepressure\n\xff\n", "a readable CSV file (not UTF-8 text)"),
        (b'prepressure\n"1\n', "unexpected end of data"),
    ],
)
def test_a_file_that_has_no_such_column_is_refused(trum60, tmp_path, content, need):
    (tmp_path / "f.csv").write_bytes(content)
    with refusal("prepressure", need):
        ts.sweep(trum60, outputs=("amplitude",), prepressure=f"@{tmp_path / 'f.csv'}", periods=[4, 5])


# --- Results ---------------------------------------------------------------------------------------------------------


def test_a_store_opens_with_units_coordinates_and_provenance(trum60, tmp_path):
    out = tmp_path / "map.zarr"
    motor = trum60.with_values({"contact_radius": 0.026})
    returned = ts.sweep(motor, DRIVE, out=out, outputs=("q_average", "mean_speed"), prepressure=[150, 180, 210])
    with xr.open_zarr(out, chunks=None) as found:
        assert found.equals(returned)
        assert found.mean_speed.units == "rad/s"
        assert found.q_average.long_name == "speed determinant Q_aver"
        assert found.prepressure.units == "N"
        assert found.attrs["motor_contact_radius"] == "0.026 m (set)"
        assert found.attrs["motor_file"] == trum60.text
        assert ts.load_motor().name in found.attrs["motor_file"]
        assert found.attrs["package"].startswith("trum-sym ")
        assert found.attrs["tolerance"] == 1e-6
        assert "prepressure" not in found.attrs, "swept"
        for name, value in DRIVE.numbers().items():
            assert name == "prepressure" or found.attrs[name] == value


@pytest.mark.parametrize("suffix", [".nc", ".parquet", ".csv"])
def test_small_results_are_files_too(trum60, tmp_path, suffix, capsys):
    out = tmp_path / f"map{suffix}"
    options = [
        "--prepressure",
        "150:210:3",
        "--set",
        "friction_coefficient=0.2,0.3",
        "--outputs",
        "mean_speed,converged",
    ]
    assert main(["sweep", *SMALL, *options, "--out", str(out)]) == 0
    assert capsys.readouterr().out == f"{out}: 6 points of mean_speed converged\n"
    assert [file.name for file in tmp_path.iterdir()] == [out.name]
    ours = ts.sweep(
        trum60, DRIVE, outputs=("mean_speed", "converged"), prepressure="150:210:3", friction_coefficient=[0.2, 0.3]
    )
    if suffix == ".nc":
        with xr.open_dataset(out) as written:
            assert written.equals(ours)
            assert written.attrs == ours.attrs
        return
    import pandas as pd

    table = pd.read_csv(out) if suffix == ".csv" else pd.read_parquet(out)
    assert list(table["prepressure [N]"]) == [150, 150, 180, 180, 210, 210]
    close = {"rtol": 4e-16 if suffix == ".csv" else 0.0, "atol": 0.0}  # old pandas read the last bit as it comes
    assert np.allclose(table["mean_speed [rad/s]"], ours.mean_speed.values.ravel(), **close)
    assert suffix == ".csv" or table.attrs == ours.attrs


def test_a_dry_run_says_what_it_takes_and_writes_nothing(tmp_path, capsys):
    out = tmp_path / "map.zarr"
    options = ["--prepressure", "150:210:101", "--set", "friction_coefficient=0.1:0.3:101", "--outputs", "amplitude"]
    assert main(["sweep", *SMALL, *options, "--out", str(out), "--dry-run", "--chunk", "1000"]) == 0
    lines = capsys.readouterr().out.splitlines()
    assert lines[0] == "10201 points: prepressure 101 x friction_coefficient 101"
    assert lines[1] == "12 chunks of 9 x 101 points"
    assert lines[2] == "0.0876 MiB before compression: amplitude status"
    assert "points a second" in lines[3]
    assert list(tmp_path.iterdir()) == []


def test_an_estimate_is_that_of_the_run(trum60, monkeypatch):
    from trum_sym.sweeps import run

    monkeypatch.setattr(run, "_SAMPLE_SECONDS", 0.2)
    plan = plan_of(trum60, ("mean_speed",), prepressure=np.linspace(120, 210, 1000))
    found = run.estimate("out", plan, None, None, False)
    begin = time.perf_counter()
    ts.sweep(trum60, DRIVE, outputs=("mean_speed",), prepressure=np.linspace(120, 210, 1000))
    assert 0.05 < found.seconds / (time.perf_counter() - begin) < 20  # the machine may be busy meanwhile


def test_progress_has_rate_time_left_and_failures(monkeypatch):
    from trum_sym.output import progress

    now = 100.0
    monkeypatch.setattr(progress.time, "monotonic", lambda: now)
    stream = io.StringIO()
    shown = Progress(1000, 200, stream)
    now += 40
    shown.add(400, 3)
    shown.tick()
    shown.tick()
    assert stream.getvalue() == "600 of 1000 points (60 %), 10 a second, 40 s left, 3 failed\n"
    assert [duration(s) for s in (90, 600, 86400, 864000)] == ["90 s", "10 min", "24 h", "10 days"]


def test_prepressures_beyond_the_fit_are_warned_of_once(trum60):
    with pytest.warns(ts.ValidityWarning, match="80 N lies outside 100 to 220 N") as caught:
        ts.sweep(trum60, DRIVE, outputs=("amplitude",), chunk=2, prepressure=[150, 80, 180, 120])
    assert len(caught) == 1


# --- Bad input -------------------------------------------------------------------------------------------------------

BAD_RANGES = [
    ({}, ("sweep: got no range",)),
    ({"prepressure": 170.0}, ("sweep: got no range",)),
    ({"nonsense": [1, 2]}, ("swept parameter: got nonsense",)),
    ({"prepresure": [1, 2]}, ("got prepresure", "close names: prepressure")),
    ({"start": ["rest", "steady"]}, ("got start",)),
    ({"prepressure": []}, ("prepressure: got []", "empty")),
    ({"prepressure": [150, -1]}, ("prepressure: got -1", "> 0 and < 1e+06 in N")),
    ({"prepressure": [150, np.nan]}, ("prepressure: got nan",)),
    ({"prepressure": ["a", "b"]}, ("prepressure: got a", "a number in N")),
    ({"prepressure": [150, 150]}, ("prepressure: got 150 more than once",)),
    ({"prepressure": np.ones((2, 2))}, ("prepressure: got an array of shape (2, 2)",)),
    ({"periods": [4, 4.5]}, ("periods: got 4.5", "an integer")),
    ({"phase_lead": [1, 0]}, ("phase_lead", "1, -1 or both")),
    (
        {"prepressure": [150, 160], "load_torque": lambda: xr.DataArray([1, 2], dims="prepressure")},
        ("dimension prepressure",),
    ),
    ({"prepressure": lambda: xr.DataArray([150, 160], dims="status")}, ("dimension status",)),
    ({"prepressure": lambda: xr.DataArray([150, 160], dims="amplitude")}, ("dimension amplitude",)),
    ({"prepressure": [1e5, 2e5], "tolerance": 1.0}, ("tolerance: got 1",)),
    ({"prepressure": [150, 160], "contact": "glue"}, ("contact: got glue",)),
    ({"prepressure": [150, 160], "outputs": ("speed",)}, ("outputs: got speed", "mean_speed")),
    ({"prepressure": [150, 160], "outputs": ()}, ("outputs: got ()",)),
    ({"prepressure": [150, 160], "outputs": "mean_speed"}, ("outputs: got mean_speed", "a list")),
    ({"prepressure": [150, 160], "outputs": ("q_average", "q_average")}, ("outputs", "each figure once")),
    ({"wavenumber": [300, 310], "outputs": ("wavenumber",)}, ("outputs: got wavenumber", "not swept")),
    ({"prepressure": [150, 160], "chunk": 0}, ("chunk: got 0", ">= 1")),
    ({"prepressure": [150, 160], "chunk": 1.5}, ("chunk: got 1.5", "an integer")),
    ({"prepressure": "100:200:2001", "load_torque": "0:1:2001", "chunk": 1}, ("chunk: got 1", "more points")),
    ({"on_periods": [8, 9]}, ("on_periods: got 8", "periods = 20")),
    ({"frequency_difference": [-39e3, -38e3]}, ("frequency_difference", "-0.9 times the resonance")),
    ({"prepressure": [150, 160], "motor": 3}, ("motor: got 3",)),
    ({"prepressure": [150, 160], "drive": 3}, ("drive: got 3",)),
    ({"prepressure": [150, 160], "drive": ts.Drive(load_torque=np.array([0.1, 0.2]))}, ("load_torque", "as a range")),
    ({"prepressure": [150, 160], "out": "map"}, ("out: got map", ".zarr")),
    ({"prepressure": [150, 160], "out": "missing/map.zarr"}, ("out: got missing/map.zarr",)),
    ({"prepressure": [150, 160], "out": "/proc/map.zarr"}, ("out: got /proc/map.zarr", "can be written")),
    ({"prepressure": "100:200:20001", "load_torque": "0:1:20001", "chunk": 1e6}, ("out: got", "GiB", ".zarr")),
]


@pytest.mark.parametrize(
    ("wrong", "naming"), BAD_RANGES, ids=[", ".join(w) + f"-{i}" for i, (w, _) in enumerate(BAD_RANGES)]
)
def test_bad_input_is_named(trum60, wrong, naming, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    wrong = {name: value() if callable(value) else value for name, value in wrong.items()}
    with refusal(*naming):
        ts.sweep(**{"motor": trum60, "outputs": ("amplitude",), **wrong})
    assert list(tmp_path.iterdir()) == []


BAD_OPTIONS = [
    (["--prepressure", "160:210:by=7"], ("prepressure", "divides the range")),
    (["--prepressure", "160:210:3", "--set", "prepressure=1:2:3"], ("--set: got prepressure=1:2:3", "each name once")),
    (["--set", "radius=29 mm:30 mm:2", "--set", "radius=28 mm"], ("--set: got radius=29 mm:30 mm:2", "each name once")),
    (["--set", "nonsense=1:2:3"], ("swept parameter: got nonsense",)),
    (["--set", "=1:2:3"], ("swept parameter: got", "motor file")),
    (["--set", "radius", "--prepressure", "150,160"], ("--set: got radius", "NAME=VALUE")),
    (["--prepressure", "150,160", "--outputs", "q_average,"], ("outputs: got empty text",)),
    (["--prepressure", "150,160", "--chunk", "many"], ("chunk: got many",)),
    (["--prepressure", "150,160", "--phase-lead", "2"], ("--phase-lead", "1, -1 or both")),
    (["--prepressure", "150,160", "--scheduler", "nonsense://"], ("scheduler: got nonsense://", "a Dask scheduler")),
    (["--prepressure", "150,160", "--motor", "trum61"], ("motor: got trum61",)),
]


@pytest.mark.parametrize(("options", "naming"), BAD_OPTIONS, ids=[" ".join(o) for o, _ in BAD_OPTIONS])
def test_bad_options_are_one_line(console_refuses, tmp_path, options, naming):
    console_refuses("sweep", *options, "--out", str(tmp_path / "map.zarr"), naming=naming)
    assert list(tmp_path.iterdir()) == []


def test_a_sweep_needs_a_place(console_refuses):
    console_refuses("sweep", "--prepressure", "150,160", naming=("--out: got nothing", ".zarr"))


def test_a_scheduler_that_does_not_answer_is_one_line(console_refuses, tmp_path, monkeypatch):
    monkeypatch.setattr(engine, "_CONNECT", 0.5)
    options = ["--prepressure", "150,160", "--out", str(tmp_path / "map.zarr"), "--scheduler", "tcp://127.0.0.1:9"]
    console_refuses("sweep", *options, naming=("scheduler: got tcp://127.0.0.1:9", "the address of a Dask scheduler"))
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("zarr_format", [2, 3])
@pytest.mark.parametrize("on_disk", [False, True])
def test_what_a_sweep_returns_is_written_in_other_ways(tmp_path, zarr_format, on_disk):
    """In another Zarr format, and in chunks that are not the store's."""
    found = ts.sweep(
        ts.load_motor(),
        prepressure=[170.0, 180.0, 190.0],
        frequency_difference=[2900.0, 3000.0],
        outputs=("amplitude", "converged"),
        out=tmp_path / "map.zarr" if on_disk else None,
    )
    for name, given in (
        ("whole", found),
        ("chunked", found.chunk({"prepressure": 2})),
        ("part", found.isel(prepressure=0)),
    ):
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # consolidated metadata are not settled for format 3
            given.to_zarr(tmp_path / f"{name}.zarr", zarr_format=zarr_format)
        again = xr.open_zarr(tmp_path / f"{name}.zarr", chunks=None).load()
        assert again.equals(given.load())
