"""Environment steps a second, beside MuJoCo with its software renderer, in one run.

    pip install "./python[gym]" mujoco==3.9.0 && apt-get install libosmesa6
    python benches/peers/environment_steps.py

A step is 1/20 s of simulated time, in which the joints of two arms with seven joints each are moved at random over three blocks on
a table, and a picture of 128 x 128 with the arms in it. Both sides use as many threads (ours) or processes (MuJoCo's) as there are
cores, in turns of some seconds, so that other loads on the machine affect both. MuJoCo steps by 0.002 s, which is its own default,
and by 1/60 s, which is our tick.
"""

import argparse
import json
import multiprocessing
import os
import resource
import statistics
import time

os.environ.setdefault("MUJOCO_GL", "osmesa")

import numpy as np

import tabletop

SIZE = 128
CORES = len(os.sched_getaffinity(0))


def ours(num_envs: int, observation: str, seconds: float) -> float:
    """Steps a second of our environments."""
    many = tabletop.make_vec("StackThree", num_envs, threads=CORES, observation=observation, size=(SIZE, SIZE), copy=False)
    many.reset(seed=0)
    random = np.random.default_rng(0)
    steps, start = 0, time.perf_counter()
    while time.perf_counter() - start < seconds:
        many.step(random.uniform(-0.3, 0.3, (num_envs, 16)))
        steps += 1
    return steps * num_envs / (time.perf_counter() - start)


def arm(name: str, x: float) -> str:
    """An arm of seven joints with the sizes of Baxter's."""
    links = [(0.07, 0.27, "0 0 1"), (0.06, 0.10, "0 1 0"), (0.06, 0.26, "0 0 1"), (0.06, 0.10, "0 1 0"), (0.05, 0.27, "0 0 1"), (0.05, 0.12, "0 1 0"), (0.04, 0.23, "0 0 1")]
    text, end = "", ""
    at = f"{x} -0.85 0.3"
    for number, (radius, length, axis) in enumerate(links):
        text += (
            f'<body pos="{at}"><joint name="{name}{number}" type="hinge" axis="{axis}" damping="1" range="-2 2" limited="true"/>'
            f'<geom type="capsule" fromto="0 0 0 0 {length} 0" size="{radius}" mass="2" rgba=".7 .2 .2 1"/>'
        )
        end += "</body>"
        at = f"0 {length} 0"
    return text + end


def model(step: float):
    import mujoco

    blocks = "".join(
        f'<body pos="{x} {y} .05"><freejoint/><geom type="box" size=".05 .05 .05" mass="1" rgba="{color} 1"/></body>'
        for x, y, color in ((-0.3, -0.3, "1 0 0"), (0, -0.4, "0 1 0"), (0.3, -0.25, "0 0 1"))
    )
    motors = "".join(f'<velocity joint="{side}{number}" kv="50"/>' for side in "lr" for number in range(7))
    return mujoco.MjModel.from_xml_string(
        f'<mujoco><option timestep="{step}" gravity="0 0 0"/><visual><global offwidth="{SIZE}" offheight="{SIZE}"/></visual><worldbody>'
        '<light pos="0 -1 3"/><camera name="head" pos="0 -1.1 .8" xyaxes="1 0 0 0 .6 .8"/>'
        f'<geom type="box" pos="0 0 -0.2" size="1 .6 .2"/>{blocks}{arm("l", -0.3)}{arm("r", 0.3)}</worldbody>'
        f"<actuator>{motors}</actuator></mujoco>"
    )


def mujoco_process(step: float, pictures: bool, seconds: float, barrier, results) -> None:
    import mujoco

    world = model(step)
    data = mujoco.MjData(world)
    renderer = mujoco.Renderer(world, SIZE, SIZE) if pictures else None
    random = np.random.default_rng(0)
    per_step = round(0.05 / step)
    mujoco.mj_step(world, data)
    barrier.wait()
    steps, start = 0, time.perf_counter()
    while time.perf_counter() - start < seconds:
        data.ctrl[:] = random.uniform(-0.3, 0.3, world.nu)
        mujoco.mj_step(world, data, per_step)
        if renderer:
            renderer.update_scene(data, "head")
            renderer.render()
        steps += 1
    results.put(steps / (time.perf_counter() - start))


def mujoco(step: float, pictures: bool, seconds: float) -> float:
    """Steps a second of MuJoCo."""
    spawn = multiprocessing.get_context("spawn")
    barrier, results = spawn.Barrier(CORES), spawn.Queue()
    processes = [
        spawn.Process(target=mujoco_process, args=(step, pictures, seconds, barrier, results)) for _ in range(CORES)
    ]
    for process in processes:
        process.start()
    rates = [results.get() for _ in processes]
    for process in processes:
        process.join()
    return sum(rates)


def memory() -> float:
    """The memory of this process, in MB."""
    with open("/proc/self/statm") as file:
        return int(file.read().split()[1]) * resource.getpagesize() / 1e6


def against_number(counts, seconds: float) -> None:
    """The cost of a step, and the memory of a world, by the number of worlds."""
    print("worlds  steps/s with pictures  steps/s of states  memory a world after the first, MB")
    for count in counts:
        tabletop.make_vec("StackThree", 1, threads=1, observation="rgb", size=(SIZE, SIZE)).reset(seed=0)
        before = memory()
        many = tabletop.make_vec("StackThree", count, threads=CORES, observation="rgb", size=(SIZE, SIZE), copy=False)
        many.reset(seed=0)
        grown = (memory() - before) / count
        del many
        print(f"{count:6} {ours(count, 'rgb', seconds):22.0f} {ours(count, 'state', seconds):18.0f} {grown:20.2f}", flush=True)


def main() -> None:
    arguments = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    arguments.add_argument("--turns", type=int, default=3)
    arguments.add_argument("--seconds", type=float, default=4.0)
    arguments.add_argument("--counts", type=json.loads, default=[1, 16, 256, 1024])
    arguments.add_argument("--alone", action="store_true", help="without MuJoCo")
    arguments = arguments.parse_args()
    cases = {
        "tabletop, pictures": lambda: ours(32, "rgb", arguments.seconds),
        "tabletop, states": lambda: ours(32, "state", arguments.seconds),
    }
    if not arguments.alone:
        cases |= {
            "MuJoCo at 0.002 s, pictures": lambda: mujoco(0.002, True, arguments.seconds),
            "MuJoCo at 1/60 s, pictures": lambda: mujoco(1 / 60, True, arguments.seconds),
            "MuJoCo at 0.002 s, states": lambda: mujoco(0.002, False, arguments.seconds),
            "MuJoCo at 1/60 s, states": lambda: mujoco(1 / 60, False, arguments.seconds),
        }
    rates: dict[str, list[float]] = {name: [] for name in cases}
    for _ in range(arguments.turns):
        for name, measure in cases.items():
            rates[name].append(measure())
    print(f"steps a second on {CORES} cores, median of {arguments.turns} turns")
    for name, found in rates.items():
        print(f"{name:28} {statistics.median(found):10.0f}")
    against_number(arguments.counts, arguments.seconds)


if __name__ == "__main__":
    main()
