"""The documents stay short and readable: words in all, words of a page, words of a sentence. So do docstrings.

Counted is what people wrote: not code, not pages that begin with "<!-- generated" or say "Written by `", not tables that
scripts/reference and benchmarks fill in.
"""
import ast
import os
import re
import statistics
import subprocess
import unittest
from pathlib import Path

SOURCE = Path(os.environ["TWINMAP_SOURCE_DIR"])
MOST_WORDS, MOST_OF_A_PAGE, LONGEST_MEDIAN = 34770, 2500, 20
# A sentence of a docstring has at most 25 words, subject first and condition second. So many have more or begin with a
# condition, from before there was a rule. Who makes them fewer writes the smaller number here.
LONGEST_OF_A_DOCSTRING, LONGER_ONES, CONDITIONS_FIRST = 25, 970, 126
CONDITION = re.compile(r"(If|Where|When|While|Unless|Once|As long as)\b[^.]*,")


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


def split_sentences(text):
    """Sentences of three words or more of paragraphs and lists, not of tables and headings."""
    lines = [line for line in drop_code(text).split("\n") if not line.lstrip().startswith(("|", "#", "<!--", "!["))]
    for block in re.split(r"\n\s*\n|\n(?=\s*(?:[-*]|\d+\.) )", "\n".join(lines)):
        plain = re.sub(r"\]\([^)]*\)|[\[*`]", "", " ".join(block.split()))
        for sentence in re.split(r"(?<=[.!?])\s+(?=[A-Z(\"'0-9])", plain):
            if len(sentence.split()) >= 3:
                yield sentence


def list_sentences(text):
    """Their numbers of words."""
    return (len(sentence.split()) for sentence in split_sentences(text))


def list_docstrings(name):
    """Of a file in C++ or Python, without what is indented in them: formulas and tables."""
    text = (SOURCE / name).read_text()
    if name.endswith((".py", ".pyi")):
        kinds = (ast.Module, ast.ClassDef, ast.FunctionDef)
        found = (ast.get_docstring(node) for node in ast.walk(ast.parse(text)) if isinstance(node, kinds))
        return [re.sub(r"^ .*$", "", one, flags=re.MULTILINE) for one in found if one]
    blocks = re.findall(r"(?:^[ \t]*///.*\n)+", text, flags=re.MULTILINE)
    return [re.sub(r"^[ \t]*/// ?(  .*)?", "", block, flags=re.MULTILINE) for block in blocks]


def list_sources():
    listed = subprocess.run(["git", "ls-files", "framework", "kernels"], cwd=SOURCE, capture_output=True, text=True)
    names = listed.stdout.split() or [str(path.relative_to(SOURCE)) for path in SOURCE.glob("[fk][re]*/**/*")]
    return [name for name in names if name.endswith((".cpp", ".hpp", ".c", ".h", ".py", ".pyi"))]


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


class Docstrings(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.sentences = [
            (len(sentence.split()), name, sentence)
            for name in list_sources()
            for docstring in list_docstrings(name)
            for sentence in split_sentences(docstring)
        ]

    def expect_no_more(self, found, allowed):
        shown = "\n".join(f"{name}: {words} words: {sentence}" for words, name, sentence in sorted(found, reverse=True))
        self.assertLessEqual(len(found), allowed, f"shorten yours, the longest first:\n{shown}")

    def test_sentences(self):
        self.assertLessEqual(statistics.median(words for words, _, _ in self.sentences), LONGEST_MEDIAN)

    def test_sentences_are_short(self):
        self.expect_no_more([one for one in self.sentences if one[0] > LONGEST_OF_A_DOCSTRING], LONGER_ONES)

    def test_the_subject_comes_first(self):
        self.expect_no_more([one for one in self.sentences if CONDITION.match(one[2])], CONDITIONS_FIRST)


if __name__ == "__main__":
    unittest.main()
