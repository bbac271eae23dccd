"""The twin in time over HTTP, and MQTT, as a user meets it; what it answers in tests/framework/serve."""
import json
import re
import shutil
import signal
import socket
import subprocess
import tempfile
import unittest
import urllib.error
import urllib.request
from pathlib import Path

from support import EXPERIMENTS, QUICK, TWINMAP, call, run_once, wait_until

CART = EXPERIMENTS / "duffing/cart.yaml"


class Server:
    """A process that serves, at a port of its own."""

    def __init__(self, *arguments):
        self.process = subprocess.Popen(
            [TWINMAP, "serve", *map(str, arguments), "--listen", "127.0.0.1:0"], stderr=subprocess.PIPE, text=True
        )
        self.said = []
        while "serving http" not in self.listen():
            if not self.said[-1]:
                raise RuntimeError("".join(self.said))
        self.url = re.search(r"http://[^,]+", self.said[-1]).group()

    def listen(self):
        self.said.append(self.process.stderr.readline())
        return self.said[-1]

    def __enter__(self):
        return self

    def __exit__(self, *_):
        if self.process.poll() is None:
            self.process.kill()
        self.process.communicate()

    def ask(self, path, body=None, **headers):
        request = urllib.request.Request(self.url + path, body, headers)
        with urllib.request.urlopen(request, timeout=600) as answer:
            return answer.read().decode()

    def post(self, file, query=""):
        return json.loads(self.ask("/measurements" + query, file.read_bytes(), **{"Content-Type": "text/csv"}))

    def stop(self):
        self.process.send_signal(signal.SIGTERM)
        return self.process.wait(timeout=600)


class ServeTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        temporary = tempfile.TemporaryDirectory(prefix="twinmap_serve_")
        cls.addClassCleanup(temporary.cleanup)
        cls.folder = Path(temporary.name)
        cls.run_folder, _ = run_once(CART, *QUICK)
        cls.files = [cls.folder / f"m{k}.csv" for k in (92, 95)]
        for file in cls.files:
            result = call("simulate", CART, "--noise", "--csv", file, f"parameters.k={file.stem[1:]}")
            assert result.returncode == 0, result.stderr

    def test_answers_as_track_does_and_goes_on_after_a_stop(self):
        state = self.folder / "served.h5"
        tracked = call("track", self.run_folder, *self.files, "--state", self.folder / "tracked.h5")
        self.assertEqual(tracked.returncode, 0, tracked.stderr)
        answers = []
        for file in self.files:
            with Server(self.run_folder, "--state", state) as server:
                answers.append(server.post(file, f"?name={file}"))
                self.assertEqual(json.loads(server.ask("/state"))["measurements"], len(answers))
                self.assertEqual(server.stop(), 0)
        self.assertEqual(answers, [json.loads(line) for line in tracked.stdout.splitlines()])

    def test_json_is_what_csv_is(self):
        header, *rows = self.files[0].read_text().splitlines()
        names = header.split(",")
        cells = zip(*(map(float, row.split(",")) for row in rows))
        body = json.dumps({"columns": dict(zip(names, map(list, cells))), "name": "m"}).encode()
        with Server(self.run_folder, "--state", self.folder / "json.h5") as server:
            answer = json.loads(server.ask("/measurements", body, **{"Content-Type": "application/json"}))
        with Server(self.run_folder, "--state", self.folder / "csv.h5") as server:
            self.assertEqual(answer, server.post(self.files[0], "?name=m"))

    def test_says_what_is_wrong_with_a_measurement_and_keeps_the_twin(self):
        with Server(self.run_folder, "--state", self.folder / "wrong.h5") as server:
            for body, says in ((b"t,y\n0,1\n", "x"), (b"", "")):
                with self.assertRaises(urllib.error.HTTPError) as caught:
                    server.ask("/measurements", body, **{"Content-Type": "text/csv"})
                problem = json.loads(caught.exception.read())
                self.assertEqual((caught.exception.code, problem["status"]), (422, 422))
                self.assertIn(says, problem["detail"])
            with self.assertRaises(urllib.error.HTTPError) as caught:
                server.post(self.files[0], "?trial=fast")
            self.assertIn("no trials", json.loads(caught.exception.read())["detail"])
            self.assertEqual(json.loads(server.ask("/state"))["measurements"], 0)

    @unittest.skipUnless(shutil.which("promtool"), "prometheus is not installed")
    def test_metrics_are_what_prometheus_wants(self):
        with Server(self.run_folder, "--state", self.folder / "metrics.h5") as server:
            server.post(self.files[0])
            metrics = server.ask("/metrics")
        checked = subprocess.run(["promtool", "check", "metrics"], input=metrics, capture_output=True, text=True)
        self.assertEqual((checked.returncode, checked.stdout + checked.stderr), (0, ""))

    def test_wrong_options_are_errors(self):
        token = self.folder / "token"
        token.write_text("short\n")
        for arguments, says in (
            (["--listen", "0.0.0.0:0"], "give --token-file"),
            (["--listen", "here"], "has no port"),
            (["--token-file", token], "can be read or written by all users"),
            (["--mqtt", "localhost"], "--topic"),
        ):
            result = call("serve", self.run_folder, "--state", self.folder / "no.h5", *arguments)
            self.assertEqual(result.returncode, 2, result.stderr)
            self.assertIn(says, result.stderr)
        self.assertFalse((self.folder / "no.h5").exists())

    @unittest.skipUnless(shutil.which("mosquitto") and shutil.which("mosquitto_pub"), "mosquitto is not installed")
    def test_takes_measurements_by_mqtt(self):
        with socket.socket() as free:
            free.bind(("127.0.0.1", 0))
            port = free.getsockname()[1]
        options = self.folder / "mosquitto.conf"
        options.write_text(f"listener {port} 127.0.0.1\nallow_anonymous true\n")
        broker = subprocess.Popen(["mosquitto", "-c", str(options)], stderr=subprocess.DEVNULL)
        self.addCleanup(broker.wait)
        self.addCleanup(broker.terminate)
        client = ["-h", "127.0.0.1", "-p", str(port), "-q", "1"]
        knock = ["mosquitto_pub", *client, "-t", "x", "-m", "x"]
        wait_until(lambda: subprocess.run(knock, capture_output=True).returncode == 0, broker)
        listener = subprocess.Popen(
            ["stdbuf", "-oL", "mosquitto_sub", *client, "-t", "plant/cart/answer", "-C", "2", "-d"],
            stdout=subprocess.PIPE,
            text=True,
        )
        wait_until(lambda: "SUBACK" in listener.stdout.readline(), listener)
        state = self.folder / "mqtt.h5"
        with Server(
            self.run_folder, "--state", state, "--mqtt", f"127.0.0.1:{port}", "--topic", "plant/cart"
        ) as server:
            wait_until(lambda: "subscribed" in server.listen(), server.process)
            for message in (["-f", str(self.files[0])], ["-m", "{"]):
                subprocess.run(["mosquitto_pub", *client, "-t", "plant/cart", *message], check=True)
            lines = listener.communicate(timeout=600)[0].splitlines()
            answers = [json.loads(line) for line in lines if line.startswith("{")]
            self.assertIn(answers[0]["status"], ("ok", "noise_smaller", "noise_larger"))
            self.assertIn("cannot be read as JSON", answers[1]["error"])
            self.assertEqual(json.loads(server.ask("/state"))["measurements"], 1)
            self.assertEqual(server.stop(), 0)


if __name__ == "__main__":
    unittest.main()
