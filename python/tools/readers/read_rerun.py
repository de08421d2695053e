"""Converts an MCAP file with Rerun, and looks for what Rerun shows of it."""

import subprocess
import sys
import tempfile
from importlib.metadata import version
from pathlib import Path

path = sys.argv[1]
rerun = Path(sys.executable).with_name("rerun")
with tempfile.TemporaryDirectory() as folder:
    converted = f"{folder}/episode.rrd"
    subprocess.run([rerun, "mcap", "convert", path, "-o", converted], check=True, capture_output=True)
    shown = subprocess.run([rerun, "rrd", "print", converted], check=True, capture_output=True, text=True).stdout
for place, what in [
    ("/camera/head", "EncodedImage:blob"),
    ("/tf", "Transform3D:translation"),
    ("/log", "TextLog:text"),
    ("/scene", "foxglove.SceneUpdate:message"),
    ("/state", "tabletop.State:message"),
    ("/action", "tabletop.Action:message"),
]:
    assert any(f" - {place} - " in line and what in line for line in shown.splitlines()), (place, what)
print(f"Rerun {version('rerun-sdk')}: pictures, transforms, sentences, and numbers with their names")
