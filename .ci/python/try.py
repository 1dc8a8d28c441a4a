"""Tries the package: what Python gets is what the command line writes into the folder that is named."""

import os
import signal
import sys
import threading
import warnings
from fractions import Fraction
from pathlib import Path

import numpy as np
import pandas as pd

import gyrolab

expected = Path(sys.argv[1])

# A run: the rows of the CSV, to the last bit, and what is known about them.
with warnings.catch_warnings(record=True) as warned:
    warnings.simplefilter("always")
    run = gyrolab.run("wobble-push")
assert run.equals(gyrolab.table((expected / "run.csv").read_text()))
assert "wobble" in run.attrs["header"] and len(run) == 2301
assert run.attrs["reliable"] is False and run.attrs["summary"]["steps"] == 2300
assert warned[0].category is gyrolab.UnreliableRunWarning and warned[0].filename == __file__
assert run.attrs["verdict"] in str(warned[0].message)
warnings.simplefilter("ignore", gyrolab.UnreliableRunWarning)
again = gyrolab.summary(run)
assert (again["z_m"], again["title"]) == (run["z_m"].iloc[-1], "The wobble push")
every = gyrolab.run("cusps", every=np.int64(100), columns=["t_s", "tilt_deg"])
assert list(every.columns) == ["t_s", "tilt_deg"] and every.attrs["reliable"]

# Values: Python's, NumPy's, pandas's.
for value in (0.05, np.float64(0.05), np.longdouble(0.05), np.array(0.05), Fraction(1, 20)):
    assert gyrolab.summary("method-2", set={"motion.time_step_s": value, "motion.steps": np.int32(7)})["time_step_s"] == 0.05
for force in ([0, 0, -50], np.array([0.0, 0.0, -50.0]), pd.Series([0, 0, -50])):
    assert 'force_N = [0.0, 0.0, -50.0]' in gyrolab.run("wobble-push", set={"push.0.force_N": force}, steps=1).attrs["header"]
assert gyrolab.summary("cusps", set={"view.exact": np.bool_(True), "title": 'a "b" ä'}, steps=1)["title"] == 'a "b" ä'

# Sweeps: arrays as values, strings as values, and a file that is continued and then only read.
sweep = gyrolab.sweep("wobble-over-time-step")
assert sweep.equals(gyrolab.table((expected / "sweep.csv").read_text()))
tilts = gyrolab.sweep("method-2", vary={"start.tilt_deg": np.array([30, 45])}, measure=["tilt_deg"])
assert list(tilts["start.tilt_deg"]) == [30, 45]
grid = gyrolab.sweep("cusps", vary={"motion.scheme": ["rk4", "strang"], "start.tilt_deg": "10..30:3"}, measure=["z_m"], steps=2)
assert len(grid) == 6 and list(grid["motion.scheme"].unique()) == ["rk4", "strang"]
with warnings.catch_warnings(record=True) as warned:
    failed = gyrolab.sweep("cusps", vary={"start.momentum_Js.2": [20, 1e300]}, measure=["z_m"], steps=2)
assert failed["z_m"].isna().tolist() == [False, True] and "1 of 2" in str(warned[0].message)
assert warned[0].category is gyrolab.GyrolabWarning and warned[0].filename == __file__
grid = dict(vary={"start.tilt_deg": np.linspace(10, 40, 100)}, measure=["z_m"], steps=400_000, file="long.csv")
threading.Timer(2, os.kill, (os.getpid(), signal.SIGINT)).start()
try:
    gyrolab.sweep("cusps", **grid)
except KeyboardInterrupt:
    begun = gyrolab.table(Path("long.csv.part").read_text())
else:
    raise AssertionError("the sweep should have been interrupted")
long = gyrolab.sweep("cusps", **grid)
assert len(begun) < len(long) == 100 and long.iloc[: len(begun)].equals(begun)
assert gyrolab.sweep("cusps", **grid).equals(long)

# Figures: the same bytes, of files, of runs and of tables; and how a notebook shows them.
drawn = gyrolab.figure("cusps", "figure.svg", kind="above")
assert drawn.data == (expected / "figure.svg").read_bytes() == Path("figure.svg").read_bytes()
shown = gyrolab.figure(run, kind=["z_m", "tilt_deg"], label="pushed")
assert shown._repr_svg_().startswith("<") and shown._repr_png_() is None and "pushed" in shown._repr_svg_()
assert gyrolab.figure(sweep)._repr_svg_() and gyrolab.figure([run, "method-2"], text=True)._repr_svg_()
assert gyrolab.figure("cusps", "figure.png")._repr_png_() and gyrolab.figure("cusps", "figure.png")._repr_svg_() is None

# Compare, fit, verify.
errors = gyrolab.compare("cusps", schemes=["rk4", "strang"], time_steps=np.array([0.01, 0.005]), duration=1)
assert list(errors["scheme"]) == ["rk4", "rk4", "strang", "strang"] and (errors["error_m"] > 0).all()
found = gyrolab.fit("heidelberg-nutation", "heidelberg", ["body.part.0.moments_kg_m2.2"], set={"body.point.0.at_m.2": 0})
assert 0.003 < found["keys"][0]["value"] < 0.005
bounded = gyrolab.fit(
    gyrolab.table(gyrolab.command("presets", "heidelberg-nutation")), "heidelberg",
    {"body.part.0.moments_kg_m2.2": (np.float64(0.002), 0.01)}, set={"body.point.0.at_m.2": np.float32(0)},
)
assert abs(bounded["keys"][0]["value"] / found["keys"][0]["value"] - 1) < 1e-6 and bounded["keys"][0]["to"] == 0.01
assert gyrolab.verify(expected / "run.csv", "figure.svg") and "figure.svg" in str(gyrolab.verify("figure.svg"))
changed = (expected / "run.csv").read_text().replace("\n5,", "\n6,")
Path("changed.csv").write_text(changed)
assert not gyrolab.verify("changed.csv")
own = gyrolab.verify(run, against="wobble-push")
assert own and own.details and own.details[0]["agrees"] is True

# Errors have the program's message.
for call, words in [
    (lambda: gyrolab.run("no-such-preset"), "no-such-preset"),
    (lambda: gyrolab.run("cusps", set={"start.tilt": 3}), "start.tilt"),
    (lambda: gyrolab.verify("no-such-file.csv"), "no-such-file"),
    (lambda: gyrolab.figure(pd.DataFrame({"a": [1]})), "DataFrame-1.csv"),
]:
    try:
        call()
    except RuntimeError as error:
        assert words in str(error), error
    else:
        raise AssertionError(f"{words} should have been refused")
print("python: as on the command line")
