"""Recordings: reading them, and the commands that make something of them."""

from __future__ import annotations

import csv
import io
import itertools
import json
import os
import re
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from . import _tabletop

Progress = Callable[[int, int], None]
"""Is told how many are done, and how many are to be done."""

_TEXTS = ("id", "joint")
"""The columns of a recording's tables that hold no numbers."""


@dataclass(frozen=True)
class Frame:
    """A picture of a recording."""

    segment: int
    """The segment, from 0."""
    number: int
    """Its number in the recording, from 0; those that show nothing new are left out."""
    tick: int
    """The tick at whose end it was taken."""
    path: Path
    """The PNG file."""

    def picture(self) -> np.ndarray:
        """Rows x columns x 3 numbers from 0 to 255."""
        return _tabletop.read_png(self.path)


class Recording:
    """A recording in a folder.

    Raises `Error` if there is none.
    """

    def __init__(self, folder: str | os.PathLike[str]):
        self.folder = Path(folder)
        try:
            text = (self.folder / "session.jsonl").read_text(encoding="utf-8")
        except OSError as error:
            raise _tabletop.Error(f"{self.folder}: no recording: {error}") from None
        try:
            header = json.loads(text.split("\n", 1)[0])
        except ValueError:
            header = None
        if not isinstance(header, dict) or "format" not in header:
            raise _tabletop.Error(f"{self.folder}: no recording: its session log has no header")
        self.header: dict[str, Any] = header
        """The first line of the session log: format, settings, scene."""

    def frames(self) -> Iterator[Frame]:
        """The pictures, in order.

        Raises `Error` if a file was changed or is damaged.
        """
        for segment, number, tick, path in _tabletop.recorded_frames(self.folder):
            yield Frame(segment, number, tick, Path(path))

    def events(self) -> list[tuple[int, list[str]]]:
        """The lines of the event logs, each as its segment, from 0, and its values: frame, event, and what belongs to it."""
        events = []
        for segment in itertools.count():
            path = self.folder / f"{segment}.txt"
            if not path.is_file():
                return events
            events += [(segment, values) for values in _rows(path)]

    def states(self) -> dict[str, np.ndarray | list[str]]:
        """The poses and velocities of objects: the columns of states.csv as arrays, with a row for each object and tick of a change."""
        return _columns(self.folder / "states.csv")

    def joints(self) -> dict[str, np.ndarray | list[str]]:
        """The positions of the robot's joints: the columns of joints.csv as arrays, with a row for each joint and tick of a change."""
        return _columns(self.folder / "joints.csv")

    @property
    def task(self) -> dict[str, Any]:
        """The task that it shows, as `explain` says it."""
        return explain(self.folder)

    def __repr__(self) -> str:
        return f"<tabletop.Recording {self.folder}>"


def explain(recording: str | os.PathLike[str]) -> dict[str, Any]:
    """The task that a recording shows: its `task` with `steps`, `roles`, ..., and the `requirements`.

    Raises `Error` if the recording cannot be read.
    """
    return json.loads(_run("explain", recording, "--json"))


def teach(*recordings: str | os.PathLike[str]) -> dict[str, Any]:
    """The program that demonstrations mean: its `sentences` and its `program`, the `alternatives`, and what was `untouched`.

    Raises `Error` if a recording cannot be read, or no program explains them all.
    """
    return json.loads(_run("teach", *recordings, "--json"))


@dataclass(frozen=True)
class Imitations:
    """How often the robot has done a task."""

    done: int
    """The number of trials in which it was done."""
    trials: int
    """The number of trials."""
    report: str
    """What the command line says of them."""


def imitate(
    recording: str | os.PathLike[str],
    *,
    setup: str | os.PathLike[str] | None = None,
    seed: int | None = None,
    trials: int = 1,
    robot: str | os.PathLike[str] | None = None,
    dynamic: bool = False,
    record: str | os.PathLike[str] | None = None,
) -> Imitations:
    """Lets the robot do the task of a recording; with several trials, with everything at random places of the seeds from `seed` on.

    Raises `Error` if the recording cannot be read, or nothing can be tried.
    """
    options: list[Any] = [recording]
    for name, value in ("--setup", setup), ("--seed", seed), ("--robot", robot), ("--record", record):
        if value is not None:
            options += [name, value]
    if trials != 1:
        options += ["--trials", trials]
    if dynamic:
        options.append("--dynamic")
    return _tallied(_run("imitate", *options, codes=(0, 1)))


def tell(
    sentences: str,
    *,
    setup: str | os.PathLike[str] | None = None,
    imitate: bool = False,
    seed: int | None = None,
    trials: int = 1,
    record: str | os.PathLike[str] | None = None,
) -> Imitations:
    """Does what sentences say, by the hand or, with `imitate`, by the robot; with several trials, with everything at random places.

    Raises `Error` if the sentences are not understood.
    """
    options: list[Any] = [sentences]
    for name, value in ("--setup", setup), ("--seed", seed), ("--record", record):
        if value is not None:
            options += [name, value]
    if trials != 1:
        options += ["--trials", trials]
    if imitate:
        options.append("--imitate")
    return _tallied(_run("tell", *options, codes=(0, 1)))


def _tallied(report: str) -> Imitations:
    tally = re.search(r"^done +(\d+) of (\d+)", report, re.MULTILINE)
    if tally:
        return Imitations(int(tally[1]), int(tally[2]), report)
    return Imitations(int(report.startswith("Done")), 1, report)


def multiply(
    recording: str | os.PathLike[str],
    out: str | os.PathLike[str],
    *,
    count: int = 100,
    seed: int = 0,
    jobs: int | None = None,
    progress: Progress | None = None,
    **options: Any,
) -> list[Path]:
    """Makes many demonstrations of one, with everything elsewhere; returns their folders. Those that are there are kept.

    `options` are the other options of the command line: `colors=True`, `sizes=0.2`, `distractors=3`, `robot=FILE`.
    Raises `Error` if some could not be made.
    """
    arguments: list[Any] = [recording, "--out", out, "--count", count, "--seed", seed]
    if jobs is not None:
        arguments += ["--jobs", jobs]
    for name, value in options.items():
        if value is True:
            arguments.append(f"--{name.replace('_', '-')}")
        elif value is not False and value is not None:
            arguments += [f"--{name.replace('_', '-')}", value]

    def made() -> list[Path]:
        folders = (Path(out) / f"{number:04}" for number in range(count))
        return [folder for folder in folders if folder.is_dir()]

    _run("multiply", *arguments, while_waiting=(lambda: progress(len(made()), count)) if progress else None)
    return made()


def _run(command: str, *arguments: Any, codes=(0,), while_waiting: Callable[[], None] | None = None) -> str:
    """Runs a command of the command line in a process of its own; returns what it prints."""
    line = [sys.executable, "-m", "tabletop", command, *(os.fspath(it) if isinstance(it, os.PathLike) else str(it) for it in arguments)]
    with subprocess.Popen(line, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True) as process:
        try:
            if while_waiting:
                while process.poll() is None:
                    while_waiting()
                    time.sleep(0.2)
                while_waiting()
            out, err = process.communicate()
        except BaseException:
            process.kill()
            raise
    if process.returncode not in codes:
        raise _tabletop.Error((err or out).strip().removeprefix("tabletop: "))
    return out


def _columns(path: Path) -> dict[str, np.ndarray | list[str]]:
    names, *rows = _rows(path) or [[]]
    columns: dict[str, np.ndarray | list[str]] = {}
    try:
        for number, name in enumerate(names):
            column = [row[number] for row in rows]
            columns[name] = column if name in _TEXTS else np.array([float(it) for it in column])
    except (IndexError, ValueError) as error:
        raise _tabletop.Error(f"{path}: column {name}: {error}; the file was changed, or is damaged") from None
    return columns


def _rows(path: Path) -> list[list[str]]:
    """The values of the lines of a file; a last line without line end does not count."""
    try:
        text = path.read_bytes().decode()
        return list(csv.reader(io.StringIO(text[: text.rfind("\n") + 1], newline=""), strict=True))
    except (OSError, ValueError, csv.Error) as error:
        raise _tabletop.Error(f"{path}: it cannot be read: {error}") from None

