"""A program that misbehaves as its parameter `mode` says; else answers a line through `a` at once."""
import json
import os
import sys
import time

hello = json.loads(sys.stdin.readline())
print("a library greets on the standard output")
print(json.dumps({"twinmap": 1}), flush=True)
times = hello["times"]
leak = []
for line in sys.stdin:
    request = json.loads(line)
    answers = []
    for sample in request.get("samples", [request]):
        p = sample["parameters"]
        mode = int(p["mode"])
        leak.append(bytearray(int(p.get("leak", 0))))
        if mode == 1:
            sys.stderr.write("the plant is on fire\n")
            sys.stderr.flush()
            os.abort()
        if mode == 2:
            sys.exit(3)
        if mode == 3:
            time.sleep(1000)
        values = [p["a"] * t for t in times]
        if mode == 4:
            values[-1] = float("nan")
        if mode == 5:
            values.pop()
        if mode == 6:
            print("{no JSON", flush=True)
        answers.append({"failed": "no equilibrium"} if mode == 7 else {"outputs": {"x": values}})
    print(json.dumps({"samples": answers} if "samples" in request else answers[0]), flush=True)
