"""tools/scripts/fingerprints: recordings of five scenes are to the last digit those of the repository."""
import os
import shlex
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

PROGRAM = os.environ["PALPA_PROGRAM"]
ROOT = Path(os.environ["PALPA_ROOT"])
# Runs the program, then counts up the last digit of one number in a row of the trace.
TAMPERING = """
import subprocess, sys
from pathlib import Path
code = subprocess.run([{program!r}, *sys.argv[1:]]).returncode
trace = Path(sys.argv[sys.argv.index("--record") + 1]) / "trace.csv"
lines = trace.read_text().splitlines()
row = lines[{row}].split(",")
at = lines[0].split(",").index({column!r})
row[at] = row[at][:-1] + str((int(row[at][-1]) + 1) % 10)
lines[{row}] = ",".join(row)
trace.write_text("\\n".join(lines) + "\\n")
sys.exit(code)
"""


def fingerprints(*arguments, program=(PROGRAM,)):
    return subprocess.run([ROOT / "tools/scripts/fingerprints", "--program", shlex.join(program), *arguments],
                          capture_output=True, text=True, check=False)


class Fingerprints(unittest.TestCase):
    def test_traces_are_those_of_the_repository_to_the_last_digit(self):
        result = fingerprints()
        self.assertEqual(result.returncode, 0, result.stdout + result.stderr)
        self.assertEqual([line.split(maxsplit=1)[1] for line in result.stdout.splitlines()],
                         ["the same to the last digit"] * 5)

    def test_a_changed_last_digit_is_reported_with_its_row(self):
        for row, column, told in ((1234, "stiffness_N_per_m", "rows of water.csv are the same, other rows or columns are not"),
                                  (10000, "device_force_x_N", "rows 9501 to 10000 of 10000")):
            with self.subTest(row=row), tempfile.TemporaryDirectory() as folder:
                script = Path(folder) / "tampering.py"
                script.write_text(TAMPERING.format(program=PROGRAM, row=row, column=column))
                result = fingerprints("water", program=(sys.executable, str(script)))
                self.assertEqual(result.returncode, 1, result.stdout + result.stderr)
                self.assertIn(told, result.stdout)

    def test_unknown_names_and_failed_programs_are_refused(self):
        for arguments, told in ((["fire"], "'fire' is none of the recordings; expected water, "),
                                (["--remake", "--kernels", "AVX2"], "expected one of both")):
            result = fingerprints(*arguments)
            self.assertEqual(result.returncode, 2)
            self.assertIn(told, result.stderr)
        result = fingerprints("water", program=("false",))
        self.assertEqual(result.returncode, 1)
        self.assertIn("ended with exit code 1; expected 0", result.stderr)


if __name__ == "__main__":
    unittest.main()
