"""palpa-lab study from outside: what operators find, its files, that they repeat, its figures, bad input."""
import csv
import json
import math
import os
import struct
import subprocess
import tempfile
import unittest
from pathlib import Path

PROGRAM = os.environ["PALPA_LAB"]
ROOT = Path(os.environ["PALPA_ROOT"])
WATER = ROOT / "scenes" / "water"


def run(*command):
    return subprocess.run([str(word) for word in command], capture_output=True, text=True,
                          stdin=subprocess.DEVNULL)


def read_rows(path):
    with open(path, encoding="utf-8", newline="") as file:
        return list(csv.DictReader(file))


def water_force_newton(distance):
    """The force (N, + outward) between the waters of the scene along their line, from TIP3P's published
    numbers and the places of dimer.crd, and from nothing of the program's."""
    charges = {"OH2": -0.834, "H1": 0.417, "H2": 0.417}
    depths = {"OH2": 0.1521, "H1": 0.046, "H2": 0.046}  # kcal/mol
    half_rmins = {"OH2": 1.7682, "H1": 0.2245, "H2": 0.2245}  # Å
    rows = [line.split() for line in (WATER / "dimer.crd").read_text().splitlines()]
    atoms = {"FIX": [], "MOV": []}
    for row in rows:
        if len(row) == 10 and row[2] == "TIP3":
            atoms[row[7]].append((row[3], tuple(map(float, row[4:7]))))
    force = 0
    for name, (x, y, z) in atoms["MOV"]:
        for other, (ox, oy, oz) in atoms["FIX"]:
            away = (x - 7 + distance - ox, y - oy, z - oz)  # the file has them 7 Å apart
            r = math.hypot(*away)
            depth = math.sqrt(depths[name] * depths[other])
            s6 = ((half_rmins[name] + half_rmins[other]) / r) ** 6
            minus_slope = 12 * depth * (s6 * s6 - s6) / r + 332.0716 * charges[name] * charges[other] / r ** 2
            force += minus_slope * away[0] / r
    return force * 4184 / 6.02214076e23 * 1e10


def water_rest():
    inside, outside = 2.4, 3.0
    while outside - inside > 1e-9:
        middle = (inside + outside) / 2
        if water_force_newton(middle) > 0:
            inside = middle
        else:
            outside = middle
    return inside


class Study(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.tmp = Path(self.folder.name)

    def tearDown(self):
        self.folder.cleanup()

    def study(self, *arguments):
        result = run(PROGRAM, "study", WATER, *arguments)
        self.assertEqual(result.returncode, 0, result.stderr)
        return result.stdout

    def assert_bad_input(self, expected, *arguments):
        result = run(PROGRAM, "study", *arguments)
        self.assertEqual(result.returncode, 2, result.stdout + result.stderr)
        self.assertEqual(len(result.stderr.strip().splitlines()), 1, result.stderr)
        self.assertIn(expected, result.stderr)

    def test_a_row_for_every_trial_and_a_summary_of_them(self):
        folder = self.tmp / "deep" / "study"
        table = self.study("--operators", 2, "--rounds", 2, "--modes", "4,5,guarded", "-o", folder)
        rows = read_rows(folder / "trials.csv")
        summary = json.loads((folder / "summary.json").read_text())
        self.assertEqual(len(rows), 2 * 2 * 3)
        self.assertEqual({row["mode"] for row in rows}, {"4", "5", "guarded"})
        self.assertEqual(summary["period_ms"], 14)
        self.assertEqual([mode["mode"] for mode in summary["modes"]], ["4", "5", "guarded"])
        for mode in summary["modes"]:
            found = [float(row["found_angstrom"]) for row in rows if row["mode"] == mode["mode"]]
            off = [place - summary["rest_angstrom"] for place in found]
            self.assertEqual(mode["trials"], 4)
            self.assertAlmostEqual(mode["distance_angstrom"]["mean"],
                                   sum(map(abs, off)) / 4, places=4)
            self.assertIn(f"| {mode['mode']} | 4 |", table)
        # The place to be found is where the line that was written turns from push to pull.
        line = read_rows(folder / "line.csv")
        outward = [float(row["distance_angstrom"]) for row in line if float(row["force_nN"]) < -1e-4]
        self.assertAlmostEqual(min(outward), summary["rest_angstrom"], delta=0.011)

    def test_an_operator_is_done_where_no_force_is_left_that_it_would_notice(self):
        folder = self.tmp / "study"
        self.study("--operators", 4, "--rounds", 2, "--modes", "4", "--friction", 0, "-o", folder)
        rest = json.loads((folder / "summary.json").read_text())["rest_angstrom"]
        self.assertAlmostEqual(rest, water_rest(), places=4)
        rows = read_rows(folder / "trials.csv")
        self.assertEqual(len(rows), 8)
        for row in rows:
            with self.subTest(participant=row["participant"], round=row["round"]):
                found = float(row["found_angstrom"])
                # Mode 4 has 0.64e9 times the force. The dullest notice 0.1 N, and drift a little while
                # they wait for a second.
                self.assertLess(abs(0.64e9 * water_force_newton(found)), 0.12)
                self.assertAlmostEqual(float(row["off_angstrom"]), found - water_rest(), places=4)
                self.assertLess(abs(found - water_rest()), 0.2)  # far outside nothing is felt either
                # From 4 Å outside at least, at 6 cm/s at most, 1.6 cm/Å, then a second of waiting.
                self.assertGreater(float(row["time_s"]), 4 * 0.016 / 0.06 + 1)
                self.assertEqual(row["is_finished"], "1")

    def test_the_same_seed_gives_the_same_bytes_and_another_one_others(self):
        arguments = ["--operators", 1, "--rounds", 1, "--modes", "4,guarded", "--json"]
        first = self.study(*arguments)
        self.assertEqual(first, self.study(*arguments))
        self.assertNotEqual(first, self.study(*arguments, "--seed", 2))

    def test_the_figures_are_drawn_from_the_folder(self):
        folder = self.tmp / "study"
        self.study("--operators", 2, "--rounds", 1, "-o", folder)
        result = run(ROOT / "tools" / "lab" / "scripts" / "plot_study", folder, 2)
        self.assertEqual(result.returncode, 0, result.stderr)
        for name, size in (("figure7.png", (1100, 440)), ("figure8.png", (900, 560))):
            data = (folder / name).read_bytes()
            self.assertEqual(struct.unpack(">II", data[16:24]), size)
        self.assertEqual(run(ROOT / "tools" / "lab" / "scripts" / "plot_study", folder, 3).returncode, 2)
        self.assertEqual(run(ROOT / "tools" / "lab" / "scripts" / "plot_study", self.tmp).returncode, 2)

    def test_forced_choices_have_a_row_for_every_pair_and_a_fit_for_every_mode(self):
        folder = self.tmp / "choices"
        table = self.study("--operators", 1, "--forced-choice", "attracts-more", "--modes", "4,5",
                           "--repeats", 3, "-o", folder)
        rows = read_rows(folder / "choices.csv")
        modes = json.loads((folder / "summary.json").read_text())["modes"]
        self.assertEqual([mode["mode"] for mode in modes], ["4", "5"])
        self.assertIn("hardly depend on the ratio", table)
        for mode in modes:
            own = [row for row in rows if row["mode"] == mode["mode"]]
            self.assertEqual(len(own), 10 * 3)
            for level in mode["levels"]:
                there = [row for row in own if abs(float(row["ratio"]) - level["ratio"]) < 1e-3]
                self.assertEqual(level["answers"], len(there))
                self.assertEqual(level["more"], sum(int(row["is_more"]) for row in there))
        self.assertEqual(modes[0]["end"], "found")
        self.assertNotIn("threshold_log", modes[1])
        self.assert_bad_input("already exists, so the folder contains a study", WATER, "--operators", 1, "--forced-choice",
                              "stiffer", "-o", folder)

    def test_a_study_is_never_written_over(self):
        folder = self.tmp / "study"
        self.study("--operators", 1, "--rounds", 1, "--modes", "4", "-o", folder)
        before = (folder / "trials.csv").read_bytes()
        self.assert_bad_input("already exists, so the folder contains a study", WATER, "--operators", 2, "-o", folder)
        self.assertEqual((folder / "trials.csv").read_bytes(), before)
        for name in ("trials.csv", "summary.json", "line.csv"):
            with self.subTest(name=name):
                folder = self.tmp / name
                folder.mkdir()
                (folder / name).write_text("mine")
                self.assert_bad_input("already exists, so the folder contains a study", WATER, "-o", folder)
                self.assertEqual((folder / name).read_text(), "mine")

    def test_bad_input_is_one_line(self):
        self.assert_bad_input("expected one of 1, 2", WATER, "--operators", 1, "--modes", "7")
        self.assert_bad_input("each mode once", WATER, "--operators", 1, "--modes", "2,4,2")
        self.assert_bad_input("did you mean 'careful'", WATER, "--operators", 1, "--operator",
                              "carefull")
        self.assert_bad_input("confined to a line", ROOT / "scenes" / "hiv", "--operators", 1)
        self.assert_bad_input("nobody moves the handle", WATER, "--operators", 1, "--hand", "none", "--set",
                              "hand.stroke=hold")
        self.assert_bad_input("--operators", WATER, "--operators", 0)
        self.assert_bad_input("did you mean 'stiffer'", WATER, "--operators", 1,
                              "--forced-choice", "stifer")
        self.assert_bad_input("--rounds", WATER, "--operators", 1, "--rounds", 2,
                              "--forced-choice", "stiffer")
        self.assert_bad_input("--repeats", WATER, "--operators", 1, "--repeats", 2)


if __name__ == "__main__":
    unittest.main()
