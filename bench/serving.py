#!/usr/bin/python3
"""Measures a live twin: several clients post measurements, each after its last answer.

    bench/serving.py fake build/release/tests/framework/serve/twinmap_fake_twin [--answer-ms 1 --commit-ms 5]
    bench/serving.py real build/release/framework/cli/twinmap RUN MEASUREMENT...

Prints measurements a second, the time to an answer at the median and at 99 %, and how much memory the server took
beyond its start. `fake` counts, so that what is measured is the server alone. Of a real twin the clients take turns with
the files, each answer is held against that of `twinmap track` to the same measurements in the order of the answers.
"""
import argparse
import http.client
import json
import re
import signal
import subprocess
import sys
import tempfile
import threading
import time
from pathlib import Path

import numpy as np


def start(arguments, folder):
    """The process and its port."""
    if arguments.what == "fake":
        options = ["0", str(arguments.answer_ms), str(arguments.commit_ms)]
        process = subprocess.Popen(
            [arguments.program, *options], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True
        )
        return process, int(process.stdout.readline())
    options = ["--state", str(folder / "serve.h5"), "--listen", "127.0.0.1:0"]
    process = subprocess.Popen([arguments.program, "serve", arguments.run, *options], stderr=subprocess.PIPE, text=True)
    while not (found := re.search(r"serving http://127.0.0.1:(\d+)", line := process.stderr.readline())):
        if not line:
            sys.exit("the server did not start")
    return process, int(found.group(1))


def stop(process, what):
    process.stdin.close() if what == "fake" else process.send_signal(signal.SIGTERM)
    if process.wait() != 0:
        sys.exit(f"the server ended with {process.returncode}")


def get_memory(process):
    return int(re.search(r"VmRSS:\s+(\d+)", Path(f"/proc/{process.pid}/status").read_text()).group(1)) / 1024


def post(port, bodies, answers, lock):
    """Posts until no body is left; (time, name, answer) of each is added."""
    connection = http.client.HTTPConnection("127.0.0.1", port)
    while True:
        with lock:
            if not bodies:
                return
            name, body = bodies.pop()
        begin = time.perf_counter()
        connection.request("POST", f"/measurements?name={name}", body, {"Content-Type": "text/csv"})
        response = connection.getresponse()
        text = response.read()
        took = time.perf_counter() - begin
        if response.status != 200:
            sys.exit(f"{response.status}: {text.decode()}")
        with lock:
            answers.append((took, name, text))


def compare(arguments, answers, folder):
    """Tracks the same measurements in the order in which they were answered."""
    answers = sorted(answers, key=lambda answer: json.loads(answer[2])["track"]["measurements"])
    files = [answer[1] for answer in answers]
    command = [arguments.program, "track", arguments.run, *files, "--state", str(folder / "track.h5")]
    tracked = subprocess.run(command, capture_output=True, text=True)
    same = sum(a == b[2].decode().strip() for a, b in zip(tracked.stdout.splitlines(), answers))
    print(f"{same} of {len(answers)} answers are those of track, bit for bit")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("what", choices=["fake", "real"])
    parser.add_argument("program")
    parser.add_argument("run", nargs="?")
    parser.add_argument("files", nargs="*")
    parser.add_argument("--clients", type=int, default=8)
    parser.add_argument("--measurements", type=int, default=10000)
    parser.add_argument("--answer-ms", type=int, default=0)
    parser.add_argument("--commit-ms", type=int, default=0)
    arguments = parser.parse_args()
    files = [(name, Path(name).read_bytes()) for name in arguments.files] or [("m.csv", b"t,x\n0,1\n")]
    count = arguments.measurements if arguments.what == "fake" else len(files)
    bodies, answers, lock = [files[i % len(files)] for i in range(count)], [], threading.Lock()
    with tempfile.TemporaryDirectory() as name:
        process, port = start(arguments, Path(name))
        memory, begin = get_memory(process), time.perf_counter()
        clients = [threading.Thread(target=post, args=(port, bodies, answers, lock)) for _ in range(arguments.clients)]
        for client in clients:
            client.start()
        for client in clients:
            client.join()
        seconds = time.perf_counter() - begin
        times = 1000 * np.array([took for took, _, _ in answers])
        print(
            f"{len(answers)} answers, {len(answers) / seconds:.0f} a second; {np.median(times):.2f} ms at the median,"
        )
        print(f"{np.quantile(times, 0.99):.2f} ms at 99 %; {get_memory(process) - memory:.1f} MiB above the start")
        stop(process, arguments.what)
        if arguments.what == "real":
            compare(arguments, answers, Path(name))


if __name__ == "__main__":
    main()
