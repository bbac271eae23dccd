"""Takes `work` seconds of processor time for each sample, and waits `wait` seconds."""
import json
import sys
import time

hello = json.loads(sys.stdin.readline())
print(json.dumps({"twinmap": 1}), flush=True)
for line in sys.stdin:
    p = json.loads(line)["parameters"]
    end = time.process_time() + p["work"]
    while time.process_time() < end:
        pass
    time.sleep(p["wait"])
    x = [1.0 + p["a"] * t for t in hello["times"]]
    print(json.dumps({"outputs": {"x": x}}), flush=True)
