"""Multiplies a demonstration over the nodes of a Ray cluster, into shards, and joins them.

    python examples/cluster/ray_multiply.py DEMO OUT --count 1000 --shards 8

DEMO and OUT are on a file system that all nodes share. A task whose node dies is given to another one, which makes what the
shard still lacks: each demonstration is there once in the end. Without a cluster, Ray starts one on this machine.
"""

import argparse
import pathlib
import subprocess
import sys

import ray


@ray.remote(num_cpus=1, max_retries=-1, retry_exceptions=True)
def multiply(demo: str, out: str, count: int, shard: int, shards: int) -> int:
    """Makes a shard; returns the number of its demonstrations."""
    folder = pathlib.Path(out) / f"shard-{shard}"
    command = ["multiply", demo, "--out", folder, "--count", count, "--shard", f"{shard}/{shards}", "--jobs", 1]
    subprocess.run([sys.executable, "-m", "tabletop", *map(str, command)], check=True)
    return sum(1 for made in folder.iterdir() if made.is_dir() and made.name.isdigit())


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
    shards = sorted(str(shard) for shard in pathlib.Path(arguments.out).glob("shard-*"))
    merge = [sys.executable, "-m", "tabletop", "dataset", "merge", *shards, "--out", f"{arguments.out}/all"]
    subprocess.run(merge, check=True)


if __name__ == "__main__":
    main()
