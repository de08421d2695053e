"""Recordings: reading them, and the commands that make something of them."""

from __future__ import annotations

import csv
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


@dataclass(frozen=True)
class Frame:
    """A picture of a recording."""

    segment: int
    """The segment, from 1."""
    number: int
    """Its number in the segment."""
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
        lines = [json.loads(line) for line in text.splitlines() if line.endswith("}")]
        if not lines or "format" not in lines[0]:
            raise _tabletop.Error(f"{self.folder}: no recording: its session log has no header")
        self.header: dict[str, Any] = lines[0]
        """The first line of the session log: format, settings, scene."""

    def frames(self) -> Iterator[Frame]:
        """The pictures, in order."""
        start, per_frame = self.header["start_tick"], self.header["ticks_per_frame"]
        count = 0
        for segment in range(1, 1 << 31):
            if not (self.folder / f"{segment}.txt").is_file():
                return
            pictures = self.folder / str(segment)
            numbers = sorted(int(it.stem) for it in pictures.glob("*.png") if it.stem.isdigit())
            for number in numbers:
                yield Frame(segment, number, start + count * per_frame, pictures / f"{number}.png")
                count += 1

    def events(self) -> list[tuple[int, list[str]]]:
        """The lines of the event logs, each as its segment and its fields."""
        events = []
        for segment in range(1, 1 << 31):
            try:
                text = (self.folder / f"{segment}.txt").read_text(encoding="utf-8")
            except OSError:
                return events
            events += [(segment, line.split()) for line in text.splitlines() if line.strip()]
        return events

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
    report = _run("imitate", *options, codes=(0, 1))
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
    try:
        with open(path, newline="", encoding="utf-8") as file:
            names, *rows = csv.reader(file)
    except (OSError, ValueError) as error:
        raise _tabletop.Error(f"{path}: it cannot be read: {error}") from None
    columns = {}
    for name, column in zip(names, zip(*rows) if rows else [()] * len(names)):
        try:
            columns[name] = np.array([float(it) for it in column])
        except ValueError:
            columns[name] = list(column)
    return columns

