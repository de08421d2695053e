"""Kills a node of a local Ray cluster while it rolls out and multiplies, and counts what is there in the end.

    pip install "./python[gym]" ray && python examples/cluster/ray_killed_node.py

The cluster has two nodes on this machine. Of 1,000 episodes each must be there once, with the return that it has alone, and of 40
demonstrations each, with the bytes that it has when one process makes all of them.
"""

import filecmp
import pathlib
import subprocess
import sys
import tempfile
import threading
import time

import ray
from ray.cluster_utils import Cluster

from ray_multiply import multiply
from ray_rollouts import Rollouts, rollouts

EPISODES, SHARDS, DEMONSTRATIONS = 1000, 4, 40


def tabletop(*arguments: object) -> None:
    subprocess.run([sys.executable, "-m", "tabletop", *map(str, arguments)], check=True, stdout=subprocess.DEVNULL)


class Killer:
    """Kills a node once so much of the work is done."""

    def __init__(self, cluster: Cluster, after: int):
        self.cluster, self.after = cluster, after
        self.node = cluster.add_node(num_cpus=2)

    def __call__(self, done: int) -> None:
        if done >= self.after and self.node:
            self.cluster.remove_node(self.node, allow_graceful=False)
            self.node = None
            print(f"killed a node when {done} were done", flush=True)

    def watch(self, folder: pathlib.Path) -> threading.Thread:
        """Counts the demonstrations of a folder in a thread of its own."""

        def count() -> None:
            while self.node:
                self(sum(1 for made in folder.glob("shard-*/[0-9]*")))
                time.sleep(0.05)

        thread = threading.Thread(target=count)
        thread.start()
        return thread


def differences(one: pathlib.Path, other: pathlib.Path) -> list[str]:
    """The files of a folder that are not the same in another."""
    names = {str(file.relative_to(folder)) for folder in (one, other) for file in folder.rglob("*") if file.is_file()}
    _, mismatch, errors = filecmp.cmpfiles(one, other, names, shallow=False)
    return sorted(mismatch + errors)


def main() -> None:
    here = str(pathlib.Path(__file__).parent)
    environment = {"env_vars": {"PYTHONPATH": here}}
    cluster = Cluster(initialize_head=True, head_node_args={"num_cpus": 2})
    ray.init(address=cluster.address, runtime_env=environment, log_to_driver=False)

    killer = Killer(cluster, after=EPISODES // 3)
    returns = rollouts(EPISODES, 4, 8, "StackThree", killer)
    assert killer.node is None
    assert sorted(returns) == list(range(EPISODES)), len(returns)
    alone = ray.get(Rollouts.remote("StackThree", 8).run.remote(list(range(500, 508))))
    assert all(returns[seed] == value for seed, value in alone.items()), (alone, returns)
    print(f"{len(returns)} episodes, each once")

    with tempfile.TemporaryDirectory() as folder:
        work = pathlib.Path(folder)
        tabletop("run", "scenarios/stack_three.ron", "--record", work / "demo", "--quiet")
        watched = Killer(cluster, after=DEMONSTRATIONS // 4).watch(work / "many")
        tasks = [
            multiply.options(scheduling_strategy="SPREAD").remote(str(work / "demo"), str(work / "many"), DEMONSTRATIONS, shard, SHARDS)
            for shard in range(SHARDS)
        ]
        made = ray.get(tasks)
        watched.join()
        tabletop("multiply", work / "demo", "--out", work / "once", "--count", DEMONSTRATIONS)
        for number in range(DEMONSTRATIONS):
            shard = work / "many" / f"shard-{number % SHARDS}"
            differ = differences(shard / f"{number:04}", work / "once" / f"{number:04}")
            assert not differ, (number, differ)
        assert sum(made) == DEMONSTRATIONS, made
        print(f"{sum(made)} demonstrations, each once, the same bytes as of one process")
    ray.shutdown()
    cluster.shutdown()


if __name__ == "__main__":
    main()
