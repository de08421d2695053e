"""Reads what is exported with h5py, pyarrow, and mcap with Foxglove's own schemas."""

import glob
import importlib
import json
import os
import sys

import h5py
import mcap
import pyarrow
import pyarrow.parquet as parquet
from google.protobuf.unknown_fields import UnknownFieldSet
from mcap.reader import make_reader
from mcap_protobuf.decoder import DecoderFactory

def assert_same(ours, theirs):
    """Asserts that a schema in a file is that of Foxglove."""
    described = [
        sorted((it.name, it.number, it.type, it.message_type and it.message_type.full_name) for it in schema.fields)
        for schema in (ours, theirs)
    ]
    assert described[0] == described[1], ours.full_name
    for field in ours.fields:
        other = theirs.fields_by_name[field.name]
        if field.enum_type:
            assert [(it.name, it.number) for it in field.enum_type.values] == [(it.name, it.number) for it in other.enum_type.values]
        if field.message_type:
            assert_same(field.message_type, other.message_type)


def read_robomimic(path):
    """Counts what h5py reads."""
    with h5py.File(path) as file:
        data, frames = file["data"], 0
        for name in data:
            demonstration = data[name]
            count = int(demonstration.attrs["num_samples"])
            for part in ("actions", "states", "dones", "rewards", "obs/state", "obs/head_image", "next_obs/state", "next_obs/head_image"):
                assert demonstration[part].shape[0] == count, (name, part)
            assert abs(demonstration["actions"][:]).max() <= 1.0
            frames += count
        assert frames == data.attrs["total"] > 0
        print(f"h5py {h5py.__version__}: {len(data)} demonstrations, {frames} frames")


def read_lerobot(folder):
    """Counts what pyarrow reads."""
    with open(f"{folder}/meta/info.json") as file:
        info = json.load(file)
    rows = 0
    for path in sorted(glob.glob(f"{folder}/data/*/*.parquet")):
        table = parquet.ParquetFile(path)
        episodes = table.read(["episode_index"])["episode_index"].to_pylist()
        assert table.num_row_groups == len(set(episodes)), "a row group is no episode"
        rows += table.metadata.num_rows
    assert rows == info["total_frames"] > 0
    print(f"pyarrow {pyarrow.__version__}: {info['total_episodes']} episodes, {rows} frames")


def read_mcap(folder):
    """Decodes every message."""
    messages, schemas = 0, set()
    for path in sorted(glob.glob(f"{folder}/*.mcap")):
        with open(path, "rb") as file:
            for schema, channel, message, decoded in make_reader(file, decoder_factories=[DecoderFactory()]).iter_decoded_messages():
                messages += 1
                package, name = schema.name.split(".")
                if package != "foxglove":
                    assert channel.topic in ("/state", "/action") and decoded.DESCRIPTOR.fields
                    continue
                known = getattr(importlib.import_module(f"foxglove_schemas_protobuf.{name}_pb2"), name)()
                known.ParseFromString(message.data)
                assert not len(UnknownFieldSet(known)), name
                if schema.name not in schemas:
                    assert_same(decoded.DESCRIPTOR, known.DESCRIPTOR)
                    schemas.add(schema.name)
    assert messages and len(schemas) >= 2, schemas
    print(f"mcap {mcap.__version__}: {messages} messages with {len(schemas)} of Foxglove's schemas")


for folder in sys.argv[1:]:
    print(os.path.basename(folder))
    for name, read in (("robomimic.hdf5", read_robomimic), ("lerobot", read_lerobot), ("mcap", read_mcap)):
        # What was refused to be exported is not there.
        if os.path.exists(f"{folder}/{name}"):
            read(f"{folder}/{name}")
