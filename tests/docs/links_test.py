"""Every link of the documents leads somewhere: to a file of the tree and, after '#', to a heading of it."""
import os
import re
import unicodedata
import unittest
from pathlib import Path

SOURCE = Path(os.environ["TWINMAP_SOURCE_DIR"])
TOP = ("README.md", "CONTRIBUTING.md", "CHANGELOG.md", "bench/README.md")
LINK = re.compile(r"\]\(([^()\s]+)\)")
MENTION = re.compile(r"\bdocs/[\w./-]*\.md\b")
CODE = re.compile(r"^```.*?^```", re.MULTILINE | re.DOTALL)
SOURCES = {".cpp", ".hpp", ".c", ".h", ".py", ".yaml", ".js", ".md", ".cmake", ".txt", ".patch"}


def list_documents():
    return [*sorted((SOURCE / "docs").rglob("*.md")), *(SOURCE / name for name in TOP)]


def make_anchor(title):
    """As GitHub and MkDocs make it: lower case, no punctuation, hyphens for blanks."""
    text = unicodedata.normalize("NFKC", re.sub(r"[`*]|\]\([^)]*\)|\[", "", title)).strip().lower()
    return re.sub(r"\s", "-", re.sub(r"[^\w\s-]", "", text))


def list_anchors(document):
    text = CODE.sub("", document.read_text())
    return {make_anchor(title) for title in re.findall(r"^#+ (.*)$", text, re.MULTILINE)}


class Links(unittest.TestCase):
    def test_lead_to_a_file_and_a_heading(self):
        for document in list_documents():
            for target in LINK.findall(CODE.sub("", document.read_text())):
                if re.match(r"[a-z]+:", target):
                    continue
                path, _, anchor = target.partition("#")
                file = document if not path else (document.parent / path).resolve()
                with self.subTest(document=document.name, target=target):
                    self.assertTrue(file.exists())
                    if anchor:
                        self.assertIn(anchor, list_anchors(file))

    def test_documents_named_in_the_sources_exist(self):
        for folder in ("framework", "kernels", "experiments", "tests", "bench", "scripts", "docs", "cmake"):
            for file in (SOURCE / folder).rglob("*"):
                if not file.is_file() or (file.suffix and file.suffix not in SOURCES):
                    continue
                for name in MENTION.findall(file.read_text(errors="ignore")):
                    with self.subTest(file=str(file.relative_to(SOURCE))):
                        self.assertTrue((SOURCE / name).exists(), name)


if __name__ == "__main__":
    unittest.main()
