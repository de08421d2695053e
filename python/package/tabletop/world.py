"""Worlds."""

from __future__ import annotations

import json
import os
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from . import _tabletop

Vector = Iterable[float]
Path = str | os.PathLike[str]


@dataclass(frozen=True)
class Objects:
    """The objects on the table, a row each, in the order in which they came."""

    id: list[str]
    """Their ids."""
    location: np.ndarray
    """N x 3, of their origins, in units."""
    rotation: np.ndarray
    """N x 4, quaternions x, y, z, w."""
    velocity: np.ndarray
    """N x 3, of their centres of mass, in units/s."""
    angular_velocity: np.ndarray
    """N x 3, in rad/s."""
    color: np.ndarray
    """N x 3, red, green and blue from 0 to 1: of the first of the solids that an object is made of."""
    mass: np.ndarray
    """N, in kg."""
    is_fixed: np.ndarray
    """N, whether each is fixed to the world."""

    def __len__(self) -> int:
        return len(self.id)

    def row(self, id: str) -> int:
        """The row of an object.

        Raises KeyError if there is none of this id.
        """
        try:
            return self.id.index(id)
        except ValueError:
            raise KeyError(f"there is no object {id}, only {', '.join(self.id) or 'none'}") from None


@dataclass(frozen=True)
class Limb:
    """The state of a limb of the robot."""

    name: str
    """Its name: `left`, `right`."""
    joints: list[str]
    """The names of its joints, from the base to the tip."""
    gripper: str
    """The name of the joint that is its gripper's opening."""
    location: np.ndarray
    """3, of the point midway between the fingers, in units."""
    rotation: np.ndarray
    """4, quaternion x, y, z, w of the end effector: its x along the opening, its -z where the fingers point."""
    holds: list[str]
    """The ids of the objects that the gripper holds."""
    blocked_by: str | None
    """What stops the arm: an object's id, `table` or a part of the robot."""
    is_moving: bool
    """Whether it is on its way to a commanded position."""


@dataclass(frozen=True)
class Contact:
    """A contact of the robot with a thing."""

    body: str
    """The link, or the finger."""
    thing: str
    """The id of the object, or `table`."""
    point: np.ndarray
    """3, the place on the thing's surface, in units."""
    impulse: float
    """Of the last tick along the normals, in kg units/s."""


class Robot:
    """The robot of a world."""

    def __init__(self, world: _tabletop.World):
        self._world = world

    @property
    def name(self) -> str:
        """Its name."""
        return self._world.robot_name

    @property
    def is_shown(self) -> bool:
        """Whether it stands at the table."""
        return self._world.robot_is_shown

    @property
    def joints(self) -> dict[str, float]:
        """The positions of all joints by their names, in rad; of the openings of grippers in units."""
        joints = self._world.joints()
        return dict(zip(joints["name"], joints["position"].tolist()))

    @property
    def joint_names(self) -> list[str]:
        """The names of all joints, in the order of the arrays."""
        return self._world.joints()["name"]

    @property
    def positions(self) -> np.ndarray:
        """J, the positions of all joints, in rad and units."""
        return self._world.joints()["position"]

    @property
    def velocities(self) -> np.ndarray:
        """J, in rad/s and units/s."""
        return self._world.joints()["velocity"]

    @property
    def torques(self) -> np.ndarray:
        """J, in N m; 0 in kinematic mode."""
        return self._world.joints()["torque"]

    @property
    def limits(self) -> np.ndarray:
        """J x 2, the least and greatest positions."""
        joints = self._world.joints()
        return np.stack([joints["low"], joints["high"]], axis=1)

    @property
    def limbs(self) -> dict[str, Limb]:
        """The limbs by their names."""
        limbs = {}
        for row in self._world.limbs():
            location, rotation = row.pop("end_effector")
            limbs[row["name"]] = Limb(location=np.array(location), rotation=np.array(rotation), **row)
        return limbs

    def fk(self, limb: str, angles: Vector) -> tuple[np.ndarray, np.ndarray]:
        """The location (3) and rotation (4) of a limb's end effector at these angles of its joints, in rad."""
        location, rotation = self._world.fk(limb, np.ascontiguousarray(angles, dtype=np.float64))
        return np.array(location), np.array(rotation)

    def ik(self, limb: str, location: Vector, rotation: Vector = (0, 0, 0, 1)) -> np.ndarray:
        """Angles of a limb's joints, in rad, that bring its end effector to a pose, near its present ones.

        With the default rotation its fingers point down and open along X. Raises `Error` if it cannot get there.
        """
        return self._world.ik(limb, _numbers(location, 3), _numbers(rotation, 4))

    def reach(self, limb: str, location: Vector, rotation: Vector = (0, 0, 0, 1)) -> None:
        """Sends a limb's end effector to a pose at 1 rad/s; `World.wait_until_still` waits for it.

        Raises `Error` if it cannot get there.
        """
        angles = self.ik(limb, location, rotation)
        self.drive(dict(zip(self.limbs[limb].joints, angles.tolist())), "toward")

    def drive(self, joints: Mapping[str, float], how: str = "velocity") -> None:
        """Gives joints orders in the next tick.

        `how` is `velocity` (rad/s, for one tick), `toward` (a position, approached at 1 rad/s over as many ticks as it takes),
        `position` (at once) or `torque` (N m, for one tick, in dynamic mode).
        """
        self._world.drive([(name, float(value)) for name, value in joints.items()], how)

    def __repr__(self) -> str:
        limbs = ", ".join(
            f"{limb.name} at ({', '.join(f'{it:.2f}' for it in limb.location)})"
            + (f" holds {', '.join(limb.holds)}" if limb.holds else "")
            for limb in self.limbs.values()
        )
        return f"<tabletop.Robot {self.name}{'' if self.is_shown else ', hidden'}: {limbs}>"


class Picture(np.ndarray):
    """A picture, rows x columns x 3, which notebooks show."""

    def _repr_png_(self) -> bytes | None:
        return encode_png(self) if self.ndim == 3 and self.dtype == np.uint8 else None


class World:
    """A world: a table, objects on it, hands, and a robot.

    It begins with a task file (`setup`), with the table after a scenario, with the first tick of a recording, or with an empty
    table. Files that are not there are those that come with the program. Time passes only in `step` and in the methods that
    command something, each of which takes the ticks that it takes in a scenario.

    robot: a `robot.ron` or a URDF; without it Baxter.
    dynamic: motors with limited torque move the arms.
    show_robot: the robot stands at the table from the start.
    seed: of random places and presets.
    allow_paths: folders whose files task files and scenarios may name.

    Raises `Error` in the words of the command line.
    """

    def __init__(
        self,
        setup: Path | None = None,
        *,
        scenario: Path | None = None,
        recording: Path | None = None,
        robot: Path | None = None,
        dynamic: bool = False,
        show_robot: bool = True,
        seed: int = 0,
        allow_paths: Iterable[Path] = (),
    ):
        self._world = _tabletop.World(
            setup=setup,
            scenario=scenario,
            recording=recording,
            robot=robot,
            dynamic=dynamic,
            show_robot=show_robot,
            seed=seed,
            allow_paths=list(allow_paths),
        )
        self._origin = setup or scenario or recording or "an empty table"

    # Time

    def step(self, ticks: int = 1) -> None:
        """Simulates this many ticks of 1/60 s."""
        self._world.step(ticks)

    @property
    def tick(self) -> int:
        """The number of ticks so far."""
        return self._world.tick

    @property
    def time(self) -> float:
        """The simulated time so far, in s."""
        return self._world.tick / 60

    # Commands

    def command(self, *steps: str) -> None:
        """Performs steps of a scenario, as they stand in its file: `world.command('Grasp("Red")', "MoveBy((0, 0, 1))")`.

        Raises `Error` with the step that failed; those before it were done.
        """
        self._world.perform(", ".join(steps))

    def _by_hand(self, step: str, hand: str | None) -> None:
        self.command(step if hand is None else f"With({hand.capitalize()}, {step})")

    def load(self, file: Path) -> None:
        """Clears the table and puts on it what a task file says."""
        self.command(f"Load(file: {_text(os.fspath(file))})")

    def clear(self) -> None:
        """Removes every object that no hand holds."""
        self.command("Clear")

    def make(self, preset: str) -> None:
        """Makes a preset at a random free place: `BigBlock`, `Stack(5)`, `BoxContainer`."""
        self.command(f"Make({preset})")

    def select(self, hand: str) -> None:
        """Selects the hand that acts where none is named: `left`, `right`, `both` or `any`."""
        self.command(f"Select({hand.capitalize()})")

    def grasp(self, id: str, hand: str | None = None) -> None:
        """Takes an object into a hand."""
        self._by_hand(f"Grasp({_text(id)})", hand)

    def move_to(self, location: Vector, hand: str | None = None) -> None:
        """Moves the held object at a hand's full speed; it is on its way when this returns."""
        self._by_hand(f"MoveTo({_vector(location)})", hand)

    def move_by(self, offset: Vector, hand: str | None = None) -> None:
        """Moves the held object by a vector; it is on its way when this returns."""
        self._by_hand(f"MoveBy({_vector(offset)})", hand)

    def glide(self, to: Vector, seconds: float = 1.0, hand: str | None = None) -> None:
        """Moves the held object evenly to a location in this time."""
        self._by_hand(f"Glide(to: {_vector(to)}, seconds: {float(seconds)!r})", hand)

    def turn(self, axis: str, degrees: float, hand: str | None = None) -> None:
        """Turns the held object about an axis of the world, `X`, `Y` or `Z`, through its origin."""
        self._by_hand(f"Turn(axis: {axis.upper()}, degrees: {float(degrees)!r})", hand)

    def release(self, hand: str | None = None) -> None:
        """Lets go of the held object."""
        self._by_hand("Release", hand)

    def destroy(self, hand: str | None = None) -> None:
        """Removes the held object from the world."""
        self._by_hand("Destroy", hand)

    def cut(self, blade: str, hand: str | None = None) -> None:
        """Closes the scissors with this blade."""
        self._by_hand(f"Cut({_text(blade)})", hand)

    def trigger(self, control: str, part: int | None = None, hand: str | None = None) -> None:
        """Operates a control, or touches the simple shape of this number of it."""
        step = f"Trigger({_text(control)})" if part is None else f"TriggerPart({_text(control)}, {part})"
        self._by_hand(step, hand)

    def point_to(self, id: str, hand: str | None = None) -> None:
        """Points to an object or a part of one."""
        self._by_hand(f"PointTo({_text(id)})", hand)

    def fasten(self, guest: str, hand: str | None = None) -> None:
        """Fastens an object, or its guest point, by a step."""
        self._by_hand(f"Fasten({_text(guest)})", hand)

    def loosen(self, guest: str, hand: str | None = None) -> None:
        """Loosens an object, or its guest point, by a step."""
        self._by_hand(f"Loosen({_text(guest)})", hand)

    def wait(self, seconds: float) -> None:
        """Waits."""
        self.command(f"Wait({float(seconds)!r})")

    def wait_until_rest(self, seconds: float = 10.0) -> None:
        """Waits until nothing moves for half a second; raises `Error` if that takes longer than this."""
        self.command(f"WaitUntilRest({float(seconds)!r})")

    def wait_until_there(self, seconds: float = 10.0, hand: str | None = None) -> None:
        """Waits until the held object has arrived, or something is in its way."""
        self._by_hand(f"WaitUntilThere({float(seconds)!r})", hand)

    def wait_until_still(self, seconds: float = 10.0) -> None:
        """Waits until nothing of the robot has moved for a quarter of a second."""
        self.command(f"Robot(WaitUntilStill({float(seconds)!r}))")

    def expect(self, check: str) -> None:
        """Raises `Error` unless a check holds now: `world.expect('OnTopOf(object: "Red", of: "Green")')`."""
        self.command(f"Expect({check})")

    def holds(self, check: str) -> bool:
        """Whether a check holds now."""
        try:
            self.expect(check)
        except _tabletop.Error:
            return False
        return True

    def undo(self) -> None:
        """Takes back the last segment of the recording."""
        self.command("Undo")

    def redo(self) -> None:
        """Brings back the segment that was undone last."""
        self.command("Redo")

    def pause(self, paused: bool = True) -> None:
        """Stops the simulation, or lets it run on."""
        self.command(f"Pause({'true' if paused else 'false'})")

    # The robot

    @property
    def robot(self) -> Robot:
        """The robot."""
        return Robot(self._world)

    def show_robot(self, shown: bool = True) -> None:
        """Puts the robot at the table, or takes it away."""
        self.command("Robot(Show)" if shown else "Robot(Hide)")

    def robot_home(self) -> None:
        """Sends all joints to their home positions."""
        self.command("Robot(Home)")

    def open_gripper(self, limb: str) -> None:
        """Opens a gripper, which releases its objects."""
        self.command(f"Robot(Open({_name(limb)}))")

    def close_gripper(self, limb: str) -> None:
        """Closes a gripper until it holds or meets something."""
        self.command(f"Robot(Close({_name(limb)}))")

    def show_face(self, face: str) -> None:
        """Shows a face: `neutral`, `happy`, `surprised`, `asleep` or `blank`."""
        self.command(f"Robot(Face({face.capitalize()}))")

    # What there is

    @property
    def objects(self) -> Objects:
        """The objects on the table, as arrays."""
        return Objects(**self._world.objects())

    @property
    def contacts(self) -> list[Contact]:
        """The contacts of the robot."""
        contacts = self._world.contacts()
        return [Contact(body, thing, np.array(point), impulse) for body, thing, point, impulse in contacts]

    def facts(self) -> list[dict[str, Any]]:
        """The events since the last call, each as its kind (`Hand`, `Robot`, ...), its name and its fields."""
        events = []
        for fact in json.loads(self._world.facts()):
            (kind, event), = fact.items()
            if kind == "Refused":
                events.append({"kind": kind, "fact": kind, **event})
            else:
                (name, fields), = event.items()
                events.append({"kind": kind, "fact": name, **fields})
        return events

    # Pictures

    def picture(self, camera: str = "head", size: tuple[int, int] = (200, 150), smooth: bool = True) -> Picture:
        """What a camera sees: rows x columns x 3 numbers from 0 to 255. `size` is columns x rows.

        The cameras are `head`, `left_hand`, `right_hand`, and any other by its place and the point that it looks at:
        `above=0,-8,12` or `above=0,-8,12,0,0,1`.
        """
        return self._world.shoot(camera, size, smooth)[0].view(Picture)

    def depth(self, camera: str = "head", size: tuple[int, int] = (200, 150)) -> np.ndarray:
        """The distance ahead of the camera of what each pixel shows: rows x columns, in units; infinite where nothing is."""
        return self._world.shoot(camera, size)[1]

    def ids(self, camera: str = "head", size: tuple[int, int] = (200, 150)) -> tuple[np.ndarray, list[str]]:
        """What each pixel shows: rows x columns numbers, and the names of 1, 2, ...: `table`, ids, `robot`. 0 is nothing."""
        _, _, numbers, names = self._world.shoot(camera, size)
        return numbers, names

    # Moments, recordings, files

    def snapshot(self) -> _tabletop.Snapshot:
        """The present moment of this world, exactly, but for files."""
        return self._world.snapshot()

    def restore(self, snapshot: _tabletop.Snapshot) -> None:
        """Returns to a moment of this world, bit for bit."""
        self._world.restore(snapshot)

    def start_recording(self, folder: Path) -> None:
        """Begins a recording in a folder. An earlier recording there is moved aside; a folder with anything else is refused."""
        self._world.record_into(folder)
        self.command("Start")

    def finish_recording(self) -> int:
        """Ends the recording, if one runs. Returns the number of recordings so far.

        Raises `Error` if it could not be written.
        """
        return self._world.finish_recording()

    def record(self, folder: Path) -> _Recorded:
        """Records what is done in a `with` block: `with world.record("demo"): ...`."""
        return _Recorded(self, folder)

    def save(self, file: Path) -> list[str]:
        """Saves the table as a task file. Returns what a task file cannot express."""
        return self._world.save(file)

    def __repr__(self) -> str:
        objects = self._world.objects()["id"]
        some = ", ".join(objects[:5]) + (", ..." if len(objects) > 5 else "")
        return f"<tabletop.World of {os.fspath(self._origin)}, {self.time:.2f} s: {len(objects)} objects ({some})>"

    def _repr_png_(self) -> bytes:
        return encode_png(self.picture(size=(400, 300)))


class _Recorded:
    def __init__(self, world: World, folder: Path):
        self._world = world
        self._folder = folder

    def __enter__(self) -> World:
        self._world.start_recording(self._folder)
        return self._world

    def __exit__(self, *_) -> None:
        self._world.finish_recording()


def _numbers(vector: Vector, length: int) -> list[float]:
    numbers = [float(it) for it in vector]
    if len(numbers) != length:
        raise _tabletop.Error(f"expected {length} numbers, found {len(numbers)}")
    return numbers


def _vector(vector: Vector) -> str:
    return "({}, {}, {})".format(*(repr(it) for it in _numbers(vector, 3)))


def _text(text: str) -> str:
    return json.dumps(text, ensure_ascii=False)


def _name(name: str) -> str:
    return "".join(word.capitalize() for word in name.split("_"))


def encode_png(picture: np.ndarray) -> bytes:
    """A picture, rows x columns x 3 numbers from 0 to 255, as the bytes of a PNG file."""
    import struct
    import zlib

    rows, columns, _ = picture.shape
    lines = np.concatenate([np.zeros((rows, 1), np.uint8), picture.reshape(rows, -1)], axis=1)

    def chunk(kind: bytes, content: bytes) -> bytes:
        return struct.pack(">I", len(content)) + kind + content + struct.pack(">I", zlib.crc32(kind + content))

    header = struct.pack(">IIBBBBB", columns, rows, 8, 2, 0, 0, 0)
    parts = (b"IHDR", header), (b"IDAT", zlib.compress(lines.tobytes())), (b"IEND", b"")
    return b"\x89PNG\r\n\x1a\n" + b"".join(chunk(*part) for part in parts)
