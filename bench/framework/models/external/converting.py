"""Answers 200 values that it converts to text for each sample, as programs do."""
import json
import sys

hello = json.loads(sys.stdin.readline())
print(json.dumps({"twinmap": 1}), flush=True)
for line in sys.stdin:
    a = json.loads(line)["parameters"]["a"]
    outputs = {"x": [a * t for t in hello["times"]], "y": [a + t for t in hello["times"]]}
    print(json.dumps({"outputs": outputs}), flush=True)
