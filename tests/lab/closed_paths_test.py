"""palpa-lab closed-paths from outside: what its table says, and what is refused."""
import os
import subprocess
import unittest
from pathlib import Path

PROGRAM = os.environ["PALPA_LAB"]
ROOT = Path(os.environ["PALPA_ROOT"])
SPACE = ROOT / "scenes" / "water" / "space.toml"


def closed_paths(*arguments):
    return subprocess.run([PROGRAM, "closed-paths", *map(str, arguments)], capture_output=True, text=True,
                          stdin=subprocess.DEVNULL)


class ClosedPaths(unittest.TestCase):
    def test_a_value_that_no_path_has_is_left_empty(self):
        rows = [[cell.strip() for cell in line.split("|")[1:-1]]
                for line in closed_paths(SPACE, "--count", 3).stdout.splitlines() if line.startswith("|")]
        self.assertEqual({len(row) for row in rows}, {6})
        counted = [row for row in rows if row[1].isdigit()]
        self.assertEqual({row[1] == "0" for row in counted}, {True, False})
        for row in counted:
            for cell in row[2:5]:
                self.assertEqual(cell == "", row[1] == "0", row)

    def test_a_setting_of_the_path_itself_is_refused(self):
        for setting in ("run.seconds=3", "seconds=3", "hand.stroke=hold", "stroke = hold",
                        "hand.path=[[1, 0]]"):
            with self.subTest(setting=setting):
                result = closed_paths(SPACE, "--count", 1, "--set", setting)
                self.assertEqual(result.returncode, 2, result.stdout)
                self.assertEqual(len(result.stderr.splitlines()), 1)
                self.assertIn("sets the path and its duration itself", result.stderr)
        self.assertEqual(closed_paths(SPACE, "--count", 1, "--set", "hand.grip=firm").returncode, 0)

    def test_what_takes_hours_is_said_before(self):
        hiv = ROOT / "scenes" / "hiv"
        with subprocess.Popen([PROGRAM, "closed-paths", str(hiv)], stdout=subprocess.DEVNULL,
                              stderr=subprocess.PIPE, text=True) as running:
            told = running.stderr.readline()
            running.kill()
        # 130 atoms of TL-3, 3145 of the protease.
        self.assertIn("408850 pairs of atoms", told)
        self.assertEqual(closed_paths(SPACE, "--count", 1).stderr, "")


if __name__ == "__main__":
    unittest.main()
