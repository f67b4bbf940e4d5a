"""A hairpin taken apart and a peptide led out of its groove, and both back, from outside."""
import csv
import json
import math
import os
import subprocess
import tempfile
import unittest
from pathlib import Path

PROGRAM = os.environ["PALPA_PROGRAM"]
ROOT = Path(os.environ["PALPA_ROOT"])
KCAL_PER_NN_ANGSTROM = 1e-19 * 6.02214076e23 / 4184

# Between the strands, (chain, number, atom): a hydrogen and the oxygen that it is given to, as in 1UBQ.
STRANDS = [(("A", give, "HT2" if give == "1" else "HN"), ("A", take, "O"))
           for give, take in (("1", "17"), ("17", "1"), ("3", "15"), ("15", "3"), ("5", "13"), ("13", "5"))]
# What binds the peptide, as in 2SRC.
GROOVE = [(("A", "118", "HE1"), ("B", "253", "O")), (("A", "136", "HH"), ("B", "250", "O")),
          (("A", "135", "HD21"), ("B", "251", "O")), (("A", "95", "HH11"), ("B", "252", "OG1"))]


def palpa(*arguments):
    return subprocess.run([PROGRAM, *map(str, arguments)], capture_output=True, text=True, check=False)


def lengths(path, bonds):
    rows = [line.split() for line in path.read_text().splitlines() if not line.startswith("*")][1:]
    places = {(row[7], row[8], row[3]): [float(x) for x in row[4:7]] for row in rows}
    return [math.dist(places[a], places[b]) for a, b in bonds]


class PeptideScenes(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)

    def play(self, scene, *options):
        record = self.folder / "record"
        result = palpa("run", scene, "--headless", "--json", "--record", record, "--every", 5, *options)
        self.assertEqual((result.returncode, result.stderr), (0, ""))
        with open(record / "trace.csv", encoding="utf-8") as file:
            rows = [{key: float(value) for key, value in row.items()} for row in csv.DictReader(file)]
        return json.loads(result.stdout), rows

    def at(self, scene, seconds):
        """Where the atoms are after so long."""
        path = self.folder / f"{seconds}.crd"
        drawn = palpa("render", scene, "--time", seconds, "-o", self.folder / f"{seconds}.png",
                      "--size", "64x48", "--coordinates", path)
        self.assertEqual(drawn.returncode, 0, drawn.stderr)
        return path

    def assert_opens_at_rest(self, scene):
        check = palpa("run", "--check", scene)
        self.assertEqual((check.returncode, check.stderr), (0, ""))
        self.assertIn("no problems found", check.stdout)
        self.assertIn(", 0.000 nN", check.stdout)
        self.assertEqual(json.loads(palpa("relax", scene, "--json").stdout)["steps"], 0)

    def assert_felt_calm_and_accounted_for(self, summary, rows, least_N, most_N):
        self.assertEqual(summary["warnings"], [])
        self.assertEqual(summary["steps_not_finite"], 0)
        unknown = {"force_error_estimate_nN", "model_age_angstrom"}  # until the first estimate
        for row in rows:
            self.assertTrue(all(math.isfinite(value) for key, value in row.items() if key not in unknown))
        self.assertGreater(summary["largest_felt_N"], least_N)
        self.assertLess(summary["largest_felt_N"], most_N)
        self.assertLess(summary["ripple_N"], 0.06)  # at the device's edge the hand may clutch as late as that
        self.assertLess(summary["net_work_J"], 1e-3)  # on the hand: none is generated
        # All joints follow: the hand's work is in the energy, but for what snaps set free, which never returns.
        def vector(row, name, unit):
            return [row[f"{name}_{axis}_{unit}"] for axis in "xyz"]

        work, most_lost = 0, 0
        for a, b in zip(rows, rows[1:]):
            forces = zip(vector(a, "force", "nN"), vector(b, "force", "nN"))
            ways = zip(vector(a, "molecule", "angstrom"), vector(b, "molecule", "angstrom"))
            work -= sum((f + g) / 2 * (q - p) for (f, g), (p, q) in zip(forces, ways)) * KCAL_PER_NN_ANGSTROM
            gained = b["potential_kcal_per_mol"] - rows[0]["potential_kcal_per_mol"]
            lost = work - gained
            self.assertGreater(lost, most_lost - 1.5, b["time_s"])  # kcal/mol, of rows 5 ms apart
            most_lost = max(most_lost, lost)

    def test_the_hairpin_opens_and_closes(self):
        scene = ROOT / "scenes/hairpin"
        self.assert_opens_at_rest(scene)
        summary, rows = self.play(scene)
        self.assert_felt_calm_and_accounted_for(summary, rows, 0.05, 2)
        start, apart, end = (lengths(self.at(scene, t), STRANDS) for t in (0, 13.5, 39.9))
        self.assertLess(max(start), 2.5)
        self.assertGreater(min(apart), 5)
        for before, after in zip(start, end):
            self.assertAlmostEqual(before, after, delta=0.1)
        self.assertLess(summary["last_backbone_rmsd_angstrom"], 0.1)
        self.assertAlmostEqual(rows[0]["potential_kcal_per_mol"], rows[-1]["potential_kcal_per_mol"], delta=0.1)

    def test_in_vacuum_it_takes_more_and_is_felt_no_less_calmly(self):
        scene = ROOT / "scenes/hairpin/vacuum.toml"
        self.assert_opens_at_rest(scene)
        summary, rows = self.play(scene)
        self.assert_felt_calm_and_accounted_for(summary, rows, 0.05, 2)
        water, _ = self.play(ROOT / "scenes/hairpin", "--overwrite")
        self.assertGreater(summary["largest_felt_N"], 2 * water["largest_felt_N"])

    def test_the_peptide_leaves_its_groove_and_binds_again(self):
        scene = ROOT / "scenes/peptide"
        self.assert_opens_at_rest(scene)
        summary, rows = self.play(scene)
        self.assert_felt_calm_and_accounted_for(summary, rows, 0.05, 2)
        start, outside, end = (lengths(self.at(scene, t), GROOVE) for t in (0, 11.8, 29.9))
        self.assertLess(max(start), 2.5)
        self.assertGreater(min(outside), 8)
        self.assertLess(max(end), 2.5)
        self.assertGreater(summary["clearance_angstrom"], 8)
        self.assertLess(summary["last_backbone_rmsd_angstrom"], 0.5)
        # Its free end may lie elsewhere.
        self.assertAlmostEqual(rows[0]["potential_kcal_per_mol"], rows[-1]["potential_kcal_per_mol"], delta=5)

    def test_both_are_found_by_name(self):
        for name in ("hairpin", "hairpin/vacuum", "peptide"):
            with self.subTest(name=name):
                check = palpa("run", "--check", name)
                self.assertEqual((check.returncode, check.stderr), (0, ""))


if __name__ == "__main__":
    unittest.main()
