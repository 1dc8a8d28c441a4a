"""Tries the package: what Python gets is what the command line writes into the folder that is named."""

import sys
from pathlib import Path

import gyrolab

expected = Path(sys.argv[1])
run = gyrolab.run("wobble-push")
assert run.equals(gyrolab.table((expected / "run.csv").read_text()))
assert "wobble" in run.attrs["header"] and len(run) == 2301
assert gyrolab.summary("method-2", set={"motion.time_step_s": 0.05})["time_step_s"] == 0.05
sweep = gyrolab.sweep("wobble-over-time-step")
assert sweep.equals(gyrolab.table((expected / "sweep.csv").read_text()))
tilts = gyrolab.sweep("method-2", vary={"start.tilt_deg": [30, 45]}, measure=["tilt_deg"])
assert list(tilts["start.tilt_deg"]) == [30, 45]
drawn = gyrolab.figure("cusps", "figure.svg", "--kind", "above")
assert drawn.read_bytes() == (expected / "figure.svg").read_bytes()
try:
    gyrolab.run("no-such-preset")
except RuntimeError as error:
    assert "no-such-preset" in str(error)
else:
    raise AssertionError("an unknown preset must be refused")
print("python: as on the command line")
