"""The Python side of the tabletop simulator's script bridge.

The simulator runs this file and tells it which script of yours to use. Your script is a Python file with two functions:

    def init(aux): ...                       # called once
    def callback(sensor, motor, aux): ...    # called in every tick of the simulation, 60 times a second

The arguments are objects with the fields of the Matlab interface. Rows are left, right; joints are S0, S1, E0, E1, W0, W1,
W2; lengths are in units of 10 cm, angles in rad. The sizes are those of Baxter: another robot has aux.numLimbs rows and
aux.numJoints joints.

    sensor.timeElapsed       simulation time since the last call, in s
    sensor.jointAngles       2x7
    sensor.endEffPos         2x3
    sensor.gripperOpening    1x2
    sensor.rgbVision         only if there is a fresh picture: rows x columns x 3, from 0 to 1; hasattr() tells
    sensor.demoCue           whether a demonstration is going on
    sensor.headAngle         of the neck, positive to the robot's left
    sensor.jointTorques      2x7, in N m; only with --dynamic
    sensor.trackerLoc        points on the arms: a dictionary from names to [x, y, z]; only if your script, or a file beside or
                             below it, mentions it
    sensor.objects, sensor.contacts, sensor.held
                             see docs/scripts.md; only if one of them is mentioned there. sensor.objects.mass and
                             sensor.contacts.impulse are lists of N numbers, also where the others have one row
    motor.jointVelocities    2x7, in rad/s; kept from call to call, like all of motor
    motor.gripperVelocities  2x1; [left, right] will do, in units/s
    motor.jointAngles        2x7, optional: angles that are taken at once
    motor.jointTorques       2x7, optional, in N m, in place of the velocities; only with --dynamic
    motor.headVelocity       optional, in rad/s
    aux.path                 the folder of your script, with a slash
    aux.numLimbs, aux.numJoints
                             2 and 7
    aux.minJointAngles, aux.maxJointAngles
                             2x7
    aux.initJointAngles      2x7, optional, set by init
    aux.drawMarkers          Nx3, optional, set by init: where markers are shown
    aux.exit                 set it, to anything, and the script is done

With numpy, matrices are its arrays. Without, they are lists of rows, and a picture is a Picture.

docs/script-protocol.md describes what goes on below. Python 3.8 and later; nothing else is needed.
"""

import difflib
import importlib.util
import inspect
import math
import numbers
import os
import re
import signal
import struct
import sys
import traceback
from collections.abc import Sequence
from types import SimpleNamespace

try:
    import numpy
except ImportError:
    numpy = None

MAGIC, VERSION = 0x31415454, 1
DOUBLE, BYTES, TEXT, LOGICAL, PICTURE, MAP, TEXTS, OTHER = range(8)
MOST_DIMENSIONS = 8
GREATEST = 2**32 - 1  # extent of an array that can be told
COUNTS = {"aux.numLimbs", "aux.numJoints"}
COLUMNS = {"sensor.objects.mass", "sensor.contacts.impulse"}  # a number for each, also where there is only one
WANTED = ("drawMarkers", "initJointAngles", "exit")  # what a script sets in aux
ROWS = {"sensor.jointAngles", "sensor.gripperOpening", "sensor.jointTorques", "aux.minJointAngles", "aux.maxJointAngles"}
SCRIPT = "__tabletop_script__"  # the script's name as a module: no file of a user has it
FILE = "TABLETOP_SCRIPT"  # the variable that tells its file to the processes that it starts
MOST = 300_000  # how many elements of an array, and letters of a text, are sent at most
PLACES = 10  # how many lines of the script, and how many causes, an error names at most


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
        arrays[key] = _field(key, code, tuple(extents[:dims]), data[first:first + size])
        start += name
        first += -(-size // 8) * 8
    return arrays


def _field(name, code, dims, data):
    """A value, with what its name says of it beside its class and size."""
    if name in COLUMNS:
        dims = dims[:1]
    value = _value(code, dims, data)
    if name in ROWS and dims == (1, 1):  # of a robot with one limb: a matrix as those of others
        return _rows([[value]])
    return int(value) if name in COUNTS else value


def _value(code, dims, data):
    count = 1
    for dim in dims:
        count *= dim
    if code == DOUBLE:
        return _matrix(struct.unpack("<%dd" % count, data), dims)
    if code == BYTES:
        return _matrix(list(data), dims)
    if code == TEXT:
        return data.decode("utf-8", "replace")
    if code == LOGICAL:
        return _matrix([byte != 0 for byte in data], dims)
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
    if dims == (1, 1):
        return values[0]
    if numpy is not None:
        return numpy.array(values).reshape(dims, order="F")
    if len(dims) == 1:
        return list(values)
    rows = dims[0]
    return [list(values[row::rows]) for row in range(rows)]


def encode(arrays):
    """The bytes of a dictionary of named arrays."""
    records, names, payloads = b"", b"", b""
    for key, value in arrays.items():
        code, dims, data = _elements(value)
        name = re.sub("[^A-Za-z0-9_.]", "_", key)[:256].encode("ascii")
        records += struct.pack("<12I", code, len(name), len(data), len(dims), *dims, *[0] * (8 - len(dims)))
        names += name
        payloads += data + bytes(-len(data) % 8)
    start = struct.pack("<4I", MAGIC, VERSION, len(arrays), len(names)) + records + names
    return start + bytes(-len(start) % 8) + payloads


def _elements(value):
    if isinstance(value, str):
        value = value[:MOST]
        return TEXT, (1, len(value)), value.encode("utf-8", "replace")
    shape = _shape(value)
    if _size(shape) > MOST:  # nobody wants that much: its size will do
        return OTHER, tuple(min(extent, GREATEST) for extent in shape) + (1,) * (2 - len(shape)), b"double"
    value = _column(_lists(value))
    extents = _extents(value)
    if extents is None:
        lengths = [len(row) if isinstance(row, list) else 1 for row in value]
        kind = "ragged list with rows of %d to %d elements" % (min(lengths), max(lengths))
        return OTHER, (len(value), 1), kind.encode("utf-8")
    elements = _columns(value, extents)
    dims = extents + (1,) * (2 - len(extents))
    strange = [type(element).__name__ for element in elements if not isinstance(element, numbers.Real)]
    if strange:
        return OTHER, dims, strange[0].encode("utf-8", "replace")
    return DOUBLE, dims, struct.pack("<%dd" % len(elements), *map(_double, elements))


def _shape(value):
    """The extents of an array, or of nested sequences as far as the first of each tells."""
    shape = getattr(value, "shape", None)
    if isinstance(shape, tuple) and len(shape) <= MOST_DIMENSIONS:
        return shape
    extents = ()
    while len(extents) < MOST_DIMENSIONS and isinstance(value, Sequence) and not isinstance(value, (str, bytes)):
        extents += (len(value),)
        if not value:
            break
        value = value[0]
    return extents


def _size(extents):
    size = 1
    for extent in extents:
        size *= extent
    return size


def _column(value):
    """[1, [2]] as [[1], [2]]: a column of which one row was set."""
    if not isinstance(value, list) or not any(isinstance(row, list) for row in value):
        return value
    if not all(isinstance(row, numbers.Real) or isinstance(row, list) and len(row) == 1 for row in value):
        return value
    return [row if isinstance(row, list) else [row] for row in value]


def _lists(value, depth=0):
    """Arrays and sequences as nested lists."""
    if hasattr(value, "tolist"):
        value = value.tolist()
    if depth == MOST_DIMENSIONS or isinstance(value, (str, bytes)) or not isinstance(value, Sequence):
        return value
    return [_lists(element, depth + 1) for element in value]


def _extents(value, depth=0):
    """The extents of nested lists; None if they are ragged."""
    if depth == MOST_DIMENSIONS or not isinstance(value, list):
        return ()
    inner = {_extents(element, depth + 1) for element in value} or {()}
    if len(inner) > 1 or None in inner:
        return None
    return (len(value),) + inner.pop()


def _columns(value, extents):
    """The elements of nested lists, the first index running fastest."""
    if not extents:
        return [value]
    rows = [_columns(row, extents[1:]) for row in value]
    return [element for column in zip(*rows) for element in column]


def _double(number):
    try:
        return float(number)
    except OverflowError:
        return math.inf if number > 0 else -math.inf


def _rows(rows):
    return rows if numpy is None else numpy.array(rows)


def _zeros(rows, columns):
    return _rows([[0.0] * columns for _ in range(rows)])


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


class Unfit(Exception):
    """Why a script cannot be used, and the function at fault if there is one."""

    def __init__(self, message, function=None):
        super().__init__(message)
        self.code = getattr(inspect.unwrap(function), "__code__", None)


def _load(file):
    sys.path.insert(0, os.path.dirname(file))
    os.environ[FILE] = file
    module = _import(file)
    _expect(module, "init", "aux")
    _expect(module, "callback", "sensor", "motor", "aux")
    return module


def _import(file):
    spec = importlib.util.spec_from_file_location(SCRIPT, file)
    if spec is None:
        raise Unfit("%s is no Python script: its name does not end in .py" % file)
    module = importlib.util.module_from_spec(spec)
    sys.modules[SCRIPT] = module
    spec.loader.exec_module(module)
    return module


def _expect(module, name, *arguments):
    """Has the script such a function?"""
    expected = "%s(%s)" % (name, ", ".join(arguments))
    function = getattr(module, name, None)
    if not callable(function):
        raise Unfit("%s has no function %s" % (module.__file__, expected))
    signature = inspect.signature(function)
    try:
        signature.bind(*arguments)
    except TypeError:
        raise Unfit("%s%s must be %s" % (name, signature, expected), function) from None
    if inspect.iscoroutinefunction(function) or inspect.isasyncgenfunction(function):
        raise Unfit("%s is async, so that a call does nothing; write def without async" % name, function)
    if inspect.isgeneratorfunction(function):
        raise Unfit("%s holds a yield, so that a call does nothing; write it without" % name, function)


def _warn_of_typos(aux, known):
    """Says which fields that a script has given to aux look like others that mean something. They are known from now on."""
    for name in sorted(set(vars(aux)) - known):
        known.add(name)
        looks = {wanted.lower(): wanted for wanted in WANTED}
        meant = difflib.get_close_matches(name.lower(), looks, 1, 0.75)
        if meant and name not in WANTED:
            print("tabletop: aux.%s means nothing (did you mean %s?)" % (name, looks[meant[0]]), file=sys.stderr)


def _fault(error):
    """An error as a reply."""
    places = _where(error)
    if len(places) > PLACES:
        places[PLACES:] = [(0, "…")]
    stack = "".join("%d %s\n" % place for place in places)
    return {"error.id": type(error).__name__, "error.message": "\n".join(_reasons(error)), "error.stack": stack}


def _reasons(error):
    """What an error says, and a line for each that it is a group of or that led to it."""
    reasons = [_words(error)]
    while len(reasons) < PLACES:
        reasons += [_reason("one of them:", part) for part in _parts(error)]
        link = "because of"
        origin = error.__cause__
        if origin is None and not error.__suppress_context__:
            link = "while handling"
            origin = error.__context__
        if origin is None:
            break
        reasons.append(_reason(link, origin))
        error = origin
    return reasons


def _reason(link, error):
    place = "".join(" (%s:%d)" % (file, line) for line, file in _where(error)[:1])
    return "%s %s%s" % (link, _words(error), place)


def _parts(error):
    """The errors that a group of errors holds."""
    parts = getattr(error, "exceptions", ())
    return [part for part in parts if isinstance(part, BaseException)][:PLACES] if isinstance(parts, (list, tuple)) else []


def _words(error):
    if isinstance(error, Unfit):
        return str(error)
    if isinstance(error, SyntaxError):
        return "%s: %s" % (type(error).__name__, error.msg)
    words = "".join(traceback.format_exception_only(type(error), error)).strip()
    words = words[len(SCRIPT) + 1 :] if words.startswith(SCRIPT + ".") else words
    if isinstance(error, SystemExit):
        return words + "; to end the script, set aux.exit"
    return words


def _where(error):
    """The script's part of the traceback as lines and files, innermost first."""
    places, read = [], None
    for frame, line in traceback.walk_tb(error.__traceback__):
        file = frame.f_code.co_filename
        if file != __file__ and not file.startswith("<frozen"):
            places.append((line, file))
        elif frame.f_code.co_name == "source_to_code":
            read = frame.f_locals.get("path")
    if isinstance(error, SyntaxError) and error.filename:
        places.append((error.lineno or 0, error.filename))
    elif read:
        places.append((0, read))
    if isinstance(error, Unfit) and error.code:
        places.append((error.code.co_firstlineno, error.code.co_filename))
    return places[::-1]


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
        self.known = set(vars(self.aux))
        limbs, joints = self.aux.numLimbs, self.aux.numJoints
        self.module = _load(request.agent.folder)
        self.module.init(self.aux)
        _warn_of_typos(self.aux, self.known)
        self.motor = SimpleNamespace(jointVelocities=_zeros(limbs, joints), gripperVelocities=_zeros(limbs, 1))
        return {"aux." + name: value for name, value in vars(self.aux).items() if name in WANTED}

    def step(self):
        self.module.callback(self.request().sensor, self.motor, self.aux)
        if len(vars(self.aux)) != len(self.known):
            _warn_of_typos(self.aux, self.known)
        reply = {"motor." + name: value for name, value in vars(self.motor).items()}
        if hasattr(self.aux, "exit"):
            reply["aux.exit"] = 1
        return reply


def main(folder):
    """Serves the simulator until it closes the standard input."""
    # The simulator interrupts a script that takes too long. Where it runs in the background, this would have no effect.
    signal.signal(signal.SIGINT, signal.default_int_handler)
    # Whatever the script, or what it starts, does to the standard streams, these are ours.
    commands, marks = os.fdopen(os.dup(0)), os.fdopen(os.dup(1), "w")
    nothing = os.open(os.devnull, os.O_RDONLY)
    os.dup2(nothing, 0)
    os.close(nothing)
    agent = _Agent(folder)
    for line in commands:
        op, seq = line.split()
        try:
            reply = encode(agent.run(op))
        except BaseException as error:
            reply = encode(_fault(error))
        with open(os.path.join(folder, "reply.bin"), "wb") as file:
            file.write(reply)
        marks.write("\x01done %s\n" % seq)
        marks.flush()


if __name__ == "__main__":
    main(sys.argv[1])
elif __name__ == "__mp_main__":  # in a process that the script has started with multiprocessing
    _import(os.environ[FILE])
