"""update_results: tables in pages are what their commands print, and a difference is found."""
import importlib.machinery
import importlib.util
import os
import pathlib
import struct
import subprocess
import tempfile
import unittest

ROOT = pathlib.Path(os.environ["PALPA_ROOT"])
SCRIPTS = ROOT / "tools" / "scripts"
LAB_SCRIPTS = ROOT / "tools" / "lab" / "scripts"

PAGE = """# A page

<!-- results: {command} -->
{body}<!-- end -->

An energy of -3.000 kcal/mol outside.
"""
TABLE = "| mode | force, N | step, ms |\n| --- | --- | --- |\n| 2 | 1.085 | 0.7 |\n| 6 | -0.20 | 0.9 |\n"


def update(root, *options):
    return subprocess.run([SCRIPTS / "update_results", *options], capture_output=True, text=True, check=False,
                          env={**os.environ, "PALPA_ROOT": str(root)})


class UpdateResults(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.root = pathlib.Path(self.folder.name)
        self.page = self.root / "page.md"
        (self.root / "table.txt").write_text(TABLE)

    def tearDown(self):
        self.folder.cleanup()

    def write(self, command, body=""):
        self.page.write_text(PAGE.format(command=command, body=body))

    def test_a_table_is_written_once(self):
        self.write("cat table.txt | columns mode; force, N=force felt, N")

        self.assertEqual(update(self.root).returncode, 0)

        expected = "| mode | force felt, N |\n| --- | --- |\n| 2 | 1.085 |\n| 6 | -0.20 |\n"
        self.assertIn(f"-->\n{expected}<!-- end -->\n\nAn energy", self.page.read_text())
        self.assertEqual(update(self.root, "--check").stdout, "")

    def test_other_output_is_a_block_of_the_lines_asked_for(self):
        self.write("cat table.txt | lines 1[.]0")
        (self.root / "table.txt").write_text("felt 1.085 N\nstep 3 ms\n")

        self.assertEqual(update(self.root).returncode, 0)

        self.assertIn("-->\n```\nfelt 1.085 N\n```\n<!-- end -->", self.page.read_text())

    def test_a_last_digit_may_differ_by_one_and_no_more(self):
        for number, code in (("1.084", 0), ("1.086", 0), ("1.087", 1), ("1.1", 0), ("1.2", 1), ("-1.085", 1), ("1.085e2", 1)):
            with self.subTest(number=number):
                self.write("cat table.txt", TABLE.replace("1.085", number))
                before = self.page.read_text()
                result = update(self.root, "--check")
                self.assertEqual(result.returncode, code, result.stdout)
                self.assertEqual("page.md:3: cat table.txt" in result.stdout, code == 1)
                self.assertEqual(self.page.read_text(), before)

    def test_what_follows_a_table_is_no_row_of_it(self):
        (self.root / "table.txt").write_text(TABLE + "All right.\n")
        self.write("cat table.txt")
        self.assertEqual(update(self.root).returncode, 0)
        self.assertIn("| 0.9 |\n\nAll right.\n<!-- end -->", self.page.read_text())

    def test_larger_inputs_may_be_missing(self):
        self.write("cat $PALPA_DATA/table.txt")
        for folder, lines in (("", 2), (str(self.root), 6)):
            result = subprocess.run([SCRIPTS / "update_results"], check=False, capture_output=True,
                                    env={**os.environ, "PALPA_ROOT": str(self.root), "PALPA_DATA": folder})
            self.assertEqual(result.returncode, 0, result.stderr)
            self.assertEqual(self.page.read_text().partition("An energy")[0].count("\n") - 3, lines)

    def test_what_is_rounded_off_is_zero(self):
        (self.root / "table.txt").write_text("rest 3.1e-15 N\n")
        for number, code in (("2e-16", 0), ("-3.44e-15", 0), ("3.1e-11", 1)):
            self.write("cat table.txt", f"```\nrest {number} N\n```\n")
            self.assertEqual(update(self.root, "--check").returncode, code)

    def test_words_and_rows_count(self):
        for body in (TABLE.replace("mode", "law"), TABLE + "| 7 | 1 | 1 |\n", TABLE.replace("| 6", "| guarded")):
            self.write("cat table.txt", body)
            self.assertEqual(update(self.root, "--check").returncode, 1)

    def test_long_ones_wait_for_the_option(self):
        self.page.write_text(PAGE.format(command="X", body="").replace("results: X", "results long: cat table.txt"))
        self.assertEqual(update(self.root, "--check").returncode, 0)
        self.assertEqual(update(self.root, "--check", "--long").returncode, 1)

    def test_a_command_that_fails_says_so(self):
        for command, error in (("ls no-such-file", "no-such-file"), ("cat table.txt | columns speed", "no 'speed'"),
                               ("cat table.txt | lines wind", "none"), ("cat table.txt | turn 3", "no such step")):
            self.write(command)
            result = update(self.root)
            self.assertEqual(result.returncode, 2)
            self.assertIn(error, result.stderr)

    def test_pages_have_what_their_short_commands_print(self):
        result = update(ROOT, "--check")
        self.assertEqual((result.returncode, result.stdout, result.stderr), (0, "", ""))

    def test_every_results_page_has_marked_results(self):
        for name in ("water/results.md", "hairpin/results.md", "peptide/results.md", "hiv/results.md",
                     "hiv/unbinding.md", "hiv/few-joints.md", "salt-bridge/results.md"):
            self.assertIn("<!-- results:", (ROOT / "scenes" / name).read_text(), name)


def load(name):
    """A script as a module."""
    loader = importlib.machinery.SourceFileLoader(name, str(SCRIPTS / name))
    module = importlib.util.module_from_spec(importlib.util.spec_from_loader(name, loader))
    loader.exec_module(module)
    return module


class Strokes(unittest.TestCase):
    def test_hydrogen_bonds_are_near_and_straight(self):
        is_bond = load("stroke_table").is_bond
        donor, hydrogen = (-1.0, 0.0, 0.0), (0.0, 0.0, 0.0)
        for acceptor, expected in (((2.0, 0.0, 0.0), True), ((2.49, 0.0, 0.0), True), ((2.51, 0.0, 0.0), False),
                                   ((1.1, 1.8, 0.0), True), ((0.9, 1.8, 0.0), False), ((0.0, 2.0, 0.0), False)):
            self.assertEqual(is_bond([donor, hydrogen, acceptor], 0, 1, 2), expected, acceptor)

    def test_frames_of_a_dcd_file_are_found_by_number(self):
        def record(body):
            return struct.pack("<i", len(body)) + body + struct.pack("<i", len(body))
        with tempfile.TemporaryDirectory() as folder:
            file = pathlib.Path(folder) / "a.dcd"
            frames = [[(f + 0.0, f + 0.1), (f + 1.0, f + 1.1), (f + 2.0, f + 2.1)] for f in (0, 10, 20)]
            file.write_bytes(record(b"CORD" + bytes(80)) + record(bytes(84)) + record(struct.pack("<i", 2)) +
                             b"".join(record(struct.pack("<2f", *axis)) for frame in frames for axis in frame))
            found = load("stroke_table").read_dcd(file, {2})
        self.assertEqual(list(found), [2])
        self.assertEqual([round(x, 3) for x in found[2][1]], [20.1, 21.1, 22.1])


class Tables(unittest.TestCase):
    def table(self, *options):
        return subprocess.run([LAB_SCRIPTS / "csv_table", *options], capture_output=True, text=True, check=False)

    def test_medians_and_ranges_of_groups(self):
        with tempfile.TemporaryDirectory() as folder:
            file = pathlib.Path(folder) / "a.csv"
            file.write_text("scene,x\nwater,1.00\nvacuum,7.25\nwater,3.00\nwater,2.00\n")
            rows = self.table(file, "--medians", "scene", "--columns", "x=x, Å").stdout.splitlines()
            self.assertEqual(rows[2], "| x, Å | 2.0 (1.0 to 3.0) | 7.2 (7.2 to 7.2) |")
            self.assertEqual(self.table(file, "--where", "scene=vacuum", "--columns", "x").stdout.splitlines()[2:],
                             ["| 7.25 |"])
            self.assertIn("there are: scene, x", self.table(file, "--columns", "y").stderr)


if __name__ == "__main__":
    unittest.main()
