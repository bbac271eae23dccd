"""The documents as a site: every page is there, every link holds, the search knows the pages."""
import json
import os
import re
import shutil
import subprocess
import tempfile
import unittest
from pathlib import Path

SOURCE = Path(os.environ["TWINMAP_SOURCE_DIR"])


@unittest.skipIf(shutil.which("mkdocs") is None, "mkdocs is not installed: scripts/install-dependencies docs")
class Site(unittest.TestCase):
    def test_has_every_page_in_its_search(self):
        with tempfile.TemporaryDirectory(prefix="twinmap_site_") as folder:
            command = ["/usr/bin/python3", SOURCE / "scripts/docs", folder]
            result = subprocess.run(command, capture_output=True, text=True)
            self.assertEqual(result.returncode, 0, result.stdout + result.stderr)
            found = {
                entry["location"] for entry in json.loads(Path(folder, "search/search_index.json").read_text())["docs"]
            }
            for page in (SOURCE / "docs").rglob("*.md"):
                self.assertIn(str(page.relative_to(SOURCE / "docs").with_suffix(".html")), found)
            for page in Path(folder).rglob("*.html"):  # nothing is loaded from elsewhere
                text = page.read_text()
                self.assertNotRegex(text, r"<(?:script|link|img)[^>]+(?:src|href)=.https?://(?!twinmap)")
                script = re.search(r"'file:' && document.write\('<script src=\"([^\"]*)\">", text)
                self.assertTrue((page.parent / script[1]).resolve().is_file(), page)


if __name__ == "__main__":
    unittest.main()
