"""Runs, sweeps and figures of gyrolab, the lab for the precession of a gyroscope.

>>> import gyrolab
>>> run = gyrolab.run("method-2", set={"motion.time_step_s": 0.05})
>>> run.plot("t_s", "tilt_deg")
>>> run.attrs["header"]         # the run file: the same run again
>>> gyrolab.figure("method-2", "method-2.svg", "--exact")

Every function starts the program ``gyrolab`` that came with this package. Further options are passed on as they stand
on the command line (``gyrolab.command("run", "--help")``).
"""

import io
import json
import os
import subprocess
import sysconfig
import tempfile
from pathlib import Path


def command(*words):
    """What ``gyrolab`` prints when it is called with these words. Raises ``RuntimeError`` with its message if it fails."""
    here = Path(sysconfig.get_path("scripts"), "gyrolab")
    program = os.environ.get("GYROLAB") or (here if here.exists() else "gyrolab")
    done = subprocess.run([program, *map(str, words)], capture_output=True, text=True, encoding="utf-8")
    if done.returncode:
        raise RuntimeError(done.stderr.strip() or f"gyrolab ended with exit code {done.returncode}")
    return done.stdout


def run(scenario, *options, set=None):
    """The rows of a run of a preset or file: a DataFrame. ``set`` has keys of the scenario with their values."""
    return table(command("run", scenario, "-o", "-", *_settings(set), *options))


def summary(scenario, *options, set=None):
    """The numbers that describe a run (``gyrolab readouts`` lists them): a dictionary."""
    return json.loads(command("run", scenario, "--json", *_settings(set), *options))


def sweep(scenario, *options, vary=None, measure=None):
    """A grid of runs, one row each: a DataFrame. ``vary`` has keys with the values to go through, or "A..B:N"."""
    words = []
    for key, values in (vary or {}).items():
        values = values if isinstance(values, str) else ",".join(map(repr, values))
        words += ["--vary", f"{key}={values}"]
    if measure:
        words += ["--measure", ",".join(measure)]
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder, "sweep.csv")
        command("sweep", scenario, "-o", file, *words, *options)
        return table(file.read_text(encoding="utf-8"))


def figure(runs, file, *options):
    """Draws a run, or a list of runs, into a file: SVG, PDF or PNG, as its name ends. An existing file is replaced."""
    runs = [runs] if isinstance(runs, (str, os.PathLike)) else list(runs)
    command("figure", *runs, "-o", file, "--force", *options)
    return Path(file)


def table(text):
    """A CSV of gyrolab as a DataFrame; ``attrs["header"]`` is the text of its header without the number signs."""
    import pandas

    lines = text.splitlines()
    header = [line[2:] for line in lines if line.startswith("#")]
    rows = pandas.read_csv(io.StringIO(text), comment="#")
    rows.attrs["header"] = "\n".join(header)
    return rows


def _settings(values):
    return [word for key, value in (values or {}).items() for word in ("--set", f"{key}={json.dumps(value)}")]
