"""The documents stay short and readable: words in all, words of a page, words of a sentence.

Counted is what people wrote: not code, not pages that begin with "<!-- generated" or say "Written by `", not tables that
scripts/reference and benchmarks fill in.
"""
import os
import re
import statistics
import unittest
from pathlib import Path

SOURCE = Path(os.environ["TWINMAP_SOURCE_DIR"])
MOST_WORDS, MOST_OF_A_PAGE, LONGEST_MEDIAN = 30000, 2500, 20


def is_generated(text):
    return text.startswith("<!-- generated") or "\nWritten by `" in text[:600]


def list_pages():
    """(name, text) of the pages that people write."""
    for page in sorted((SOURCE / "docs").rglob("*.md")):
        text = page.read_text()
        if not is_generated(text):
            written = r"<!-- (keys of .*?<!-- end of keys|measured -->.*?<!-- end of what was measured) -->"
            yield str(page.relative_to(SOURCE)), re.sub(written, "", text, flags=re.DOTALL)


def drop_code(text):
    return re.sub(r"^(```.*?^```|    .*?$)", "", text, flags=re.MULTILINE | re.DOTALL)


def count_words(text):
    return len(re.findall(r"\w[\w'.-]*", drop_code(text)))


def list_sentences(text):
    """Numbers of words of the sentences of paragraphs and lists, not of tables and headings."""
    lines = [line for line in drop_code(text).split("\n") if not line.lstrip().startswith(("|", "#", "<!--", "!["))]
    for block in re.split(r"\n\s*\n|\n(?=\s*(?:[-*]|\d+\.) )", "\n".join(lines)):
        plain = re.sub(r"\]\([^)]*\)|[\[*`]", "", " ".join(block.split()))
        for sentence in re.split(r"(?<=[.!?])\s+(?=[A-Z(\"'0-9])", plain):
            words = len(sentence.split())
            if words >= 3:
                yield words


class Readability(unittest.TestCase):
    def test_words_in_all(self):
        total = sum(count_words(text) for _, text in list_pages())
        self.assertLessEqual(total, MOST_WORDS)

    def test_words_of_a_page(self):
        for name, text in list_pages():
            with self.subTest(page=name):
                self.assertLessEqual(count_words(text), MOST_OF_A_PAGE)

    def test_sentences_of_all_pages(self):
        sentences = [words for _, text in list_pages() for words in list_sentences(text)]
        self.assertLessEqual(statistics.median(sentences), LONGEST_MEDIAN)

    def test_sentences_of_a_page(self):
        for name, text in list_pages():
            sentences = list(list_sentences(text))
            with self.subTest(page=name):
                self.assertLessEqual(statistics.median(sentences or [0]), LONGEST_MEDIAN)


if __name__ == "__main__":
    unittest.main()
