"""Spelling: pages by aspell, all text by codespell; terms of ours are in tests/tools/words. Style:
wordy phrases and doubled words by diction, but those reviewed in words/allowed-phrases.txt, and phrases
of our own that a reader would have to guess (words/private-phrases.txt)."""
import os
import pathlib
import re
import shutil
import subprocess
import unittest

ROOT = pathlib.Path(os.environ["PALPA_ROOT"])
WORDS = ROOT / "tests" / "tools" / "words"
TEXT = {".md", ".h", ".cpp", ".py", ".toml", ".txt", ".vert", ".frag", ".comp", ".glsl", ""}


def text_files():
    for folder in ("engine", "devices", "scenes", "shaders", "tests", "tools"):
        for file in sorted((ROOT / folder).rglob("*")):
            inside = file.relative_to(ROOT).parts
            if file.is_file() and file.suffix in TEXT and "data" not in inside and \
                    "corpus" not in inside and "__pycache__" not in inside:
                yield file
    yield ROOT / "README.md"


def prose(page):
    """Without blocks of code, code in a line and where links lead."""
    text = re.sub(r"^```.*?^```", "", page, flags=re.M | re.S)
    return re.sub(r"\]\([^)]*\)|`[^`]*`|<[^>]*>", " ", text)


def sentences(page):
    """Prose, in which cells of tables end sentences."""
    text = re.sub(r"<!--.*?-->", "", page, flags=re.S)
    return prose(re.sub(r"^[ ]{4}.*$", "", text, flags=re.M)).replace("[", "").replace("|", ". ")


def lines_of(name):
    lines = (WORDS / name).read_text().splitlines()
    return [line for line in lines if line and not line.startswith("#")]


class Spelling(unittest.TestCase):
    @unittest.skipUnless(shutil.which("codespell"), "codespell is not installed")
    def test_no_word_is_misspelled(self):
        result = subprocess.run(["codespell", "-q", "3", "-I", str(WORDS / "not-misspelled.txt"),
                                 *map(str, text_files())],
                                capture_output=True, text=True, check=False)
        self.assertEqual(result.stdout, "")

    @unittest.skipUnless(shutil.which("aspell"), "aspell is not installed")
    def test_pages_have_known_words(self):
        known = set((WORDS / "terms.txt").read_text().lower().split())
        for page in [file for file in text_files() if file.suffix == ".md"]:
            result = subprocess.run(["aspell", "list", "-l", "en_GB", "--ignore=2",
                                     "--encoding=utf-8"], input=prose(page.read_text()),
                                    capture_output=True, text=True, check=True)
            unknown = {re.sub(r"['’]s$", "", word) for word in result.stdout.split()}
            with self.subTest(page=str(page.relative_to(ROOT))):
                self.assertEqual(sorted(word for word in unknown if word.lower() not in known), [])

    @unittest.skipUnless(shutil.which("diction"), "diction is not installed")
    def test_pages_have_no_wordy_phrase(self):
        allowed = set(lines_of("allowed-phrases.txt"))
        for page in [file for file in text_files() if file.suffix == ".md"]:
            result = subprocess.run(["diction", "--ignore-double-words"], input=sentences(page.read_text()),
                                    capture_output=True, text=True, check=False)
            found = set(re.findall(r"\[([^\]]+)\]", result.stdout.lower()))
            with self.subTest(page=str(page.relative_to(ROOT))):
                self.assertRegex(result.stdout, r"sentences? found|[Nn]o phrases")
                self.assertEqual(sorted(found - allowed), [])

    def test_pages_have_no_private_phrase(self):
        phrases = re.compile("|".join(rf"\b{phrase}\b" for phrase in lines_of("private-phrases.txt")), re.I)
        for page in [file for file in text_files() if file.suffix == ".md"]:
            text = " ".join(sentences(page.read_text()).split())
            with self.subTest(page=str(page.relative_to(ROOT))):
                self.assertEqual([text[max(0, match.start() - 40):match.end() + 20]
                                  for match in phrases.finditer(text)], [])


if __name__ == "__main__":
    unittest.main()
