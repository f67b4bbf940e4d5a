"""palpa-lab unbind from outside: what its rows say, on two peptides and on what is refused."""
import json
import os
import subprocess
import unittest
from pathlib import Path

PROGRAM = os.environ["PALPA_LAB"]
ROOT = Path(os.environ["PALPA_ROOT"])
PEPTIDES = ROOT / "tests" / "data" / "two_peptides"


def journey(*arguments):
    return subprocess.run([PROGRAM, "unbind", *map(str, arguments)], capture_output=True,
                          text=True, stdin=subprocess.DEVNULL)


class Journey(unittest.TestCase):
    def test_every_choice_has_a_row(self):
        result = journey(PEPTIDES, "--periods", "14,50", "--hands", "medium,firm", "--modes",
                         "guarded,2", "--active", "10", "--set", "run.seconds=2", "--json")
        report = json.loads(result.stdout)
        rows = report["journeys"]
        self.assertEqual([(r["period_ms"], r["grip"], r["mode"]) for r in rows],
                         [(t, g, m) for t in (14, 50) for g in ("medium", "firm")
                          for m in ("guarded", "2")])
        self.assertEqual(result.returncode, 1 if report["missed"] else 0)
        for row in rows:
            self.assertEqual(row["active"], 10)

    def test_out_and_back_are_where_the_hand_went(self):
        # At a constant 1 cm of the handle for 2 Å, away from the other molecule.
        way = ["--hands", "firm", "--periods", "14", "--modes", "4", "--active", "10", "--json",
               "--set", "coupling.A_d=5e7", "--set", "hand.stroke=path", "--set", "run.seconds=5"]
        for far_mm, end_mm, out, back in ((60, 0, True, True), (60, 60, True, False),
                                          (30, 0, False, False)):
            path = [[0.2, 0], [2.2, far_mm], [2.4, far_mm], [4.4, end_mm]]
            with self.subTest(path=path):
                report = json.loads(journey(PEPTIDES, *way, "--set", f"hand.path={path}").stdout)
                row, = report["journeys"]
                self.assertEqual((row["out"], row["back"]), (out, back))
                self.assertEqual((report["out"], report["back"]), (int(out), int(back)))
                # The other one's attraction holds it back a little.
                self.assertAlmostEqual(row["farthest_angstrom"], 0.2 * far_mm, delta=1.5)
                self.assertEqual("out_s" in row, out)
                self.assertEqual("back_s" in row, back)

    def test_what_is_led_far_and_does_not_get_out_is_a_miss(self):
        for led, what, missed in ((12, [], 1), (6, [], 0), (12, ["--active", "10"], 0)):
            way = ["--hands", "firm", "--periods", "14", "--modes", "guarded", "--json",
                   "--set", "hand.stroke=lead", "--set", f"hand.path=[[0.2,0],[9,{led}]]",
                   "--set", "run.seconds=0.6", *what]
            if not what:
                way += ["--set", "statics.method=second-order"]
            with self.subTest(way=way):
                result = journey(PEPTIDES, *way)
                report = json.loads(result.stdout)
                self.assertEqual((report["out"], report["missed"]), (0, missed))
                self.assertEqual(result.returncode, missed)

    def test_random_ones_repeat(self):
        arguments = PEPTIDES, "--random", 2, "--set", "run.seconds=1", "--json"
        first, again = (json.loads(journey(*arguments).stdout)["journeys"] for _ in range(2))
        for one, other in zip(first, again):
            self.assertEqual(one["settings"], other["settings"])
            self.assertEqual(one["net_work_J"], other["net_work_J"])
        self.assertNotEqual(first[0]["settings"], first[1]["settings"])

    def test_a_rigid_scene_is_refused(self):
        result = journey(ROOT / "scenes" / "water")
        self.assertEqual(result.returncode, 2)
        self.assertIn("no molecule of this scene moves by itself", result.stderr)
        self.assertEqual(result.stdout, "")

    def test_what_is_wrong_is_told_before_anything_is_played_or_printed(self):
        for arguments, what in ((["--random", 2, "--hands", "firm"], "--hands"),
                                (["--random", 2, "--periods", "14"], "--periods"),
                                (["--random", 2, "--modes", "4"], "--modes"),
                                (["--random", 2, "--active", "4"], "--active"),
                                (["--random", 2, "--fastest"], "--fastest"),
                                (["--hands", "medium,firmer"], "hand.grip=firmer"),
                                (["--set", "hand.grips=firm"], "hand.grips")):
            with self.subTest(arguments=arguments):
                result = journey(PEPTIDES, *arguments)
                self.assertEqual(result.returncode, 2)
                self.assertEqual(result.stdout, "")
                self.assertEqual(len(result.stderr.splitlines()), 1)
                self.assertIn(what, result.stderr)

    def test_all_active_are_told_in_words(self):
        result = journey(PEPTIDES, "--periods", "50", "--hands", "firm", "--modes", "guarded",
                         "--active", "all", "--set", "run.seconds=0.5")
        self.assertIn("| all | 50 |", result.stdout)


if __name__ == "__main__":
    unittest.main()
