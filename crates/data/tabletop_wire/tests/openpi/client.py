"""Asks the server at a port of this machine with the genuine openpi-client."""

import sys

import numpy as np
from openpi_client.websocket_client_policy import WebsocketClientPolicy

client = WebsocketClientPolicy("127.0.0.1", int(sys.argv[1]))
assert client.get_server_metadata() == {"rate": 15}, client.get_server_metadata()
generator = np.random.default_rng(0)
for number in range(1000):
    state = generator.standard_normal(8).astype(np.float32)
    image = generator.integers(0, 256, (24, 32, 3), dtype=np.uint8)
    sent = {"observation/state": state, "observation/image": image, "prompt": "Lift it.", "nested": {"n": number}}
    answer = client.infer(sent)
    actions = answer["actions"]
    assert actions.shape == (2, 2) and actions.dtype == np.float32
    assert abs(actions[0, 0] - state.astype(np.float64).sum()) < 1e-5
    seen = answer["seen"]
    assert np.array_equal(seen["observation/state"], state)
    assert np.array_equal(seen["observation/image"], image) and seen["observation/image"].dtype == np.uint8
    assert seen["prompt"] == "Lift it." and seen["nested"] == {"n": number}
    assert answer["server_timing"]["infer_ms"] >= 0
try:
    client.infer({"prompt": "Lift it."})
except RuntimeError as error:
    assert '"observation/state" is missing' in str(error), error
    print("1000 answers, 1 refusal")
