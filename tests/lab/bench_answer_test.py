"""palpa-lab bench --answer from outside: its rows, its file of poses and its picture, whatever the times are."""
import json
import os
import subprocess
import tempfile
import unittest
import xml.etree.ElementTree
from pathlib import Path

PROGRAM = os.environ["PALPA_LAB"]
ROOT = Path(os.environ["PALPA_ROOT"])
PEPTIDES = ROOT / "tests" / "data" / "two_peptides"
ALL_PAIRS = "default", "near=6", "full-second-order", "paper-40", "paper-all"
CUTOFF = "near=6/cutoff=12", "paper-all/cutoff=12"


def bench(*arguments):
    return subprocess.run([PROGRAM, "bench", *map(str, arguments)], capture_output=True, text=True,
                          stdin=subprocess.DEVNULL)


class BenchAnswer(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(cls.folder.cleanup)
        cls.poses = Path(cls.folder.name) / "poses.txt"
        cls.picture = Path(cls.folder.name) / "answer.svg"
        result = bench(PEPTIDES, "--answer", "--poses", 2, "--json", "--save-poses", cls.poses,
                       "--plot", cls.picture)
        assert result.returncode == 0, result.stderr
        cls.rows = cls.rows_of(result)

    @staticmethod
    def rows_of(result):
        return {row["name"].removeprefix("answer/two_peptides/"): row
                for row in json.loads(result.stdout)["rows"]}

    def poses_with(self, name, old, new):
        text = self.poses.read_text()
        self.assertIn(old, text)
        path = Path(self.folder.name) / name
        path.write_text(text.replace(old, new, 1))
        return path

    def assert_refused(self, *arguments, told):
        result = bench(PEPTIDES, "--answer", *arguments)
        self.assertEqual(result.returncode, 2, result.stdout + result.stderr)
        lines = result.stderr.strip().removeprefix("timing two_peptides").strip().splitlines()
        self.assertEqual(len(lines), 1, result.stderr)
        self.assertIn(told, lines[0])

    def test_has_every_method_and_direction(self):
        names = {*ALL_PAIRS, *CUTOFF, *(name + "/own" for name in CUTOFF)}
        self.assertEqual({name for name in self.rows
                          if "ms=" not in name and not name.startswith(("way", "real-time"))}, names)
        for name in names:
            with self.subTest(name=name):
                for row in self.rows[name], self.rows[name + "/ms=100"]:
                    self.assertLessEqual(row["error_median"], row["error_90"])
                    self.assertLessEqual(row["error"], row["error_90_pN"])
                    # A_f of the scene: 0.5e9 / 1e12 N for a pN.
                    self.assertAlmostEqual(row["error_median_N"] * row["error_90_pN"],
                                           row["error_90_N"] * row["error"])
        ways = {"way"} | {f"way/{sign}{axis}" for sign in "+-" for axis in "xyz"}
        self.assertEqual({name for name in self.rows if name.startswith("way")}, ways)
        real_time = self.rows["real-time"]
        self.assertGreater(real_time["age_90"], 0)
        for key in "missed_share", "error_median", "error_90", "error_rms":
            self.assertGreaterEqual(real_time[key], 0)

    def test_what_relaxes_on_the_whole_energy_finds_the_truth(self):
        self.assertLess(self.rows["full-second-order/ms=100"]["error_median"], 0.02)

    def test_a_cutoff_is_judged_by_both_truths(self):
        by_all, by_own = self.rows["near=6/cutoff=12"], self.rows["near=6/cutoff=12/own"]
        self.assertIn("complete relaxation with the same cutoff", by_own["reference"])
        self.assertIn("complete relaxation;", by_all["reference"])
        self.assertEqual(by_all["median"], by_own["median"])
        self.assertNotEqual(by_all["error"], by_own["error"])

    def test_poses_of_a_file_are_those_that_were_found(self):
        result = bench(PEPTIDES, "--answer", "--no-ways", "--poses-file", self.poses, "--json")
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertNotIn("pose 1 of", result.stderr)
        rows = self.rows_of(result)
        self.assertFalse([name for name in rows if name.startswith("way")])
        # The first step of each method does the same again.
        for name in *ALL_PAIRS, *CUTOFF:
            with self.subTest(name=name):
                self.assertAlmostEqual(rows[name]["error_median"],
                                       self.rows[name]["error_median"], delta=0.01)

    def test_a_file_of_poses_begins_as_declared(self):
        lines = self.poses.read_text().splitlines()
        self.assertEqual(lines[0], "# Palpa poses 1")
        self.assertEqual(lines[1].split()[0], "scene")
        self.assertEqual(lines[1].split()[-1], "12")
        self.assertEqual(lines.count("pose"), 2)
        self.assertEqual(sum(line.startswith("move ") for line in lines), 2 * 2 * 3)

    def test_takes_the_first_poses_of_a_file(self):
        result = bench(PEPTIDES, "--answer", "--no-ways", "--poses-file", self.poses, "--poses", 1,
                       "--table")
        self.assertEqual(result.returncode, 0, result.stderr)
        lines = [line for line in result.stdout.splitlines() if line.startswith("|")]
        self.assertEqual(len({line.count("|") for line in lines}), 1)
        self.assertEqual(len(lines), 2 + len(ALL_PAIRS) + 2 * len(CUTOFF))
        self.assert_refused("--poses-file", self.poses, "--poses", 3, told="has 2 poses")

    def test_poses_that_are_not_the_scenes_are_refused(self):
        text = self.poses.read_text()
        atoms = text.splitlines()[1].split()[1]
        energy = text.splitlines()[3].split()[2]
        for told, path in (
                ("no.txt", Path(self.folder.name) / "no.txt"),
                ("both.crd:1: is not a file of poses", PEPTIDES / "both.crd"),
                (":2: holds poses of another scene", self.poses_with("atoms.txt", f"scene {atoms}", "scene 7")),
                (":4: energy and force differ by -1 kcal/mol",
                 self.poses_with("energy.txt", energy, str(float(energy) + 1)))):
            with self.subTest(told=told):
                self.assert_refused("--poses-file", path, told=told)

    def test_files_are_replaced_on_demand_only(self):
        before = self.poses.read_text(), self.picture.read_text()
        self.assert_refused("--save-poses", self.poses, told="poses.txt: already exists")
        self.assert_refused("--plot", self.picture, told="answer.svg: already exists")
        mine = Path(self.folder.name) / "mine.txt"
        mine.write_text("mine\n")
        for option in "--save-poses", "--plot":
            self.assert_refused(option, mine, "--overwrite", told="was not written by this command")
        result = bench(PEPTIDES, "--answer", "--no-ways", "--poses", 1, "--poses-file", self.poses,
                       "--plot", self.picture, "--overwrite")
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertEqual(self.poses.read_text(), before[0])
        self.assertNotEqual(self.picture.read_text(), before[1])

    def test_options_that_do_not_go_together_are_refused(self):
        for arguments in (("--save-poses", "a", "--poses-file", self.poses),
                          ("--save-poses", "a", "--poses", 0),
                          (PEPTIDES, "--save-poses", "a"),
                          ("--save-poses", "a", "--plot", "a")):
            with self.subTest(arguments=arguments):
                result = bench(PEPTIDES, "--answer", *arguments)
                self.assertEqual(result.returncode, 2, result.stderr)
        self.assertEqual(bench(PEPTIDES, "--plot", "a").returncode, 2)

    def test_the_picture_is_svg_with_a_line_for_each_method(self):
        text = self.picture.read_text()
        self.assertTrue(text.startswith("<!-- Palpa: error against time -->"))
        root = xml.etree.ElementTree.fromstring(text)
        self.assertTrue(root.tag.endswith("svg"))
        words = "".join(root.itertext())
        for label in ("time spent (ms)", "error of the force on the hand (%)", "median",
                      "nine of ten", "exact within 10 Å", "full second order", "BFGS",
                      "paper’s step, 40 active", "cutoff 12 Å, against rest with it"):
            self.assertIn(label, words)


if __name__ == "__main__":
    unittest.main()
