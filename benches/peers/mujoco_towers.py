"""MuJoCo's side of the comparison: answers each line `SCENE BLOCKS SECONDS` with the time that simulating it took, in ns.

SCENE is `coarse` (steps of 1/60 s), `fine` (MuJoCo's own step of 0.002 s with elliptic friction cones) or one of them with
`-drift`, which is answered with how far the top of one tower of so many blocks has moved, in units of 10 cm.
"""

import sys
import time

import mujoco

HALF = 0.05  # of a block, in m
OPTIONS = {
    "coarse": f'timestep="{1 / 60}" cone="pyramidal"',
    "fine": 'timestep="0.002" cone="elliptic"',
}


def body(x, y, z):
    return (
        f'<body pos="{x} {y} {z}"><freejoint/>'
        f'<geom type="box" size="{HALF} {HALF} {HALF}" mass="1" friction="0.25"/></body>'
    )


def model(step, places):
    bodies = "".join(body(*place) for place in places)
    return mujoco.MjModel.from_xml_string(
        f'<mujoco><option {OPTIONS[step]} gravity="0 0 -9.81"/><worldbody>'
        f'<geom type="box" pos="0 0 -0.05" size="1 0.6 0.05" friction="0.25"/>{bodies}'
        "</worldbody></mujoco>"
    )


def towers_of_five(blocks):
    for block in range(blocks):
        tower, storey = divmod(block, 5)
        row, column = divmod(tower, 8)
        yield 0.2 * column - 0.7, 0.2 * row - 0.4, 2 * HALF * storey + HALF


class World:
    def __init__(self, step, places):
        self.model = model(step, places)
        self.data = mujoco.MjData(self.model)

    def simulate(self, seconds):
        steps = round(seconds / self.model.opt.timestep)
        start = time.perf_counter_ns()
        mujoco.mj_step(self.model, self.data, steps)
        return time.perf_counter_ns() - start


def drift(step, blocks, seconds):
    world = World(step, [(0, 0, 2 * HALF * i + HALF) for i in range(blocks)])
    top = world.data.qpos[-7:-4].copy()
    world.simulate(seconds)
    return float(sum((world.data.qpos[-7:-4] - top) ** 2) ** 0.5 / (2 * HALF))


worlds = {}
for line in sys.stdin:
    scene, blocks, seconds = line.split()
    blocks, seconds = int(blocks), float(seconds)
    if scene.endswith("-drift"):
        answer = drift(scene.removesuffix("-drift"), blocks, seconds)
    else:
        if (scene, blocks) not in worlds:
            worlds[scene, blocks] = World(scene, list(towers_of_five(blocks)))
            worlds[scene, blocks].simulate(1)
        answer = worlds[scene, blocks].simulate(seconds)
    print(answer, flush=True)
