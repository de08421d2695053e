"""Reads what is exported with h5py, pyarrow and mcap."""

import glob
import json
import sys

import h5py
import mcap
import pyarrow
import pyarrow.parquet as parquet
from mcap.reader import make_reader

folder = sys.argv[1]

with h5py.File(f"{folder}/robomimic.hdf5") as file:
    data, frames = file["data"], 0
    for name in data:
        demonstration = data[name]
        count = int(demonstration.attrs["num_samples"])
        for part in ("actions", "states", "dones", "rewards", "obs/state", "obs/head_image"):
            assert demonstration[part].shape[0] == count, (name, part)
        assert abs(demonstration["actions"][:]).max() <= 1.0
        frames += count
    assert frames == data.attrs["total"] > 0
    print(f"h5py {h5py.__version__}: {len(data)} demonstrations, {frames} frames")

with open(f"{folder}/lerobot/meta/info.json") as file:
    info = json.load(file)
rows = 0
for path in sorted(glob.glob(f"{folder}/lerobot/data/*/*.parquet")):
    table = parquet.ParquetFile(path)
    episodes = table.read(["episode_index"])["episode_index"].to_pylist()
    assert table.num_row_groups == len(set(episodes)), "a row group is no episode"
    rows += table.metadata.num_rows
assert rows == info["total_frames"] > 0
print(f"pyarrow {pyarrow.__version__}: {info['total_episodes']} episodes, {rows} frames")

messages = 0
for path in sorted(glob.glob(f"{folder}/mcap/*.mcap")):
    with open(path, "rb") as file:
        for schema, channel, message in make_reader(file).iter_messages():
            json.loads(message.data)
            messages += 1
assert messages
print(f"mcap {mcap.__version__}: {messages} messages")
