"""A person takes part in a study, in a window under Xvfb: agrees, practises, does two trials."""
import csv
import json
import os
import subprocess
import tempfile
import time
import unittest
from pathlib import Path

from window_test import PROGRAM, ROOT, Display


class StudyWindow(unittest.TestCase):
    def wait_until(self, is_so, what):
        for _ in range(1200):
            if is_so():
                return
            self.assertIsNone(self.program.poll(), "the program ended early")
            time.sleep(0.05)
        self.fail("waited in vain for " + what)

    def take_part(self, folder, trials, before):
        """Presses Enter until at least so many trials are in the table, and Esc."""
        with Display() as display:
            return self.take_part_on(display, folder, trials, before)

    def take_part_on(self, display, folder, trials, before):
        self.program = subprocess.Popen(
            [PROGRAM, "study", ROOT / "scenes" / "water", "--modes", "4,guarded", "--rounds", "2",
             "--validation", "-o", folder],
            env={**os.environ, "DISPLAY": display.name}, stdout=subprocess.PIPE,
            stderr=subprocess.PIPE, text=True)
        self.wait_until(display.focus_window, "the window")

        def press_and_look():
            display.do("key", "Return")
            time.sleep(0.5)
            return len(self.rows(folder)) >= before + trials

        self.wait_until(press_and_look, "the trials")
        display.do("key", "Escape")
        out, err = self.program.communicate(timeout=60)
        self.assertEqual(self.program.returncode, 0, err)
        return out

    def rows(self, folder):
        table = Path(folder) / "trials.csv"
        if not table.exists():
            return []
        with open(table, encoding="utf-8", newline="") as file:
            return list(csv.DictReader(file))

    def test_each_trial_is_in_the_table_as_soon_as_it_is_done_and_the_next_person_adds_to_it(self):
        with tempfile.TemporaryDirectory() as folder:
            out = self.take_part(folder, 2, 0)
            first = self.rows(folder)
            self.take_part(folder, 1, len(first))
            both = self.rows(folder)

            # On a busy machine a press that came late may have ended one trial more.
            self.assertIn(len(first), (2, 3))
            self.assertIn(f"{len(first)} of 4 trials", out)
            self.assertEqual(both[:len(first)], first)
            self.assertEqual({row["mode"] for row in first[:2]}, {"4", "guarded"})
            self.assertEqual([row["place"] for row in first], [str(i + 1) for i in range(len(first))])
            self.assertEqual(len({row["participant"] for row in first}), 1)
            self.assertNotEqual(both[len(first)]["participant"], first[0]["participant"])
            for row in both:
                # Nobody moved the mouse: as far outside of the place to be found as it began.
                start = float(row["start_angstrom"])
                self.assertGreaterEqual(start, 2.766 + 4.0)
                self.assertLessEqual(start, 2.768 + 6.2)
                self.assertAlmostEqual(float(row["found_angstrom"]), start, delta=0.3)
                self.assertGreater(float(row["time_s"]), 1)
                self.assertEqual(len(row["participant"]), 6)
            self.assertEqual(len({row["start_angstrom"] for row in both}), len(both))
            self.refuses_other_settings(Path(folder))

    def refuses_other_settings(self, folder):
        session = json.loads((folder / "session.json").read_text())
        self.assertEqual((session["seed"], session["rounds"], session["modes"], session["hand"],
                          session["period_ms"], session["settings"]),
                         (1, 2, ["4", "guarded"], "medium", 14, []))
        before = (folder / "trials.csv").read_bytes()
        same = ["--modes", "4,guarded", "--rounds", "2"]
        for other, named in ((["--seed", "2"], "seed = 1"), (["--hand", "firm"], "hand = "),
                             (["--period-ms", "20"], "period_ms = 14"),
                             (["--set", "coupling.clamp_N=2.5"], "settings = []")):
            with self.subTest(other=other):
                result = subprocess.run([PROGRAM, "study", ROOT / "scenes" / "water", *same, *other,
                                         "-o", folder], capture_output=True, text=True,
                                        env={**os.environ, "DISPLAY": ""})
                self.assertEqual(result.returncode, 2)
                self.assertEqual(len(result.stderr.splitlines()), 1)
                self.assertIn(named, result.stderr)
        self.assertEqual((folder / "trials.csv").read_bytes(), before)


if __name__ == "__main__":
    unittest.main()
