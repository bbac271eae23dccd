"""Many processes simulate into one store at once and are killed at random moments.

Of 40 kills in each file system, 200 with TWINMAP_WHOLE_BARS=1, each commit has its part (tests/case_turns.py).
"""
import os
import random
import shutil
import subprocess
import tempfile
import time
import unittest
from pathlib import Path

from case_turns import SEED, count_turn

CHILD = os.environ["SIMULATION_CHILD"]
KILLS = 200 if os.environ.get("TWINMAP_WHOLE_BARS") else 40
WRITERS, CHUNK = 20, 3


class ManyWriters(unittest.TestCase):
    def start(self, folder, writer):
        """A process that simulates every 20th block of points, and then says which are saved."""
        arguments = [CHILD, folder, self.samples, 1, CHUNK, 300, writer, WRITERS]
        return subprocess.Popen(list(map(str, arguments)), stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)

    def kill_at_random(self, folder):
        choose = random.Random(SEED)
        writers = [self.start(folder, writer) for writer in range(WRITERS)]
        for _ in range(self.kills):
            time.sleep(choose.uniform(0.0, 0.04))
            victim = choose.randrange(WRITERS)
            writers[victim].kill()
            writers[victim].communicate()
            writers[victim] = self.start(folder, victim)
        for writer in writers:
            self.assertEqual(writer.communicate(timeout=600)[1], "")
            self.assertEqual(writer.returncode, 0)

    def check(self, parent):
        self.kills = count_turn(KILLS)
        self.samples = 100 * self.kills
        folder, other = (Path(tempfile.mkdtemp(prefix="twinmap_writers_", dir=parent)) for _ in range(2))
        for one in (folder, other):
            self.addCleanup(shutil.rmtree, one, ignore_errors=True)
        self.kill_at_random(folder)
        self.assertEqual(list(folder.glob("store/*/*.set-aside")), [], "a chunk was seen that was not whole")
        log = [int(line) for line in (folder / "log").read_text().split()]
        saved = [int(line) for line in (folder / "saved").read_text().split()]
        self.assertEqual(set(saved), set(range(1, self.samples + 1)))
        self.assertLessEqual(
            len(log) - len(set(log)), self.kills * CHUNK, "more than the chunks under way was simulated again"
        )
        for one in (folder, other):
            result = subprocess.run([CHILD, one, str(self.samples), "2", "100", "0"], capture_output=True, text=True)
            self.assertEqual(result.returncode, 0, result.stderr)
        self.assertEqual(len((folder / "log").read_text().split()), len(log), "something that was saved is lost")
        self.assertEqual((folder / "responses").read_bytes(), (other / "responses").read_bytes())

    def test_nothing_torn_is_read_and_nothing_saved_is_lost_on_disk(self):
        self.check(None)

    @unittest.skipUnless(os.path.isdir("/dev/shm"), "there is no tmpfs")
    def test_nothing_torn_is_read_and_nothing_saved_is_lost_on_tmpfs(self):
        self.check("/dev/shm")
