"""Runs, sweeps, fits and figures of gyrolab, the lab for the precession of a gyroscope.

>>> import gyrolab
>>> run = gyrolab.run("method-2", set={"motion.time_step_s": 0.05})
>>> run.plot("t_s", "tilt_deg")
>>> run.attrs["verdict"]        # whether the run is reliable, and why not
>>> gyrolab.figure([run, "method-2"], exact=True)       # in a notebook: the drawing itself

Every function starts the program ``gyrolab`` that comes with this package.

- A *scenario* is the name of a preset, a file, or a DataFrame of this package: its ``attrs["header"]`` holds the run.
- ``set`` maps keys of the scenario to values. A value can also be a NumPy scalar or array, or a Series.
- Other arguments are options of the command line: ``every=10`` is ``--every 10``, ``exact=True`` is ``--exact``. A list
  repeats the option, and a dictionary gives ``KEY=VALUE``. ``print(gyrolab.command("run", "--help"))`` lists those of
  ``run``.
- A command that fails raises ``RuntimeError`` with its message. A warning of the program is a ``GyrolabWarning``.
- Long commands show their progress in notebooks and terminals. ``gyrolab.progress = False`` turns this off.
"""

from __future__ import annotations

import io
import json
import os
import signal
import subprocess
import sys
import sysconfig
import tempfile
import threading
import warnings
from collections.abc import Iterable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path
from typing import IO, TYPE_CHECKING, Any, Callable, Optional, SupportsFloat, Union

if TYPE_CHECKING:
    import pandas
    from typing_extensions import TypeGuard

__all__ = ["Figure", "GyrolabWarning", "UnreliableRunWarning", "Verification", "command", "compare", "figure", "fit",
           "progress", "run", "summary", "sweep", "table", "verify"]

Scenario = Union[str, "os.PathLike[str]", "pandas.DataFrame"]
File = Union[str, "os.PathLike[str]"]

progress: Optional[bool] = None
"""Whether long commands show their progress on stderr; None: in notebooks and terminals."""


class GyrolabWarning(UserWarning):
    """A warning of the program about a command that it has carried out."""


class UnreliableRunWarning(GyrolabWarning):
    """A run that should not be trusted. The message says why, and what to change."""


@dataclass(frozen=True)
class Figure:
    """A figure in a file, or in memory. A notebook displays SVG and PNG."""

    data: bytes = field(repr=False)
    path: Optional[Path] = None

    def save(self, file: File) -> Path:
        """Writes the same bytes to another file."""
        path = Path(file)
        path.write_bytes(self.data)
        return path

    def _repr_svg_(self) -> Optional[str]:
        return self.data.decode() if self.data.lstrip().startswith((b"<svg", b"<?xml")) else None

    def _repr_png_(self) -> Optional[bytes]:
        return self.data if self.data.startswith(b"\x89PNG") else None


@dataclass(frozen=True)
class Verification:
    """The result of ``verify``. It is true if every file agrees."""

    agrees: bool
    text: str
    """What the program says of each file."""
    details: Optional[list[dict[str, Any]]] = None
    """With ``against``: what was compared, and the mistakes that explain the difference, one dictionary per file."""

    def __bool__(self) -> bool:
        return self.agrees

    def __str__(self) -> str:
        return self.text


def command(*words: object) -> str:
    """What ``gyrolab`` prints on stdout for these words of a command line."""
    return _checked(_call(words)).stdout


def run(scenario: Scenario, *words: object, set: Optional[Mapping[str, object]] = None, **options: object) -> pandas.DataFrame:
    """The rows of a run.

    ``attrs`` holds ``header`` (the run file), ``summary`` (as the function of that name), ``reliable`` and ``verdict``. A
    run that is not reliable gives an ``UnreliableRunWarning``.
    """
    _need_pandas()
    with _Words() as line:
        csv = line.folder / "run.csv"
        printed = line.call("run", scenario, "-o", csv, "--json", *_settings(set), *words, **options)
        rows = table(csv.read_text(encoding="utf-8"))
    numbers = json.loads(printed)
    rows.attrs.update(summary=numbers, reliable=numbers["reliable"], verdict=numbers["health"])
    if numbers["reliable"] is False:
        warnings.warn(f"{numbers['title']}: {numbers['health']}", UnreliableRunWarning, stacklevel=2)
    return rows


def summary(scenario: Scenario, *words: object, set: Optional[Mapping[str, object]] = None, **options: object) -> dict[str, Any]:
    """The numbers of a run, which ``gyrolab readouts`` lists."""
    with _Words() as line:
        numbers: dict[str, Any] = json.loads(line.call("run", scenario, "--json", *_settings(set), *words, **options))
        return numbers


def sweep(
    scenario: Scenario,
    *words: object,
    vary: Optional[Mapping[str, object]] = None,
    measure: Optional[Iterable[str]] = None,
    file: Optional[File] = None,
    set: Optional[Mapping[str, object]] = None,
    **options: object,
) -> pandas.DataFrame:
    """A grid of runs on all cores, one row per run.

    ``vary`` maps keys to their values, or to "A..B:N". With ``file``, the rows are written there as they are computed. If the
    kernel is interrupted or killed, the same call continues after the last row; if the file is complete, it is only read.
    """
    _need_pandas()
    with _Words() as line:
        csv = line.folder / "sweep.csv" if file is None else Path(file)
        line.call("sweep", scenario, "-o", csv, *_settings(set), *words, vary=vary, measure=measure, **options)
        return table(csv.read_text(encoding="utf-8"))


def compare(scenario: Scenario, *words: object, set: Optional[Mapping[str, object]] = None, **options: object) -> pandas.DataFrame:
    """Errors and costs of schemes and time steps, such as ``schemes=["rk4", "strang"], time_steps=[0.1, 0.05]``."""
    _need_pandas()
    with _Words() as line:
        return table(line.call("compare", scenario, "-o", "-", *_settings(set), *words, **options))


def fit(
    measured: Scenario,
    scenario: Scenario,
    free: Union[Iterable[str], Mapping[str, Optional[tuple[float, float]]], None] = None,
    *words: object,
    set: Optional[Mapping[str, object]] = None,
    **options: object,
) -> dict[str, Any]:
    """Fits the keys ``free`` of a scenario to measured data: a file, a data set that gyrolab ships, or a DataFrame.

    ``free`` lists the keys, or maps each to its bounds (or to None). The dictionary has ``keys`` (values and uncertainties),
    ``correlation``, ``chi_squared`` and ``residuals``; ``pandas.DataFrame(result["residuals"])`` makes a table of those.
    """
    bounds = free if isinstance(free, Mapping) else {key: None for key in free or ()}
    keys = [key if ends is None else f"{key}={_toml(ends[0])}..{_toml(ends[1])}" for key, ends in bounds.items()]
    with _Words() as line:
        printed = line.call("fit", measured, "--in", scenario, "--json", *_settings(set), *words, free=keys, **options)
        found: dict[str, Any] = json.loads(printed)
        return found


def figure(
    runs: Union[Scenario, Iterable[Scenario]],
    file: Optional[File] = None,
    *words: object,
    set: Optional[Mapping[str, object]] = None,
    **options: object,
) -> Figure:
    """Draws a run, a list of runs, or a table of ``sweep`` or ``compare``.

    The name of ``file`` ends in .svg, .pdf or .png; an existing file is replaced. Without ``file`` the figure is an SVG in memory.
    """
    drawn = [runs] if isinstance(runs, (str, os.PathLike)) or _is_table(runs) else list(runs)
    with _Words() as line:
        path = line.folder / "figure.svg" if file is None else Path(file)
        line.call("figure", *drawn, "-o", path, "--force", *_settings(set), *words, **options)
        return Figure(path.read_bytes(), None if file is None else path)


def verify(*files: Scenario, against: Optional[Scenario] = None, set: Optional[Mapping[str, object]] = None, **options: object) -> Verification:
    """Recomputes CSVs, figures and write-ups, and compares them with the files.

    With ``against``, compares rows of your own program with that scenario; ``set`` changes the scenario first.
    """
    asked = [] if against is None else ["--against", against, "--json", *_settings(set)]
    with _Words() as line:
        done = _call(line.of("verify", *files, *asked, **options))
    if done.returncode not in (0, 1) or not done.stdout:
        _checked(done)
    details = None if against is None else [json.loads(row) for row in done.stdout.splitlines()]
    return Verification(done.returncode == 0, "\n".join(filter(None, [done.stdout.strip(), done.stderr.strip()])), details)


def table(text: str) -> pandas.DataFrame:
    """A CSV of gyrolab as a DataFrame. ``attrs["header"]`` is the text of its header without the number signs."""
    import pandas

    header = [line[2:] for line in text.splitlines() if line.startswith("#")]
    # Before version 3.1, pandas rounds the last digit unless it is asked not to.
    rounds = tuple(map(int, pandas.__version__.split(".")[:2])) < (3, 1)
    exactly: dict[str, Any] = {"float_precision": "round_trip"} if rounds else {}
    rows: pandas.DataFrame = pandas.read_csv(io.StringIO(text), skiprows=len(header), **exactly)
    rows.attrs["header"] = "\n".join(header)
    return rows


class _Words:
    """The words of a command line. DataFrames become files in a folder, which is removed at the end."""

    def __enter__(self) -> _Words:
        self._temporary = tempfile.TemporaryDirectory(prefix="gyrolab-")
        self.folder = Path(self._temporary.name)
        self._files = 0
        return self

    def __exit__(self, *_: object) -> None:
        self._temporary.cleanup()

    def call(self, *words: object, **options: object) -> str:
        done = _checked(_call(self.of(*words, "--quiet", **options)))
        if done.stderr.strip():
            warnings.warn(done.stderr.strip(), GyrolabWarning, stacklevel=3)
        return done.stdout

    def of(self, *words: object, **options: object) -> list[str]:
        line = [self._word(word) for word in words]
        for name, given in options.items():
            option, value = "--" + name.rstrip("_").replace("_", "-"), _plain(given)
            if value is True:
                line.append(option)
            elif isinstance(value, Mapping):
                line += [word for key, item in value.items() for word in (option, f"{key}={_listed(item)}")]
            elif _is_many(value) and name == "kind":
                line += [option, ",".join(map(str, value))]
            elif _is_many(value):
                line += [word for item in value for word in (option, self._word(item))]
            elif value is not None and value is not False:
                line += [option, self._word(value)]
        return line

    def _word(self, value: object) -> str:
        return str(self._file(value) if _is_table(value) else _plain(value))

    def _file(self, rows: Any) -> Path:
        self._files += 1
        path = self.folder / f"DataFrame-{self._files}.csv"
        header = "".join(f"# {line}".rstrip() + "\n" for line in rows.attrs.get("header", "").splitlines())
        path.write_text(header + rows.to_csv(index=False), encoding="utf-8")
        return path


def _call(words: Iterable[object]) -> subprocess.CompletedProcess[str]:
    """Runs the program, and shows its progress if somebody watches."""
    here = Path(sysconfig.get_path("scripts"), "gyrolab")
    program = os.environ.get("GYROLAB") or (str(here) if here.exists() else "gyrolab")
    line = [program, *map(str, words)]
    with _display() as show:
        environment = {**os.environ, "GYROLAB_PROGRESS": "lines"} if show else None
        pipe = subprocess.PIPE
        with subprocess.Popen(line, stdin=subprocess.DEVNULL, stdout=pipe, stderr=pipe, env=environment) as process:
            assert process.stdout is not None and process.stderr is not None
            messages: list[str] = []
            reader = threading.Thread(target=_read, args=(process.stderr, messages, show), daemon=True)
            reader.start()
            try:
                output = process.stdout.read()
            except BaseException:  # an interrupt of the kernel too: the program then keeps the rows of a sweep
                process.send_signal(signal.SIGINT)
                process.wait()
                raise
            finally:
                reader.join()
    return subprocess.CompletedProcess(line, process.returncode, output.decode(), "".join(messages))


def _read(stream: IO[bytes], messages: list[str], show: Optional[Callable[[str], None]]) -> None:
    """Separates messages from lines of progress, which begin with a carriage return."""
    for raw in stream:
        line = raw.decode(errors="replace")
        if not line.startswith("\r"):
            messages.append(line)
        elif show:
            show(line.strip())


@contextmanager
def _display() -> Iterator[Optional[Callable[[str], None]]]:
    """A function that shows a line of progress in place of the one before; None if nobody watches."""
    shell = sys.modules["IPython"].get_ipython() if "IPython" in sys.modules else None
    if progress is False or not (progress or hasattr(shell, "kernel") or sys.stderr.isatty()):
        yield None
    elif hasattr(shell, "kernel"):
        shown: list[Any] = []

        def show(text: str) -> None:
            data = {"text/plain": text}
            if shown:
                shown[0].update(data, raw=True)
            elif text:
                shown.append(sys.modules["IPython"].display.display(data, raw=True, display_id=True))

        yield show
    else:
        yield lambda text: print(f"\r\x1b[K{text}", end="", file=sys.stderr, flush=True)


def _checked(done: subprocess.CompletedProcess[str]) -> subprocess.CompletedProcess[str]:
    if done.returncode:
        raise RuntimeError(done.stderr.strip() or f"gyrolab ended with exit code {done.returncode}")
    return done


def _settings(values: Optional[Mapping[str, object]]) -> list[str]:
    return [word for key, value in (values or {}).items() for word in ("--set", f"{key}={_toml(value)}")]


def _listed(values: object) -> str:
    """The values of a key that varies, as an option has them."""
    values = _plain(values)
    if isinstance(values, str):
        return values
    return ",".join(map(_toml, values)) if _is_many(values) else _toml(values)


def _plain(value: object) -> object:
    """The Python value of a NumPy scalar, an array or a Series; any other value as it is."""
    to_list = getattr(value, "tolist", None)
    return to_list() if callable(to_list) else value


def _toml(value: object) -> str:
    value = _plain(value)
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, int):
        return str(value)
    if isinstance(value, SupportsFloat):
        return repr(float(value))
    if isinstance(value, Mapping):
        return "{" + ", ".join(f"{json.dumps(key)} = {_toml(item)}" for key, item in value.items()) + "}"
    if _is_many(value):
        return "[" + ", ".join(map(_toml, value)) + "]"
    return json.dumps(str(value), ensure_ascii=False)


def _is_many(value: object) -> TypeGuard[Iterable[object]]:
    return isinstance(value, Iterable) and not isinstance(value, (str, Mapping)) and not _is_table(value)


def _is_table(value: object) -> bool:
    return hasattr(value, "to_csv") and hasattr(value, "columns")


def _need_pandas() -> None:
    try:
        import pandas  # noqa: F401
    except ImportError as error:
        raise ImportError("gyrolab returns tables as pandas.DataFrame: pip install pandas") from error
