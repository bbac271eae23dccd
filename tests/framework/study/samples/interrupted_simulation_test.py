"""A simulation that is killed, runs out of disk, finds its chunks damaged, or meets other processes.

The chunks are read here by docs/reference/files.md alone, and the simulated points are in the child's log.
"""
import os
import random
import re
import resource
import shutil
import signal
import struct
import subprocess
import tempfile
import time
import unittest
from pathlib import Path

from case_turns import SEED, take_turn

CHILD = os.environ["SIMULATION_CHILD"]
SAMPLES = 300


def read_points(chunk):
    """First parameter of each sample of a chunk file."""
    data = chunk.read_bytes()
    assert data[:8] == b"twmchunk"
    version, parameters, rows, samples = struct.unpack("<Q16x3Q", data[8:56])
    assert (version, parameters, rows) == (1, 2, 8)
    return [int(point[0]) for point in struct.iter_unpack("<2d", data[56 : 56 + 16 * samples])]


class InterruptedSimulation(unittest.TestCase):
    def setUp(self):
        self.folder = self.make_folder()
        self.random = random.Random(5)

    def make_folder(self):
        folder = tempfile.mkdtemp(prefix="twinmap_interrupted_")
        self.addCleanup(shutil.rmtree, folder, ignore_errors=True)
        return Path(folder)

    def start(self, folder=None, samples=SAMPLES, threads=2, chunk=8, microseconds=0, **options):
        arguments = [CHILD, folder or self.folder, samples, threads, chunk, microseconds]
        return subprocess.Popen(
            list(map(str, arguments)), stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, **options
        )

    def finish(self, *arguments, code=0, **options):
        child = self.start(*arguments, **options)
        out, err = child.communicate(timeout=600)
        self.assertEqual(child.returncode, code, err)
        return out + err

    def list_chunks(self):
        return list(self.folder.glob("store/*/*.chunk"))

    def get_stored(self):
        points = [point for chunk in self.list_chunks() for point in read_points(chunk)]
        self.assertEqual(len(points), len(set(points)))
        return set(points)

    def take_log(self):
        """The points simulated since the last call."""
        path = self.folder / "log"
        points = [int(line) for line in path.read_text().split()] if path.exists() else []
        path.unlink(missing_ok=True)
        return points

    def assert_undisturbed(self, **options):
        other = self.make_folder()
        self.finish(other, threads=1, **options)
        self.assertEqual((self.folder / "responses").read_bytes(), (other / "responses").read_bytes())

    def wait_until(self, reached):
        deadline = time.monotonic() + 300
        while not reached():
            self.assertLess(time.monotonic(), deadline)
            time.sleep(0.002)

    def wait_for_chunk(self):
        self.wait_until(self.list_chunks)

    def wait_for_simulations(self, count):
        """Until the child's log, of a line a simulation, has so many: a busy machine is waited for, too."""
        log = self.folder / "log"
        self.wait_until(lambda: log.exists() and log.read_text().count("\n") >= count)

    def test_killed_at_random_moments_loses_no_finished_chunk_and_changes_no_bit(self):
        many = {"samples": 3000, "chunk": 100}
        rng = random.Random(SEED)
        for i in take_turn(range(30)):
            stored = self.get_stored()
            child = self.start(
                samples=3000,
                threads=rng.choice([1, 2, 3]),
                chunk=rng.choice([1, 2, 5]),
                microseconds=3000,
            )
            if i % 3 > 0:
                self.wait_for_simulations(rng.randrange(1, 40))
            time.sleep(rng.uniform(0.0, 0.01))
            child.kill()
            child.communicate()
            self.assertEqual(child.returncode, -signal.SIGKILL)
            self.assertEqual(stored & set(self.take_log()), set(), "a finished sample was simulated again")
            self.assertLessEqual(stored, self.get_stored())
        stored = self.get_stored()
        self.assertGreater(len(stored), 0)
        self.assertLess(len(stored), 3000)
        self.assertIn(f"reused {len(stored)}", self.finish(**many))
        self.assertEqual(sorted([*stored, *self.take_log()]), list(range(1, 3001)))
        self.assertEqual(list(self.folder.glob("store/*/*.tmp")), [])
        self.assert_undisturbed(**many)

    def test_damaged_chunks_are_simulated_again_and_no_others(self):
        self.finish(chunk=16)
        self.take_log()
        damaged = set()
        for i, chunk in enumerate(self.random.sample(self.list_chunks(), 4)):
            damaged |= set(read_points(chunk))
            data = bytearray(chunk.read_bytes())
            position = self.random.randrange(len(data))
            if i < 2:
                data[position] ^= 1 << self.random.randrange(8)
            else:
                del data[position:]
            chunk.write_bytes(data)
        out = self.finish(chunk=16)
        self.assertEqual(out.count("damaged: "), 4)
        self.assertEqual(sorted(self.take_log()), sorted(damaged))
        self.assert_undisturbed()

    @unittest.skipIf("TSAN_OPTIONS" in os.environ, "under it no program starts its threads where files are limited")
    def test_too_large_a_file_is_an_error_that_names_it_and_loses_nothing(self):
        self.finish(samples=50, chunk=5)
        kept = self.get_stored()
        limits = {
            "preexec_fn": lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (4096, 4096)),
            "restore_signals": False,
        }  # SIGXFSZ stays ignored
        message = self.finish(chunk=100, code=1, **limits)
        self.assertRegex(message, r"/store/\w+/\w+\.chunk\.\S+\.tmp: cannot be written: File too large")
        self.assertLessEqual(kept, self.get_stored())
        self.assertEqual(list(self.folder.glob("store/*/*.tmp")), [])
        self.finish()
        self.assert_undisturbed()

    def test_continues_when_a_full_disk_has_space_again(self):
        probe = subprocess.run(["unshare", "-rm", "mount", "-t", "tmpfs", "none", self.folder], capture_output=True)
        if probe.returncode != 0:
            self.skipTest("no file system of its own: " + probe.stderr.decode())
        result = self.make_folder()
        script = f"""
            mount -t tmpfs -o size=20k none {self.folder} || exit 9
            {CHILD} {self.folder} {SAMPLES} 2 8 0 2>&1; echo "code $?"
            echo "stored $(ls {self.folder}/store/*/*.chunk | wc -l)"
            rm {self.folder}/log; mount -o remount,size=10m {self.folder} || exit 9
            {CHILD} {self.folder} {SAMPLES} 2 8 0 || exit 9
            echo "simulated again $(wc -l <{self.folder}/log)"; cp {self.folder}/responses {result}/"""
        done = subprocess.run(["unshare", "-rm", "sh", "-c", script], capture_output=True, text=True, timeout=600)
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        self.assertRegex(done.stdout, r"\.tmp: cannot be written(?: to disk)?: No space left on device\ncode 1")
        stored, again = (int(re.search(rf"{word} (\d+)", done.stdout)[1]) for word in ("stored", "simulated again"))
        self.assertGreater(stored, 0)
        self.assertEqual(again, SAMPLES - 8 * stored)  # chunks of 8
        shutil.copy(result / "responses", self.folder / "responses")
        self.assert_undisturbed()

    def test_an_interrupt_writes_all_that_was_finished(self):
        child = self.start(microseconds=5000, chunk=4)
        self.wait_for_chunk()
        child.send_signal(signal.SIGINT)
        child.communicate(timeout=300)
        self.assertEqual(child.returncode, 130)
        stored = self.get_stored()
        self.assertEqual(sorted(self.take_log()), sorted(stored))
        self.assertLess(len(stored), SAMPLES)
        self.finish()
        self.assert_undisturbed()

    def test_a_second_process_simulates_into_the_same_store_and_both_end_with_the_same_bits(self):
        first = self.start(microseconds=5000, chunk=2)
        self.wait_for_chunk()
        self.finish(chunk=2)
        self.assertEqual(first.wait(timeout=300), 0)
        first.communicate()
        self.assert_undisturbed()
