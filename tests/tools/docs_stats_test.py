"""docs_stats: the READMEs are within their limits, and too many words are found."""
import os
import pathlib
import subprocess
import tempfile
import unittest

ROOT = pathlib.Path(os.environ["PALPA_ROOT"])
SCRIPT = ROOT / "tools" / "scripts" / "docs_stats"


def count(root):
    return subprocess.run([SCRIPT], capture_output=True, text=True, check=False,
                          env={**os.environ, "PALPA_ROOT": str(root)})


def words(number):
    return "word " * number


class DocsStats(unittest.TestCase):
    def test_pages_are_within_their_limits(self):
        result = count(ROOT)
        self.assertEqual((result.returncode, result.stderr), (0, ""))
        self.assertIn("README.md", result.stdout)

    def test_one_long_readme_is_found(self):
        with tempfile.TemporaryDirectory() as folder:
            root = pathlib.Path(folder)
            (root / "scenes" / "water").mkdir(parents=True)
            (root / "README.md").write_text(words(900))
            (root / "scenes" / "water" / "README.md").write_text(words(900))
            self.assertEqual(count(root).returncode, 0)
            (root / "scenes" / "water" / "README.md").write_text("```\n" + words(899) + "\n```\n")
            result = count(root)
            self.assertEqual(result.returncode, 1)
            self.assertEqual(result.stderr, "scenes/water/README.md: 901 words, at most 900 are allowed\n")

    def test_many_explained_words_are_found(self):
        with tempfile.TemporaryDirectory() as folder:
            root = pathlib.Path(folder)
            (root / "scenes").mkdir()
            table = "# Words\n\n| word | meaning |\n| --- | --- |\n" + "| a | b |\n" * 25
            (root / "scenes" / "words.md").write_text(table)
            self.assertEqual(count(root).returncode, 0)
            (root / "scenes" / "words.md").write_text(table + "| a | b |\n")
            self.assertIn("explains 26 words", count(root).stderr)

    def test_many_readmes_are_found_and_other_pages_are_free(self):
        with tempfile.TemporaryDirectory() as folder:
            root = pathlib.Path(folder)
            for number in range(10):
                (root / "scenes" / str(number)).mkdir(parents=True)
                (root / "scenes" / str(number) / "README.md").write_text(words(900))
                (root / "scenes" / str(number) / "results.md").write_text(words(2000))
            (root / "README.md").write_text("")
            self.assertEqual(count(root).returncode, 0)
            (root / "README.md").write_text("one")
            result = count(root)
            self.assertEqual(result.returncode, 1)
            self.assertIn("9001 words together", result.stderr)


if __name__ == "__main__":
    unittest.main()
