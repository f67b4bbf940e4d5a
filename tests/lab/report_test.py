"""palpa-lab report from outside: one page that holds all it needs, every section, and no missed limit."""
import os
import re
import subprocess
import tempfile
import unittest
import xml.etree.ElementTree
from pathlib import Path

PROGRAM = os.environ["PALPA_LAB"]
ROOT = Path(os.environ["PALPA_ROOT"])
SECTIONS = ("figure-1", "figure-4", "figure-5", "figure-6", "acceptance", "stability", "energy",
            "hard", "figures-7-8", "figure-9", "speed", "answer", "kernels")


def report(*arguments, **options):
    return subprocess.run([PROGRAM, "report", *map(str, arguments)], capture_output=True, text=True,
                          stdin=subprocess.DEVNULL, cwd=ROOT, **options)


class Report(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.tmp = Path(self.folder.name)

    def tearDown(self):
        self.folder.cleanup()

    def test_a_quick_report_is_one_page_without_a_missed_bar(self):
        result = report("--quick", "-o", self.tmp / "report.html")
        self.assertEqual(result.returncode, 0, result.stdout + result.stderr)
        self.assertEqual([path.name for path in self.tmp.iterdir()], ["report.html"])
        page = (self.tmp / "report.html").read_text()
        # Names of XML namespaces alone look like addresses.
        self.assertNotRegex(page, r"""(src|href)\s*=\s*["'](?!#)""")
        self.assertNotRegex(page, r"<script|<link|<img|@import|url\(\s*['\"]?(?!#)")
        for section in SECTIONS:
            with self.subTest(section=section):
                found = re.search(rf'<section id="{section}">(.*?)</section>', page, re.S)
                self.assertIsNotNone(found)
                self.assertRegex(found[1], "<svg|<table")
                self.assertIn("Again: <code>", found[1])
                self.assertIn(f'<a href="#{section}">', page)
        drawings = re.findall("<svg.*?</svg>", page, re.S)
        self.assertGreaterEqual(len(drawings), 8)
        for drawing in drawings:
            xml.etree.ElementTree.fromstring(drawing)
        self.assertNotIn('class="missed"', page)

    def test_bad_input_is_one_line_before_anything_is_played(self):
        page = self.tmp / "report.html"
        nowhere = self.tmp / "nowhere" / "report.html"
        for expected, arguments, options in (
                ("gnuplot-nox", ("-o", page), {"env": {**os.environ, "PATH": str(self.tmp)}}),
                ("one axis", ("-o", page, "--scene", ROOT / "scenes" / "hiv"), {}),
                ("a folder that does not exist", ("-o", nowhere), {}),
                ("is a folder", ("-o", self.tmp), {}),
                ("cannot be written", ("-o", "/proc/report.html"), {}),
                ("typo.toml", ("-o", page, "--hiv", self.tmp / "typo.toml"), {}),
                ("guarded coupling", ("-o", page, "--set", "mode=2"), {}),
                ("start_angstrom", ("-o", page, "--set", "hand.start_angstrom=6"), {}),
                ("sets the path and its duration itself", ("-o", page, "--set", "seconds=3"), {}),
                ("--seed", ("-o", page, "--seed", "-1"), {}),
                ("coupling.modes", ("-o", page, "--set", "coupling.modes=2"), {})):
            with self.subTest(expected=expected):
                result = report("--quick", *arguments, **options)
                self.assertEqual(result.returncode, 2, result.stdout + result.stderr)
                self.assertEqual(len(result.stderr.strip().splitlines()), 1, result.stderr)
                self.assertIn(expected, result.stderr)
                self.assertFalse(page.exists())


if __name__ == "__main__":
    unittest.main()
