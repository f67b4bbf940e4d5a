"""palpa study, which people take part in, from outside: what it refuses before its window opens."""
import os
import subprocess
import tempfile
import unittest
from pathlib import Path

ROOT = Path(os.environ["PALPA_ROOT"])
WATER = ROOT / "scenes" / "water"


def run(program, *arguments):
    return subprocess.run([os.environ[program], "study", *map(str, arguments)], capture_output=True, text=True,
                          stdin=subprocess.DEVNULL)


class Study(unittest.TestCase):
    def assert_bad_input(self, expected, *arguments):
        result = run("PALPA_PROGRAM", *arguments)
        self.assertEqual(result.returncode, 2, result.stdout + result.stderr)
        self.assertEqual(len(result.stderr.strip().splitlines()), 1, result.stderr)
        self.assertIn(expected, result.stderr)

    def test_bad_input_is_one_line(self):
        self.assert_bad_input("expected one of 1, 2", WATER, "--modes", "7")
        self.assert_bad_input("each mode once", WATER, "--modes", "2,4,2")
        self.assert_bad_input("confined to a line", ROOT / "scenes" / "hiv")
        self.assert_bad_input("folder with the trials of people", WATER)
        with tempfile.TemporaryDirectory() as folder:
            trials = Path(folder) / "trials.csv"
            trials.write_text("something else")
            self.assert_bad_input("is not a table of a study", WATER, "-o", folder)
            trials.unlink()
            # Trials of emulated operators are not added to.
            operators = Path(folder) / "operators"
            result = run("PALPA_LAB", WATER, "--operators", 1, "--rounds", 1, "--modes", "4", "-o", operators)
            self.assertEqual(result.returncode, 0, result.stderr)
            self.assert_bad_input("the settings of the trials beside it are unknown", WATER, "--modes", "4", "-o",
                                  operators)


if __name__ == "__main__":
    unittest.main()
