"""Rolls out a policy over the nodes of a Ray cluster: each actor steps a vector of environments.

    python examples/cluster/ray_rollouts.py --episodes 1000 --actors 4

Every episode has its own seed, so that it is the same on whichever node it runs, and its result is kept once, however often a
node dies. Without a cluster, Ray starts one on this machine.
"""

import argparse
from collections.abc import Callable

import numpy as np
import ray

import tabletop


@ray.remote(num_cpus=1)
class Rollouts:
    """A vector of environments on a node."""

    def __init__(self, name: str, num_envs: int):
        self.many = tabletop.make_vec(name, num_envs, threads=1, autoreset_mode="disabled", max_steps=50)

    def run(self, seeds: list[int]) -> dict[int, float]:
        """The return of an episode of each seed, of random actions."""
        count = self.many.num_envs
        padded = seeds + [0] * (count - len(seeds))
        self.many.reset(seed=padded)
        random = [np.random.default_rng(seed) for seed in padded]
        returns, going = np.zeros(count), np.ones(count, bool)
        while going.any():
            rows = np.flatnonzero(going)
            actions = np.stack([random[row].uniform(-1, 1, self.many.single_action_space.shape) for row in rows])
            self.many.send(actions, rows)
            _, reward, done, cut, info = self.many.recv(len(rows))
            returns[info["env_id"]] += reward
            going[info["env_id"]] = ~(done | cut)
        return {seed: float(returns[row]) for row, seed in enumerate(seeds)}


def rollouts(
    episodes: int, actors: int, num_envs: int, name: str, progress: Callable[[int], None] = lambda done: None
) -> dict[int, float]:
    """The return of each episode, by its seed. `progress` is told how many are done."""
    idle = [Rollouts.remote(name, num_envs) for _ in range(actors)]
    waiting = [list(range(first, min(first + num_envs, episodes))) for first in range(0, episodes, num_envs)]
    running: dict[ray.ObjectRef, tuple[ray.actor.ActorHandle, list[int]]] = {}
    returns: dict[int, float] = {}
    while waiting or running:
        while waiting and idle:
            worker, seeds = idle.pop(), waiting.pop(0)
            running[worker.run.remote(seeds)] = worker, seeds
        (ready, *_), _ = ray.wait(list(running))
        worker, seeds = running.pop(ready)
        try:
            part = ray.get(ready)
        except ray.exceptions.RayActorError:
            # Its node is gone: the others do its work.
            waiting.append(seeds)
            if not running and not idle:
                idle.append(Rollouts.remote(name, num_envs))
            continue
        idle.append(worker)
        twice = returns.keys() & part.keys()
        assert not twice, f"episodes came twice: {sorted(twice)}"
        returns |= part
        progress(len(returns))
    return returns


def main() -> None:
    arguments = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    arguments.add_argument("--name", default="StackThree")
    arguments.add_argument("--episodes", type=int, default=1000)
    arguments.add_argument("--actors", type=int, default=2)
    arguments.add_argument("--num-envs", type=int, default=8)
    arguments = arguments.parse_args()
    ray.init(ignore_reinit_error=True)
    returns = rollouts(arguments.episodes, arguments.actors, arguments.num_envs, arguments.name)
    values = np.array(list(returns.values()))
    print(f"{len(returns)} episodes, return {values.mean():.3f} ± {values.std():.3f}")


if __name__ == "__main__":
    main()
