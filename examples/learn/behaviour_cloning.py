"""Learns to put the red block on the blue one from a demonstration that was multiplied: numpy only, in seconds.

    tabletop run scenarios/red_on_blue.ron --record demo
    python examples/learn/behaviour_cloning.py demo

The policy is a linear map from where the blocks are to where to take and where to put, fitted to the demonstrations; it acts in
an environment with blocks at places that it has not seen, and is compared with chance.
"""

import pathlib
import sys
import tempfile

import numpy as np

import tabletop


def example(folder: pathlib.Path, table: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Where the objects were at first, and where one was taken and put, as shares of the table's half extents."""
    states = tabletop.Recording(folder).states()
    ids = np.array(states["id"])
    places = np.stack([states["x"], states["y"]], axis=1) / table
    names = sorted(set(ids))
    first, last = (np.stack([places[ids == name][row] for name in names]) for row in (0, -1))
    moved = np.abs(last - first).sum(axis=1).argmax()
    return first.ravel(), np.concatenate([first[moved], last[moved]])


def success(env: tabletop.TabletopEnv, policy, episodes: int) -> float:
    """The share of episodes in which one action of a policy does the task."""
    done = 0
    for seed in range(episodes):
        state, _ = env.reset(seed=10_000 + seed)
        done += env.step(policy(state))[2]
    return done / episodes


def main(demo: str) -> None:
    table = np.array([10.0, 6.0])
    with tempfile.TemporaryDirectory() as folder:
        made = tabletop.multiply(demo, folder, count=40, seed=1)
        seen, done = map(np.array, zip(*(example(it, table) for it in made)))
    ones = np.ones((len(seen), 1))
    weights, *_ = np.linalg.lstsq(np.hstack([seen, ones]), done, rcond=None)
    env = tabletop.make("RedOnBlue", action="pick_place")
    names = env.state_names
    ids = sorted({name.split(".")[0] for name in names if name.endswith(".vx")})
    columns = [names.index(f"{id}.{axis}") for id in ids for axis in "xy"]

    def cloned(state: np.ndarray) -> np.ndarray:
        places = state[columns].reshape(-1, 2) / table
        return np.append(np.append(places.ravel(), 1) @ weights, 0)

    random = np.random.default_rng(0)
    chance = success(env, lambda _: random.uniform(-1, 1, 5), 50)
    learned = success(env, cloned, 50)
    print(f"cloned: {learned:.0%} of 50, chance: {chance:.0%}")
    sys.exit(learned < chance + 0.5)


if __name__ == "__main__":
    main(sys.argv[1])
