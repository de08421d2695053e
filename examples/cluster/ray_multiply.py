"""Multiplies a demonstration over the nodes of a Ray cluster, into shards, and joins them: the recordings, and LeRobot datasets of them.

    python examples/cluster/ray_multiply.py DEMO OUT --count 1000 --shards 8

DEMO and OUT are on a file system that all nodes share. A task whose node dies is given to another one, which makes what the
shard still lacks: each demonstration is there once in the end. Without a cluster, Ray starts one on this machine.
"""

import argparse
import pathlib
import shutil
import subprocess
import sys

import ray


@ray.remote(num_cpus=1, max_retries=-1, retry_exceptions=True)
def multiply(demo: str, out: str, count: int, shard: int, shards: int) -> int:
    """Makes a shard; returns the number of its demonstrations."""
    folder = pathlib.Path(out) / f"shard-{shard}"
    tabletop("multiply", demo, "--out", folder, "--count", count, "--shard", f"{shard}/{shards}", "--jobs", 1)
    return sum(1 for made in folder.iterdir() if made.is_dir() and made.name.isdigit())


@ray.remote(num_cpus=1, max_retries=-1, retry_exceptions=True)
def export(out: str, shard: int) -> None:
    """Writes a shard as a LeRobot dataset."""
    dataset = pathlib.Path(out) / f"lerobot-{shard}"
    shutil.rmtree(dataset, ignore_errors=True)
    tabletop("export", f"{out}/shard-{shard}", "--to", "lerobot", dataset)


def tabletop(*arguments: object) -> None:
    """Runs a command of the command line."""
    subprocess.run([sys.executable, "-m", "tabletop", *map(str, arguments)], check=True)


def main() -> None:
    arguments = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    arguments.add_argument("demo")
    arguments.add_argument("out")
    arguments.add_argument("--count", type=int, default=1000)
    arguments.add_argument("--shards", type=int, default=8)
    arguments = arguments.parse_args()
    ray.init(ignore_reinit_error=True)
    work = [
        multiply.remote(arguments.demo, arguments.out, arguments.count, shard, arguments.shards)
        for shard in range(arguments.shards)
    ]
    print(f"{sum(ray.get(work))} demonstrations")
    ray.get([export.remote(arguments.out, shard) for shard in range(arguments.shards)])
    for kind, joined in ("shard", "all"), ("lerobot", "lerobot"):
        parts = [f"{arguments.out}/{kind}-{shard}" for shard in range(arguments.shards)]
        tabletop("dataset", "merge", *parts, "--out", f"{arguments.out}/{joined}")


if __name__ == "__main__":
    main()
