"""palpa-lab bench --adaptive from outside: its rows, whatever the times are."""
import json
import os
import subprocess
import tempfile
import unittest
from pathlib import Path

PROGRAM = os.environ["PALPA_LAB"]
ROOT = Path(os.environ["PALPA_ROOT"])
PEPTIDES = ROOT / "tests" / "data" / "two_peptides"
WEIGHTS = "plain", "single", "near-hand"


def bench(*arguments):
    return subprocess.run([PROGRAM, "bench", *map(str, arguments)], capture_output=True, text=True,
                          stdin=subprocess.DEVNULL)


class BenchAdaptive(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        result = bench(PEPTIDES, "--adaptive", "--poses", 1, "--stroke-steps", 40, "--json")
        assert result.returncode == 0, result.stderr
        cls.json = result.stdout
        cls.rows = {row["name"].removeprefix("adaptive/two_peptides/"): row
                    for row in json.loads(result.stdout)["rows"]}

    def test_has_every_count_cutoff_and_weight(self):
        names = {f"active=all/{cutoff}" for cutoff in ("all-pairs", "cutoff=12")}
        for cutoff in "all-pairs", "cutoff=12":
            names.add(f"active=0/{cutoff}")
            # 32 coordinates: more than that is all.
            names |= {f"active={n}/{cutoff}/{w}" for n in (10, 20) for w in WEIGHTS}
        for name in names:
            with self.subTest(name=name):
                self.assertEqual(self.rows[name]["unit"], "us")
                self.assertGreater(self.rows[name]["p10"], 0)
                for error in "local-force", "local-rest", "local-position", "path":
                    self.assertGreaterEqual(self.rows[f"{name}/{error}"]["error"], 0)
        with_errors = {name.removesuffix("/path") for name in self.rows if name.endswith("/path")}
        self.assertEqual(with_errors, names)

    def test_all_joints_and_all_pairs_in_double_are_the_reference(self):
        for error in "local-force", "local-position", "path":
            self.assertLess(self.rows[f"active=all/all-pairs/{error}"]["p90"], 1e-9)

    def test_what_is_left_out_is_told_and_felt(self):
        for cutoff in "all-pairs", "cutoff=12":
            nothing = self.rows[f"active=0/{cutoff}"]["reference"]
            self.assertIn(" 0 active, 0.0 of them backbone, 1 of the metric", nothing)
            self.assertGreater(self.rows[f"active=0/{cutoff}/local-force"]["median"],
                               self.rows[f"active=20/{cutoff}/single/local-force"]["median"])
            self.assertGreater(self.rows[f"active=0/{cutoff}/local-position"]["median"],
                               self.rows[f"active=20/{cutoff}/single/local-position"]["median"])
        self.assertIn(" 16.0 of them backbone", self.rows["active=all/all-pairs"]["reference"])

    def test_runs_that_begin_apart_end_apart(self):
        self.assertGreater(self.rows["floor"]["error"], 0)

    def test_more_neglected_is_more_wrong(self):
        for weights in WEIGHTS:
            row = self.rows[f"relation/all-pairs/{weights}/position"]
            self.assertIn("2 points", row["reference"])
            self.assertAlmostEqual(row["median"], 1)

    def test_the_best_choice_misses_less_with_more_joints(self):
        result = bench(PEPTIDES, "--adaptive", "--best", "--json")
        self.assertEqual(result.returncode, 0, result.stderr)
        rows = {row["name"].removeprefix("adaptive/two_peptides/best/active="): row
                for row in json.loads(result.stdout)["rows"]}
        self.assertEqual(list(rows), ["0", "10", "20", "all"])
        wrong = [row["error"] for row in rows.values()]
        self.assertEqual(wrong, sorted(wrong, reverse=True))
        self.assertGreater(wrong[0], wrong[2])
        self.assertEqual(rows["all"]["error"], 0)
        # What all joints really do when the hand has moved by 0.1 Å.
        moved = self.rows["active=all/all-pairs/local-rest"]["reference"].split()[-2]
        self.assertAlmostEqual(float(moved) / (0.1 * rows["all"]["median"]), 1, delta=0.15)

    def test_prints_a_table(self):
        result = bench(PEPTIDES, "--adaptive", "--poses", 1, "--stroke-steps", 20, "--table")
        lines = [line for line in result.stdout.splitlines() if line.startswith("|")]
        self.assertEqual(len({line.count("|") for line in lines}), 1)
        self.assertEqual(len(lines), 2 + 2 * 8)

    def test_is_drawn(self):
        with tempfile.TemporaryDirectory() as folder:
            rows, image = Path(folder) / "rows.json", Path(folder) / "image.png"
            rows.write_text(self.json)
            draw = [ROOT / "tools" / "lab" / "scripts" / "plot_adaptive", rows, image]
            self.assertEqual(subprocess.run(draw, stdout=subprocess.DEVNULL).returncode, 0)
            self.assertEqual(image.read_bytes()[:8], b"\x89PNG\r\n\x1a\n")
            rows.write_text("{}")
            self.assertEqual(subprocess.run(draw, stderr=subprocess.DEVNULL).returncode, 2)

    def test_spheres_need_a_residue_in_the_hand(self):
        result = bench(PEPTIDES, "--adaptive", "--spheres")
        self.assertEqual(result.returncode, 2)
        self.assertIn("expected a residue in the hand", result.stderr)


if __name__ == "__main__":
    unittest.main()
