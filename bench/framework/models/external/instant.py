"""Answers 200 values at once: the first line's are ready, so what is left is the cost of the conversation."""
import json
import sys

hello = json.loads(sys.stdin.readline())
print(json.dumps({"twinmap": 1}), flush=True)
count = len(hello["times"])
answer = json.dumps(
    {"outputs": {"x": [(i + 0.1) / 7 for i in range(count)], "y": [(i + 0.1) / 13 for i in range(count)]}}
)
for line in sys.stdin:
    json.loads(line)
    print(answer, flush=True)
