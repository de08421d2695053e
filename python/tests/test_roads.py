"""Every kind of recording, as the table of roads has made them: `cargo test --release --test roads` leaves them in `target/tmp/roads`."""

import json
import os
import pathlib

import pytest
import tabletop

FOLDER = os.environ.get("TABLETOP_RECORDINGS")
KINDS = sorted(it.parent for it in pathlib.Path(FOLDER).glob("*/0.txt")) if FOLDER else []


@pytest.mark.skipif(not KINDS, reason="TABLETOP_RECORDINGS names no folder of recordings")
@pytest.mark.parametrize("kind", KINDS, ids=lambda it: it.name)
def test_every_kind_of_recording_is_read(kind):
    if not (kind / "session.jsonl").exists():
        with pytest.raises(tabletop.Error, match="no recording"):
            tabletop.Recording(kind)
        return
    recording = tabletop.Recording(kind)
    frames = list(recording.frames())
    assert frames and frames[0].picture().shape[2] == 3
    assert all(frame.path.exists() for frame in frames)
    assert recording.header == json.loads((kind / "session.jsonl").read_text().splitlines()[0])
    segments = [segment for segment, _ in recording.events()]
    assert segments == sorted(segments)
    states = recording.states()
    assert len({len(column) for column in states.values()}) == 1
    sentences = [step["sentence"] for step in recording.task["task"]["steps"]]
    assert all(sentence.endswith(".") for sentence in sentences)
