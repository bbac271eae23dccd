"""The pages of docs/reference that follow from the program are as scripts/reference writes them."""
import os
import subprocess
import unittest
from pathlib import Path

SOURCE = Path(os.environ["TWINMAP_SOURCE_DIR"])


class Reference(unittest.TestCase):
    def test_is_up_to_date(self):
        command = ["/usr/bin/python3", SOURCE / "scripts/reference", os.environ["TWINMAP"], "--check"]
        result = subprocess.run(command, capture_output=True, text=True)
        self.assertEqual(result.returncode, 0, f"run scripts/reference: {result.stdout}{result.stderr}")


if __name__ == "__main__":
    unittest.main()
