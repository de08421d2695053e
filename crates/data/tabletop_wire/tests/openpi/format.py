"""Reads a frame, given in hexadecimal digits, with the genuine format, adds what we never write, and prints the frame of it."""

import sys

import numpy as np
from openpi_client import msgpack_numpy

frame = msgpack_numpy.unpackb(bytes.fromhex(sys.argv[1]))
for dtype, array in frame.items():
    if isinstance(array, np.ndarray):
        assert array.dtype.str == dtype and array.shape == (2, 3), (dtype, array)
assert frame["text"] == "ü" and frame["number"] == 0.1 and frame["whole"] == -70000 and frame["nothing"] is None
frame["scalar"] = np.float32(2.5)
frame["swapped"] = np.array([1.0, -3.0], dtype=">f4")
print(msgpack_numpy.packb(frame).hex())
