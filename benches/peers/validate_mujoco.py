"""MuJoCo's side of `tabletop validate --against mujoco`: the same experiments, with MuJoCo's default options (a step of 0.002 s).

The arguments are names of experiments (none: all). It prints the measured values as JSON, by the names of the measurements, in tabletop's
units: 10 cm, kg, s. Experiments of which MuJoCo has no notion are left out: hands, a restitution that is a mean, rates at which
rotations die away. Restitution e is the usual solref=(-k, -b) of a damped spring, whose bounce takes 0.02 s.
"""

import json
import math
import sys

import mujoco
import numpy as np

UNIT = 0.1  # in m
G = 98.1  # in units/s²
BOUNCE = 0.02  # in s


def turn(axis, degrees):
    """A quaternion."""
    half = math.radians(degrees) / 2
    return np.array([math.cos(half), *(math.sin(half) * np.asarray(axis, float))])


def rotate(quat, vector):
    result = np.zeros(3)
    mujoco.mju_rotVecQuat(result, np.asarray(vector, float), quat)
    return result


X, Y, Z = np.eye(3)
LEVEL = turn(X, 0)
LYING = turn(X, 90)  # a cylinder of MuJoCo is along Z


def damping_ratio(restitution):
    """That of a spring which pushes and never pulls, from which things bounce so."""

    def bounces(ratio):
        rest = math.sqrt(1 - ratio * ratio)
        return math.exp(-ratio / rest * (math.pi - math.atan2(2 * ratio * rest, 1 - 2 * ratio * ratio)))

    least, most = 0.0, 0.999
    for _ in range(60):
        ratio = (least + most) / 2
        least, most = (ratio, most) if bounces(ratio) > restitution else (least, ratio)
    return least


class Body:
    """A free or fixed body. Lengths in units; the size is MuJoCo's: half extents, a radius, or a radius and half a length."""

    def __init__(self, name, kind, size, at, quat=LEVEL, mass=1.0, velocity=(0, 0, 0), spin=(0, 0, 0), fixed=False):
        self.name, self.kind, self.size, self.at, self.quat = name, kind, np.atleast_1d(size), np.asarray(at, float), quat
        self.mass, self.velocity, self.spin, self.fixed = mass, velocity, np.asarray(spin, float), fixed

    def xml(self, inner=""):
        numbers = lambda values: " ".join(f"{value:.12g}" for value in values)
        joint = "" if self.fixed else "<freejoint/>"
        # The axes of a lying cylinder are those of a cylinder of tabletop.
        quat = LYING if self.kind == "cylinder" else LEVEL
        return (
            f'<body name="{self.name}" pos="{numbers(self.at * UNIT)}" quat="{numbers(self.quat)}">{joint}'
            f'<geom type="{self.kind}" size="{numbers(self.size * UNIT)}" quat="{numbers(quat)}" mass="{max(self.mass, 1e-3)}"/>{inner}</body>'
        )


def block(name, span, at, **rest):
    return Body(name, "box", np.asarray(span, float) / 2, at, **rest)


def cube(name, at, **rest):
    return block(name, (1, 1, 1), at, **rest)


def ball(name, radius, at, **rest):
    return Body(name, "sphere", radius, at, **rest)


def cylinder(name, radius, length, at, **rest):
    return Body(name, "cylinder", (radius, length / 2), at, **rest)


class World:
    def __init__(self, bodies, friction=0.25, restitution=0.0, gravity=9.81, xml="", equality=""):
        stiffness = (math.pi / BOUNCE) ** 2
        damping = 2 * damping_ratio(restitution) * math.sqrt(stiffness)
        solref = f'solref="{-stiffness:.9g} {-damping:.9g}"' if restitution > 0 else ""
        smooth = 'condim="1"' if friction == 0 else ""
        self.model = mujoco.MjModel.from_xml_string(
            f'<mujoco><option gravity="0 0 {-gravity}"/><size memory="200M"/><default><geom friction="{friction} 0.005 0.0001" {smooth} {solref}/></default>'
            f'<worldbody><geom type="plane" size="0 0 1"/>{"".join(body.xml() for body in bodies)}{xml}</worldbody>'
            f"<equality>{equality}</equality></mujoco>"
        )
        self.data = mujoco.MjData(self.model)
        for body in bodies:
            if not body.fixed:
                start = self.address(body.name)
                self.data.qvel[start : start + 3] = np.asarray(body.velocity, float) * UNIT
                back = body.quat * [1, -1, -1, -1]
                self.data.qvel[start + 3 : start + 6] = rotate(back, body.spin)
        mujoco.mj_forward(self.model, self.data)

    def address(self, name):
        return self.model.body(name).dofadr[0]

    def step(self, seconds, see=None):
        for _ in range(round(seconds / self.model.opt.timestep)):
            mujoco.mj_step(self.model, self.data)
            if see:
                mujoco.mj_kinematics(self.model, self.data)
                see()
        mujoco.mj_forward(self.model, self.data)
        return self

    def place(self, name):
        return self.data.body(name).xpos / UNIT

    def point(self, name, point):
        return self.place(name) + rotate(self.quat(name), point)

    def quat(self, name):
        return self.data.body(name).xquat.copy()

    def velocity(self, name):
        start = self.address(name)
        return self.data.qvel[start : start + 3] / UNIT

    def spin(self, name):
        start = self.address(name)
        return rotate(self.quat(name), self.data.qvel[start + 3 : start + 6])

    def angle(self, name, quat=LEVEL):
        return 2 * math.acos(min(1, abs(float(np.dot(self.quat(name), quat)))))

    def energy(self, body):
        """In kg units²/s²."""
        spin = self.data.qvel[self.address(body.name) + 3 :][:3]
        inertia = self.model.body(body.name).inertia / UNIT**2
        frame = self.model.body(body.name).iquat * [1, -1, -1, -1]
        turning = np.dot(inertia, rotate(frame, spin) ** 2)
        moving = body.mass * np.dot(self.velocity(body.name), self.velocity(body.name))
        return body.mass * G * self.place(body.name)[2] + (moving + turning) / 2


def fall(body):
    world = World([body]).step(0.5)
    return {"way": 30 - world.place("body")[2], "speed": -world.velocity("body")[2]}


def throw():
    world = World([cube("cube", (0, 0, 10), velocity=(10, 0, 20))]).step(0.4)
    return {"way along": world.place("cube")[0], "height": world.place("cube")[2]}


def slide(direction, friction=0.25, mass=1.0):
    direction = np.asarray(direction, float) / np.linalg.norm(direction)
    body = block("block", (1, 1, 0.5), (0, 0, 0.25), mass=mass, velocity=10 * direction)
    world = World([body], friction).step(10 / (friction * G) + 1)
    way = world.place("block") - [0, 0, 0.25]
    along = way @ direction
    return {"way": along, "way aside": np.linalg.norm(way - along * direction), "turn": world.angle("block")}


def slope(name, degrees, at, length):
    return block(name, (length, 2, 1), at, quat=turn(Y, degrees), fixed=True)


def on(slope, height):
    return slope.at + rotate(slope.quat, (0, 0, 0.5 + height))


def steepest(friction):
    percents = range(-15, 16)
    tangent = lambda percent: friction * (1 + percent / 100)
    bodies, starts = [], {}
    for percent in percents:
        under = slope(f"slope{percent}", math.degrees(math.atan(tangent(percent))), (0, 3 * percent, 5), 6)
        starts[percent] = on(under, 0.25)
        bodies += [under, block(f"block{percent}", (1, 1, 0.5), starts[percent], quat=under.quat)]
    world = World(bodies, friction).step(2)
    held = -16
    for percent in percents:
        if np.linalg.norm(world.place(f"block{percent}") - starts[percent]) > 0.05:
            break
        held = percent
    return {"steepest tan θ": tangent(held)}


def slide_down(friction):
    under = slope("slope", 30, (0, 0, 15), 40)
    start, down = on(under, 0.25), rotate(under.quat, X)
    world = World([under, block("block", (1, 1, 0.5), start, quat=under.quat)], friction).step(0.5)
    return {"speed": world.velocity("block") @ down, "way": (world.place("block") - start) @ down}


def round_body(kind, radius, at, **rest):
    return ball("body", radius, at, **rest) if kind == "ball" else cylinder("body", radius, 1, at, **rest)


def roll_down(kind, degrees):
    # Not 60 long, as that of tabletop: MuJoCo throws a cylinder off so large a box.
    under = slope("slope", degrees, (0, 0, 15), 30)
    body = round_body(kind, 0.5, on(under, 0.5), quat=under.quat)
    world = World([under, body], 0.5).step(1)
    speed = world.velocity("body") @ rotate(under.quat, X)
    return {"speed": speed, "slip": speed - world.spin("body")[1] * 0.5}


def roll_along(kind, radius, start):
    body = round_body(kind, radius, (0, 0, radius), velocity=(start, 0, 0), spin=(0, start / radius, 0))
    world = World([body])
    hops = [0]
    world.step(2, lambda: hops.append(abs(world.place("body")[2] - radius)))
    found = world.velocity("body")
    return {"speed": found[0], "change of height": max(hops), "speed aside": abs(found[1])}


def roll_after_sliding():
    return {"speed": World([ball("ball", 0.5, (0, 0, 0.5), velocity=(10, 0, 0))]).step(1).velocity("ball")[0]}


def heights(world, name, rest, seconds):
    found, was_falling = [], [True]

    def see():
        speed = world.velocity(name)[2]
        height = world.place(name)[2] - rest + speed * speed / (2 * G)
        is_rising = speed > 0.05 and height > 0.002
        if is_rising and was_falling[0]:
            found.append(height)
        elif is_rising:
            found[-1] = height
        was_falling[0] = not is_rising

    world.step(seconds, see)
    return found or [0.0]


def bounce(restitution, drop):
    world = World([ball("ball", 0.5, (0, 0, drop + 0.5))], restitution=restitution)
    return {"height": heights(world, "ball", 0.5, 1)[0]}


def bounce_ten_times():
    world = World([ball("ball", 0.5, (0, 0, 2.5))], restitution=1.0)
    found = heights(world, "ball", 0.5, 5)[:10]
    return {"bounces": len(found), "lowest": min(found), "highest": max(found)}


def bounce_cube(restitution, *plates):
    rest = 1.0 if plates else 0.5
    bodies = [block(f"plate{x}", (span, span, 0.5), (x, 0, 0.25), fixed=True) for x, span in plates]
    world = World([*bodies, cube("cube", (0, 0, 5 + rest))], restitution=restitution)
    height = heights(world, "cube", rest, 0.45)[0]
    return {"height": height, "spin": np.linalg.norm(world.spin("cube"))}


def tiles(count):
    span = 16 / count
    return [block(f"tile{i}", (span, 4, 0.5), ((i + 0.5) * span, 0, 0.25), fixed=True) for i in range(count)]


def cross(make, count):
    world = World([*tiles(count), make((1, 0, 1), velocity=(10, 0, 0))], friction=0)
    off, aside = [0], [0]

    def see():
        off.append(abs(world.place("body")[2] - 1))
        aside.append(abs(world.place("body")[1]))

    world.step(1.4, see)
    return {"speed": world.velocity("body")[0], "change of height": max(off), "way aside": max(aside)}


def cross_cube(at, **rest):
    return cube("body", at, **rest)


def cross_ball(at, **rest):
    return ball("body", 0.5, at, **rest)


def cross_cylinder(at, **rest):
    return cylinder("body", 0.5, 1, at, **rest)


def lengthwise():
    plates = [block(f"plate{y}", (16, 2, 0.5), (8, y, 0.25), fixed=True) for y in (-1, 1)]
    world = World([*plates, cube("cube", (1, 0.2, 1), velocity=(10, 0, 0))], friction=0).step(1.4)
    off = world.place("cube") - [1, 0.2, 1]
    return {"speed": world.velocity("cube")[0], "change of height": abs(off[2]), "way aside": abs(off[1])}


def rough_seam():
    world = World([*tiles(2), cube("cube", (7, 0, 1), velocity=(10, 0, 0))]).step(2)
    return {"way": world.place("cube")[0] - 7}


def row():
    balls = [ball("ball0", 0.5, (-3, 0, 0.5), velocity=(10, 0, 0))]
    balls += [ball(f"ball{i}", 0.5, (i - 1, 0, 0.5)) for i in range(1, 6)]
    world = World(balls, friction=0, restitution=1.0).step(0.6)
    speeds = [world.velocity(body.name) for body in balls]
    return {
        "speed of the last": speeds[5][0],
        "speed of the others": max(np.linalg.norm(speed) for speed in speeds[:5]),
        "energy": sum(speed @ speed for speed in speeds),
        "momentum": sum(speed[0] for speed in speeds),
    }


def collide(kind, masses, restitution):
    make = cube if kind == "cubes" else lambda name, at, **rest: ball(name, 0.5, at, **rest)
    bodies = [make("first", (-3, 0, 0.5), mass=masses[0], velocity=(10, 0, 0)), make("second", (0, 0, 0.5), mass=masses[1])]
    world = World(bodies, friction=0, restitution=restitution).step(0.6)
    first, second = (world.velocity(name)[0] for name in ("first", "second"))
    momentum = (masses[0] * first + masses[1] * second) / (masses[0] * 10)
    return {"first's speed": first, "second's speed": second, "momentum": momentum}


def crowd_bounces():
    balls = [ball(f"ball{i}", 0.5, (1.5 * (i % 7) - 4.5, 1.5 * (i // 7) - 4.5, 2.5)) for i in range(49)]
    world = World(balls, restitution=1.0)
    energy = lambda: sum(world.energy(body) for body in balls) - 49 * G * 0.5
    first, most = energy(), [0]
    world.step(10, lambda: most.append(energy()))
    return {"gain of energy": max(max(most) / first - 1, 0), "energy after 10 s": energy() / first}


def crowd_settles():
    radius, thickness = 0.25, 0.3
    wall = 2 - thickness / 2
    box = [block("floor", (4, 4, thickness), (0, 0, thickness / 2), fixed=True)]
    for i, (x, y) in enumerate([(wall, 0), (-wall, 0), (0, wall), (0, -wall)]):
        span = (thickness, 4, 5) if x else (4, thickness, 5)
        box.append(block(f"wall{i}", span, (x, y, 2.5), fixed=True))
    balls = []
    for i in range(216):
        shift = 0.04 if i // 36 % 2 == 0 else -0.04
        place = np.array([i % 6 - 2.5, i // 6 % 6 - 2.5, i // 36]) * 0.53 + [shift, shift, 0.8]
        balls.append(ball(f"ball{i}", radius, place))
    world = World(box + balls).step(5)
    places = np.array([world.place(body.name) for body in balls])
    distances = np.linalg.norm(places[:, None] - places[None], axis=2)[np.triu_indices(216, 1)]
    deepest = max(2 * radius - distances.min(), radius + thickness - places[:, 2].min(), 0)
    outside = np.sum((np.abs(places[:, :2]).max(axis=1) > 1.7) | (places[:, 2] < 0.3))
    fastest = max(np.linalg.norm(world.velocity(body.name)) for body in balls)
    return {"penetration/radius": deepest / radius, "balls outside": outside, "fastest after 5 s": fastest}


def stack(lower, upper):
    world = World([cube("lower", (0, 0, 0.5), mass=lower), cube("upper", (0, 0, 1.5), mass=upper)])
    depths = [0]

    def see():
        below, above = (world.place(name)[2] for name in ("lower", "upper"))
        depths.append(max(0.5 - below, 1 - (above - below)))

    world.step(5, see)
    drift = max(np.linalg.norm(world.place(name)[:2]) for name in ("lower", "upper"))
    return {"penetration": max(depths), "drift": drift, "height": world.place("upper")[2]}


def stand(tower, seconds):
    world = World(tower).step(seconds)
    return {"drift": max(np.linalg.norm(world.place(part.name) - part.at) for part in tower)}


def cubes():
    return [cube(f"cube{i}", (0, 0, i + 0.5)) for i in range(10)]


def planks():
    tower = []
    for i in range(60):
        storey, side = i // 2, i % 2 * 2 - 1
        quat = turn(Z, 90 * (storey % 2))
        at = rotate(quat, (0, side * (1.17 - 0.234) / 2, 0)) + [0, 0, (storey + 0.5) * 0.078]
        tower.append(block(f"plank{i}", (1.17, 0.234, 0.078), at, quat=quat, mass=0.01))
    return tower


def slow_slide(speed):
    return {"way": World([cube("cube", (0, 0, 0.5), velocity=(speed, 0, 0))], friction=0).step(3).place("cube")[0]}


def slow_turn():
    return {"angle": World([cube("cube", (0, 0, 10), spin=(0, 0, 0.1))], gravity=0).step(5).angle("cube")}


def spin(spin, flips=False):
    brick = block("brick", (1, 2, 3), (0, 0, 20), spin=spin)
    world = World([brick], gravity=0)
    inertia = np.array([13, 10, 5]) / 12
    own = lambda: rotate(world.quat("brick") * [1, -1, -1, -1], world.spin("brick"))
    momentum = lambda: rotate(world.quat("brick"), inertia * own())
    first, energy = momentum(), own() @ (inertia * own()) / 2
    most, spins = [0], [own()]

    def see():
        spins.append(own())
        most.append(spins[-1] @ (inertia * spins[-1]) / 2 / energy - 1)

    world.step(10, see)
    last = momentum()
    cosine = last @ first / np.linalg.norm(last) / np.linalg.norm(first)
    found = {
        "energy": 1 + most[-1],
        "gain of energy": max(most),
        "angular momentum": np.linalg.norm(last) / np.linalg.norm(first),
        "turn of its axis": math.acos(min(1, cosine)),
    }
    if flips:
        y = [spin[1] for spin in spins]
        times = [(i + y[i] / (y[i] - y[i + 1])) * 0.002 for i in range(len(y) - 1) if (y[i] > 0) != (y[i + 1] > 0)]
        found["flips"] = len(times)
        found["time of the first flip"] = times[0] if times else 0
        found["time between flips"] = (times[-1] - times[0]) / (len(times) - 1) if len(times) > 1 else 0
    return found


def rock(support, plate=None, friction=0.25):
    plate = plate or block("plate", (4, 4, 0.2), (0, 0, 2.1))
    world = World([support, plate], friction)
    free = [body for body in (support, plate) if not body.fixed]
    energy = lambda: sum(world.energy(body) for body in free)
    first, most, off = energy(), [0], [0]

    def see():
        most.append(energy() - first)
        off.append(np.linalg.norm(world.place("plate") - plate.at))

    world.step(15, see)
    found = {"gain of energy/m g": max(most) / G}
    return found | {"way of the plate": max(off)} if support.fixed else found


def rock_tilted():
    tilt = math.radians(6)
    quat = turn(Y, 6)
    at = rotate(quat, (-tilt, 0, 1.1)) + [0, 0, 1]
    support = cylinder("support", 1, 4, (0, 0, 1), fixed=True)
    return {"gain of energy/m g": rock(support, block("plate", (4, 4, 0.2), at, quat=quat), 1)["gain of energy/m g"]}


def pendulum(degrees):
    xml = (
        f'<body name="bob" pos="0 0 2"><joint name="hinge" type="hinge" axis="1 0 0"/>'
        f'<geom type="box" pos="0 0 {-2 * UNIT}" size="0.025 0.025 0.025" mass="1"/></body>'
    )
    world = World([], xml=xml)
    world.data.joint("hinge").qpos[0] = math.radians(degrees)
    length, inertia = 2, 4 + 0.25 / 6
    mean = [1, math.cos(math.radians(degrees) / 2)]
    for _ in range(30):
        mean = [(mean[0] + mean[1]) / 2, math.sqrt(mean[0] * mean[1])]
    expected = 2 * math.pi * math.sqrt(inertia / (G * length)) / mean[0]
    angles = [math.radians(degrees)]
    world.step(10, lambda: angles.append(float(world.data.joint("hinge").qpos[0])))
    early = angles[: int(3.5 * expected / 0.002)]
    rises = [i - early[i] / (early[i + 1] - early[i]) for i in range(len(early) - 1) if early[i] < 0 <= early[i + 1]]
    period = (rises[-1] - rises[0]) / (len(rises) - 1) * 0.002
    swing = max(angles[-int(2 * expected / 0.002) :])
    return {"period": period, "amplitude after 10 s": swing, "stretch": 0.0}


def slider():
    axis = rotate(turn(Y, -30), -X)
    xml = (
        f'<body name="load" pos="0 0 2"><joint name="slide" type="slide" axis="{axis[0]} {axis[1]} {axis[2]}"/>'
        '<geom type="box" size="0.025 0.025 0.025" mass="1"/></body>'
    )
    world = World([], xml=xml).step(0.5)
    joint = world.data.joint("slide")
    return {"way": abs(joint.qpos[0]) / UNIT, "speed": abs(joint.qvel[0]) / UNIT}


def chain(links):
    distance = 11.8
    xml, close = "", ""
    for i in range(links):
        at = f"{-distance / 2 * UNIT} 0 2" if i == 0 else f"{UNIT} 0 0"
        xml += (
            f'<body name="link{i}" pos="{at}"><joint type="ball" damping="0.002"/>'
            f'<geom type="box" pos="{UNIT / 2} 0 0" size="{UNIT / 2} 0.005 0.005" mass="0.1" contype="0" conaffinity="0"/>'
        )
        close += "</body>"
    last = f"link{links - 1}"
    equality = f'<connect body1="{last}" anchor="{UNIT} 0 0"/>'
    world = World([], xml=xml + close, equality=equality)
    # The anchor in the world, which MuJoCo would take from where the chain is at first.
    world.model.eq_data[0, 3:6] = [distance / 2 * UNIT, 0, 2]
    # A hanging beginning: the links fold down and up again.
    steep = math.acos(distance / links)
    for i in range(links):
        start = world.model.jnt_qposadr[i]
        bend = math.degrees(steep) * (1 if i == 0 else -2 if i == links // 2 else 0)
        world.data.qpos[start : start + 4] = turn(Y, bend)
    world.step(30)
    lowest = min(world.point(f"link{i}", (1, 0, 0))[2] for i in range(links))
    return {"sag": 20 - lowest}


def weld(first, second):
    return f'<weld body1="{first}" body2="{second}"/>'


def beam(load=None):
    bodies = [cube(f"cube{i}", (i, 0, 5), fixed=i == 0) for i in range(6)]
    if load:
        bodies.append(cube("load", (5, 0, 6), mass=load))
    world = World(bodies, equality="".join(weld(f"cube{i}", f"cube{i + 1}") for i in range(5)))
    sags = [0]
    world.step(5, lambda: sags.append(abs(5 - world.place("cube5")[2])))
    return {"sag": max(sags), "gap": gap(world, 6, X)}


def column(load):
    bodies = [cube(f"cube{i}", (0, 0, i + 0.5)) for i in range(5)] + [cube("load", (0, 0, 5.5), mass=load)]
    world = World(bodies, equality="".join(weld(f"cube{i}", f"cube{i + 1}") for i in range(4))).step(5)
    return {"height of the load": world.place("load")[2], "gap": gap(world, 5, Z)}


def gap(world, count, direction):
    ends = lambda i: np.linalg.norm(world.point(f"cube{i}", direction / 2) - world.point(f"cube{i + 1}", -direction / 2))
    return max(ends(i) for i in range(count - 1))


EXPERIMENTS = {
    "fall-ball": lambda: fall(ball("body", 0.5, (0, 0, 30))),
    "fall-cube": lambda: fall(cube("body", (0, 0, 30))),
    "throw": throw,
    "slide-along-x": lambda: slide(X),
    "slide-along-y": lambda: slide(Y),
    "slide-diagonally": lambda: slide((1, 1, 0)),
    "slide-at-20-degrees": lambda: slide((0.94, 0.342, 0)),
    "slide-rough": lambda: slide(X, 0.5),
    "slide-smooth": lambda: slide(X, 0.1),
    "slide-heavy": lambda: slide(X, mass=1000),
    "slope-holds-0.25": lambda: steepest(0.25),
    "slope-holds-0.5": lambda: steepest(0.5),
    "slope-holds-0.8": lambda: steepest(0.8),
    "slope-slides-smooth": lambda: slide_down(0),
    "slope-slides-rough": lambda: slide_down(0.25),
    "roll-ball-4-degrees": lambda: roll_down("ball", 4),
    "roll-ball-20-degrees": lambda: roll_down("ball", 20),
    "roll-cylinder-4-degrees": lambda: roll_down("cylinder", 4),
    "roll-cylinder-20-degrees": lambda: roll_down("cylinder", 20),
    "roll-small-ball": lambda: roll_along("ball", 0.1, 6.6),
    "roll-ball": lambda: roll_along("ball", 0.5, 6.6),
    "roll-cylinder": lambda: roll_along("cylinder", 0.5, 6.6),
    "roll-cylinder-slowly": lambda: roll_along("cylinder", 0.5, 1),
    "roll-after-sliding": roll_after_sliding,
    "bounce-1-from-5": lambda: bounce(1.0, 5),
    "bounce-1-from-0.5": lambda: bounce(1.0, 0.5),
    "bounce-0.8-from-5": lambda: bounce(0.8, 5),
    "bounce-0.8-from-0.5": lambda: bounce(0.8, 0.5),
    "bounce-0.5-from-5": lambda: bounce(0.5, 5),
    "bounce-0.5-from-0.5": lambda: bounce(0.5, 0.5),
    "bounce-0-from-5": lambda: bounce(0.0, 5),
    "bounce-ten-times": bounce_ten_times,
    "bounce-cube-0.8": lambda: bounce_cube(0.8),
    "bounce-cube": lambda: bounce_cube(0.5),
    "bounce-cube-small-plate": lambda: bounce_cube(0.5, (0, 0.6)),
    "bounce-cube-large-plate": lambda: bounce_cube(0.5, (0, 3)),
    "bounce-cube-seam": lambda: bounce_cube(0.5, (-1, 2), (1, 2)),
    "bounce-cube-corner": lambda: bounce_cube(0.5, (-1.3, 2), (0.7, 2)),
    "seam-cube": lambda: cross(cross_cube, 2),
    "seam-ball": lambda: cross(cross_ball, 2),
    "seam-cylinder": lambda: cross(cross_cylinder, 2),
    "tiles-cube": lambda: cross(cross_cube, 16),
    "tiles-ball": lambda: cross(cross_ball, 16),
    "tiles-cylinder": lambda: cross(cross_cylinder, 16),
    "seam-lengthwise": lengthwise,
    "seam-rough": rough_seam,
    "row-of-balls": row,
    "collide-balls-elastic": lambda: collide("balls", (1, 1), 1.0),
    "collide-balls-unequal": lambda: collide("balls", (3, 1), 1.0),
    "collide-cubes-elastic": lambda: collide("cubes", (1, 1), 1.0),
    "collide-cubes-inelastic": lambda: collide("cubes", (1, 1), 0.0),
    "collide-cubes-heavy-on-light": lambda: collide("cubes", (3, 1), 0.5),
    "collide-cubes-light-on-heavy": lambda: collide("cubes", (1, 3), 0.5),
    "collide-cubes-1-on-1000": lambda: collide("cubes", (1, 1000), 1.0),
    "crowd-bounces": crowd_bounces,
    "crowd-settles": crowd_settles,
    "stack-10-on-1": lambda: stack(1, 10),
    "stack-100-on-1": lambda: stack(1, 100),
    "stack-1000-on-1": lambda: stack(1, 1000),
    "stack-10000-on-1": lambda: stack(1, 10000),
    "stack-1-on-1000": lambda: stack(1000, 1),
    "tower-of-ten": lambda: stand(cubes(), 60),
    "tower-of-planks": lambda: stand(planks(), 600),
    "slow-slide-0.3": lambda: slow_slide(0.3),
    "slow-slide-0.1": lambda: slow_slide(0.1),
    "slow-turn": slow_turn,
    "spin-long-axis": lambda: spin((0.1, 0.1, 10)),
    "spin-middle-axis": lambda: spin((0.5, 10, 0.5), flips=True),
    "spin-short-axis": lambda: spin((10, 0.1, 0.1)),
    "rock-on-ball": lambda: rock(ball("support", 1, (0, 0, 1), fixed=True)),
    "rock-on-cylinder": lambda: rock(cylinder("support", 1, 4, (0, 0, 1), fixed=True)),
    "rock-on-free-cylinder": lambda: rock(cylinder("support", 1, 4, (0, 0, 1))),
    "rock-on-free-ball": lambda: rock(ball("support", 1, (0, 0, 1))),
    "rock-tilted": rock_tilted,
    "pendulum-5-degrees": lambda: pendulum(5),
    "pendulum-90-degrees": lambda: pendulum(90),
    "slider-on-slope": slider,
    "chain-hangs": lambda: chain(16),
    "chain-hangs-tight": lambda: chain(13),
    "bonds-beam": beam,
    "bonds-beam-10-kg": lambda: beam(10),
    "bonds-column-100-kg": lambda: column(100),
}

values = {}
for name in sys.argv[1:] or EXPERIMENTS:
    if name in EXPERIMENTS:
        try:
            found = EXPERIMENTS[name]()
        except mujoco.FatalError as error:
            print(f"{name}: {error}", file=sys.stderr)
            continue
        values |= {f"{name}: {quantity}": float(value) for quantity, value in found.items()}
json.dump(values, sys.stdout, ensure_ascii=False)
