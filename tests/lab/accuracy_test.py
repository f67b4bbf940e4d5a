"""palpa-lab accuracy from outside: what holds and what is not met, on water and on two peptides."""
import json
import os
import subprocess
import tempfile
import unittest
from pathlib import Path

PROGRAM = os.environ["PALPA_PROGRAM"]
LAB = os.environ["PALPA_LAB"]
ROOT = Path(os.environ["PALPA_ROOT"])
WATER = ROOT / "scenes" / "water"
PEPTIDES = ROOT / "tests" / "data" / "two_peptides"
# The hand draws near by 3 Å in two seconds.
NEARER = ["--set", "coupling.mode=guarded", "--set", "coupling.displacement_law=constant",
          "--set", "hand.stroke=path", "--set", "hand.path=[[0.2, 0.0], [2.2, -60.0]]",
          "--set", "run.period_ms=10", "--seconds", "2.5"]


def palpa(*arguments, program=LAB):
    return subprocess.run([program, *map(str, arguments)], capture_output=True, text=True,
                          stdin=subprocess.DEVNULL)


class Feel(unittest.TestCase):
    def rows(self, *arguments):
        result = palpa("accuracy", *arguments, "--json")
        report = json.loads(result.stdout)
        self.assertEqual(result.returncode, 1 if report["unsaid"] else 0)
        return report["rows"]

    def test_water_is_exact_and_within_its_cap(self):
        rows = self.rows(WATER, "--ranges", "20:3000,50:400", "--tolerances", "1", "--samples", 12)
        # Between two steps the field is in single precision.
        too_tight, = self.rows(WATER, "--ranges", "20:3000", "--tolerances", "1e-6", "--samples", 12)
        self.assertLess(too_tight["within_share"], 0.9)
        self.assertEqual(too_tight["unsaid"], [])
        self.assertEqual([row["range_pN"] for row in rows], [[20, 3000], [50, 400]])
        for row in rows:
            self.assertEqual(row["unsaid"], [])
            self.assertEqual(len(row["errors_pN"]), 12)
            self.assertEqual(row["within_share"], 1)
            self.assertGreaterEqual(row["ends_N"][0], 0.3)
            self.assertLessEqual(row["ends_N"][1], 2.7)
            self.assertLessEqual(row["stiffest_share_of_cap"], 1 + 1e-9)
            # 29 N/m at rest, of forces that are felt so large: only the reach can give way.
            self.assertGreater(row["largest_cap_ratio"], 2)
            self.assertTrue(any(what.startswith("reach") for what in row["not_met"]))

    def test_a_tolerance_holds_or_is_said_to_give_way(self):
        loose, tight = self.rows(PEPTIDES, *NEARER, "--ranges", "100:20000", "--tolerances",
                                 "20000,1", "--samples", 5)
        self.assertEqual(loose["within_share"], 1)
        self.assertFalse(any(what.startswith("tolerance") for what in loose["not_met"]))
        self.assertLess(tight["within_share"], 0.9)
        self.assertTrue(any(what.startswith("tolerance") for what in tight["not_met"]))
        self.assertEqual(tight["unsaid"], [])
        self.assertGreater(tight["steps_mean"], loose["steps_mean"])
        # The reference is at rest, though these runs make the paper's steps.
        for row in (loose, tight):
            self.assertLess(row["reference_moving_pN"], 1e-6)

    def test_a_run_tells_it_and_replays_to_the_last_digit(self):
        asked = ["--set", "coupling.feel_pN=[100, 20000]", "--set", "coupling.feel_within_pN=20",
                 "--set", "statics.active=4"]
        with tempfile.TemporaryDirectory() as folder:
            recording = Path(folder) / "recording"
            result = palpa("run", "--headless", PEPTIDES, *NEARER, *asked, "--record", recording, program=PROGRAM)
            self.assertEqual(result.returncode, 0, result.stderr)
            self.assertIn("range       100 to 20000 pN, felt as 0.300 to 2.700 N", result.stdout)
            feel = json.loads((recording / "summary.json").read_text())["feel"]
            self.assertGreater(feel["error_estimates"], 3)
            self.assertEqual(feel["range_pN"], [100, 20000])
            replay = palpa("replay", recording, "--verify", "--json", program=PROGRAM)
            self.assertEqual(replay.returncode, 0, replay.stdout)
            self.assertEqual(json.loads(replay.stdout)["different"], 0)

    def test_what_makes_no_sense_is_refused(self):
        for arguments, what in ((["--ranges", "20"], "is not a range"),
                                (["--ranges", "300:20"], "expected the weaker force first"),
                                (["--set", "coupling.mode=2"], "applies to guarded coupling")):
            with self.subTest(arguments=arguments):
                result = palpa("accuracy", WATER, *arguments)
                self.assertEqual(result.returncode, 2)
                self.assertIn(what, result.stderr)
                self.assertEqual(result.stdout, "")


if __name__ == "__main__":
    unittest.main()
