"""Parts the state of an exported LeRobot dataset, for policies that are told where the objects are: split_state.py DATASET OUT

DATASET is one of `tabletop export --to lerobot … --state both --action joints`. In OUT, `observation.state` are the robot's joints, `observation.environment_state`
the poses of the objects, as in the observations of `--env.obs_type=environment_state_agent_pos`, and there are no pictures.
"""

import json
import shutil
import sys
from pathlib import Path

import pyarrow as pa
import pyarrow.parquet as pq

STATE, OBJECTS, PICTURES = "observation.state", "observation.environment_state", "observation.images."


def main(source: Path, out: Path) -> None:
    info = json.loads((source / "meta/info.json").read_text())
    features = info["features"]
    names, joints = features[STATE]["names"], features["action"]["names"]
    hands = ("left_hand", "right_hand")
    parts = {
        STATE: [names.index(joint) for joint in joints],
        OBJECTS: [at for at, name in enumerate(names) if name not in joints and not name.startswith(hands)],
    }
    shutil.copytree(source, out)
    for name in [name for name in features if name.startswith(PICTURES)]:
        del features[name]
    for part, columns in parts.items():
        features[part] = {**features[STATE], "shape": [len(columns)], "names": [names[at] for at in columns]}
    (out / "meta/info.json").write_text(json.dumps(info, indent=4))

    stats = json.loads((out / "meta/stats.json").read_text())
    whole = stats[STATE]
    for part, columns in parts.items():
        stats[part] = {
            kind: [values[at] for at in columns] if len(values) == len(names) else values for kind, values in whole.items()
        }
    stats = {name: values for name, values in stats.items() if name in features}
    (out / "meta/stats.json").write_text(json.dumps(stats, indent=4))

    for file in out.glob("data/*/*.parquet"):
        table = pq.read_table(file)
        rows = table[STATE].to_pylist()
        for part, columns in parts.items():
            values = pa.array([[row[at] for at in columns] for row in rows], pa.list_(pa.float32(), len(columns)))
            at = table.column_names.index(part) if part in table.column_names else table.num_columns
            table = (table.remove_column(at) if at < table.num_columns else table).add_column(at, part, values)
        table = table.select([name for name in table.column_names if not name.startswith(PICTURES)])
        pq.write_table(table.replace_schema_metadata(None), file)
    for file in out.glob("meta/episodes/*/*.parquet"):
        table = pq.read_table(file)
        kept = [name for name in table.column_names if not name.startswith((f"stats/{STATE}", f"stats/{PICTURES}"))]
        pq.write_table(table.select(kept).replace_schema_metadata(None), file)


if __name__ == "__main__":
    main(Path(sys.argv[1]), Path(sys.argv[2]))
