"""The Python side of the tabletop simulator's script bridge.

The simulator runs this file and tells it which script of yours to use. Your script is a Python file with two functions:

    def init(aux): ...                       # called once
    def callback(sensor, motor, aux): ...    # called in every tick of the simulation, 60 times a second

The arguments are objects with the fields of the Matlab interface. Rows are left, right; joints are S0, S1, E0, E1, W0, W1,
W2; lengths are in units of 10 cm, angles in rad.

    sensor.timeElapsed       simulation time since the last call, in s
    sensor.jointAngles       2x7
    sensor.endEffPos         2x3
    sensor.gripperOpening    1x2
    sensor.rgbVision         only if there is a fresh picture: rows x columns x 3, from 0 to 1; hasattr() tells
    sensor.trackerLoc        points on the arms: a dictionary from names to [x, y, z]
    sensor.demoCue           whether a demonstration is going on
    sensor.headAngle         of the neck, positive to the robot's left
    sensor.objects, sensor.contacts, sensor.held
                             see docs/scripts.md; only if a file beside your script mentions one of them
    motor.jointVelocities    2x7, in rad/s; kept from call to call, like all of motor
    motor.gripperVelocities  2x1; [left, right] will do, in units/s
    motor.jointAngles        2x7, optional: angles that are taken at once
    motor.headVelocity       optional, in rad/s
    aux.path                 the folder of your script, with a slash
    aux.numLimbs, aux.numJoints, aux.minJointAngles, aux.maxJointAngles
    aux.initJointAngles      2x7, optional, set by init
    aux.drawMarkers          Nx3, optional, set by init: where markers are shown
    aux.exit                 set it, to anything, and the script is done

With numpy, matrices are its arrays. Without, they are lists of rows, and a picture is a Picture.

docs/script-protocol.md describes what goes on below. Python 3.8 and later; nothing else is needed.
"""

import importlib.util
import os
import struct
import sys
import traceback
from types import SimpleNamespace

try:
    import numpy
except ImportError:
    numpy = None

MAGIC, VERSION = 0x31415454, 1
DOUBLE, BYTES, TEXT, LOGICAL, PICTURE, MAP, TEXTS, OTHER = range(8)
VELOCITIES = {"jointVelocities": (2, 7), "gripperVelocities": (2, 1)}


class Picture:
    """A picture where there is no numpy: picture[row, column] is (red, green, blue), each from 0 to 1."""

    def __init__(self, shape, data):
        self.shape = shape
        self._data = data

    def __getitem__(self, place):
        row, column = place
        height, width, _ = self.shape
        if not (-height <= row < height and -width <= column < width):
            raise IndexError("row %d, column %d of a picture of %dx%d" % (row, column, height, width))
        first = column % width * height + row % height
        return tuple(self._data[first + colour * height * width] / 255 for colour in range(3))


def decode(data):
    """Named arrays as a dictionary."""
    magic, version, count, names = struct.unpack_from("<4I", data)
    if (magic, version) != (MAGIC, VERSION):
        raise ValueError("the simulator speaks another version of the protocol")
    start = 16 + 48 * count
    first = -(-(start + names) // 8) * 8
    arrays = {}
    for place in range(count):
        code, name, size, dims, *extents = struct.unpack_from("<12I", data, 16 + 48 * place)
        key = data[start:start + name].decode("ascii")
        arrays[key] = _value(code, tuple(extents[:dims]), data[first:first + size])
        start += name
        first += -(-size // 8) * 8
    return arrays


def _value(code, dims, data):
    count = 1
    for dim in dims:
        count *= dim
    if code == DOUBLE:
        return _matrix(struct.unpack("<%dd" % count, data), dims)
    if code == BYTES:
        return _matrix(data, dims)
    if code == TEXT:
        return data.decode("utf-8", "replace")
    if code == LOGICAL:
        flags = [byte != 0 for byte in data]
        return flags[0] if count == 1 else _matrix(flags, dims)
    if code == PICTURE:
        if numpy is None:
            return Picture(dims, data)
        return numpy.frombuffer(data, numpy.uint8).reshape(dims, order="F") / 255
    if code == MAP:
        names = _texts(count, data[24 * count:])
        return {name: list(struct.unpack_from("<3d", data, 24 * place)) for place, name in enumerate(names)}
    if code == TEXTS:
        return _texts(count, data)
    raise ValueError("class %d is unknown" % code)


def _texts(count, data):
    lengths = struct.unpack_from("<%dI" % count, data)
    texts, first = [], 4 * count
    for length in lengths:
        texts.append(data[first:first + length].decode("utf-8", "replace"))
        first += length
    return texts


def _matrix(values, dims):
    if len(values) == 1:
        return values[0]
    if numpy is not None:
        return numpy.array(values).reshape(dims, order="F")
    rows = dims[0]
    return [list(values[row::rows]) for row in range(rows)]


def encode(arrays):
    """The bytes of a dictionary of named arrays."""
    records, names, payloads = b"", b"", b""
    for key, value in arrays.items():
        code, dims, data = _elements(value)
        name = key.encode("ascii", "replace")
        records += struct.pack("<12I", code, len(name), len(data), len(dims), *dims, *[0] * (8 - len(dims)))
        names += name
        payloads += data + bytes(-len(data) % 8)
    start = struct.pack("<4I", MAGIC, VERSION, len(arrays), len(names)) + records + names
    return start + bytes(-len(start) % 8) + payloads


def _elements(value):
    if isinstance(value, str):
        return TEXT, (1, len(value)), value.encode("utf-8", "replace")
    if isinstance(value, bool):
        return LOGICAL, (1, 1), bytes([value])
    if hasattr(value, "tolist"):
        value = value.tolist()
    if isinstance(value, (int, float)):
        return DOUBLE, (1, 1), struct.pack("<d", value)
    try:
        rows = [list(row) if hasattr(row, "__iter__") else [row] for row in value]
        columns = max((len(row) for row in rows), default=0)
        numbers = [float(row[column]) for column in range(columns) for row in rows]
        if any(len(row) != columns for row in rows):
            raise ValueError
    except (TypeError, ValueError, IndexError):
        return OTHER, (1, 1), type(value).__name__.encode("utf-8", "replace")
    return DOUBLE, (len(rows), columns), struct.pack("<%dd" % len(numbers), *numbers)


def _zeros(rows, columns):
    if numpy is not None:
        return numpy.zeros((rows, columns))
    return [[0.0] * columns for _ in range(rows)]


def _structs(arrays):
    """Names with dots as nested objects."""
    root = SimpleNamespace()
    for name, value in arrays.items():
        *path, last = name.split(".")
        place = root
        for part in path:
            if not hasattr(place, part):
                setattr(place, part, SimpleNamespace())
            place = getattr(place, part)
        setattr(place, last, value)
    return root


def _load(file):
    sys.path.insert(0, os.path.dirname(file))
    spec = importlib.util.spec_from_file_location("agent", file)
    if spec is None or not os.path.isfile(file):
        raise FileNotFoundError("there is no Python script " + file)
    module = importlib.util.module_from_spec(spec)
    sys.modules["agent"] = module
    spec.loader.exec_module(module)
    return module


def _where(error):
    """The script's part of the traceback, innermost first, one "line file" a line."""
    frames = [(frame.lineno, frame.filename) for frame in traceback.extract_tb(error.__traceback__)]
    frames = [frame for frame in frames if frame[1] != __file__ and not frame[1].startswith("<frozen")]
    if isinstance(error, SyntaxError) and error.filename:
        frames.append((error.lineno or 0, error.filename))
    return "".join("%d %s\n" % frame for frame in reversed(frames))


class _Agent:
    """The script, with what it has to do with the simulator."""

    def __init__(self, folder):
        self.folder = folder

    def run(self, op):
        return {"hello": self.hello, "init": self.init, "step": self.step}[op]()

    def request(self):
        with open(os.path.join(self.folder, "request.bin"), "rb") as file:
            return _structs(decode(file.read()))

    def hello(self):
        return {"engine": "Python " + sys.version.split()[0]}

    def init(self):
        request = self.request()
        self.aux = request.aux
        self.module = _load(request.agent.folder)
        self.module.init(self.aux)
        self.motor = SimpleNamespace(**{name: _zeros(*size) for name, size in VELOCITIES.items()})
        wanted = ("drawMarkers", "initJointAngles", "exit")
        return {"aux." + name: value for name, value in vars(self.aux).items() if name in wanted}

    def step(self):
        self.module.callback(self.request().sensor, self.motor, self.aux)
        reply = {"motor." + name: value for name, value in vars(self.motor).items()}
        if hasattr(self.aux, "exit"):
            reply["aux.exit"] = 1
        return reply


def main(folder):
    """Serves the simulator until it closes the standard input."""
    commands, sys.stdin = sys.stdin, open(os.devnull)
    agent = _Agent(folder)
    for line in commands:
        op, seq = line.split()
        try:
            reply = agent.run(op)
        except Exception as error:
            message = "".join(traceback.format_exception_only(type(error), error)).strip()
            reply = {"error.id": type(error).__name__, "error.message": message, "error.stack": _where(error)}
        with open(os.path.join(folder, "reply.bin"), "wb") as file:
            file.write(encode(reply))
        sys.stdout.write("\x01done %s\n" % seq)
        sys.stdout.flush()


if __name__ == "__main__":
    main(sys.argv[1])
