"""Crashes for 1 % of the samples, hangs for 0.1 %, answers NaN for 1 %, and leaks 100 kB a sample."""
import json
import os
import sys
import time

hello = json.loads(sys.stdin.readline())
print(json.dumps({"twinmap": 1}), flush=True)
leak = []
for line in sys.stdin:
    a = json.loads(line)["parameters"]["a"]
    leak.append(bytearray(os.urandom(100)) * 1000)
    fate = a * 1e6 % 1000
    if fate < 10:
        os.abort()
    if fate < 11:
        time.sleep(1e6)
    x = [a * t for t in hello["times"]]
    if 11 <= fate < 21:
        x[0] = float("nan")
    print(json.dumps({"outputs": {"x": x, "y": x}}), flush=True)
