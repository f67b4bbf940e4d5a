"""No test is left out: ctest knows every case that the test programs hold."""
import json
import os
import subprocess
import unittest
from pathlib import Path

BIN = Path(os.environ["PALPA_PROGRAM"]).parent


class Registration(unittest.TestCase):
    def test_every_case_is_registered_once(self):
        listing = subprocess.run(["ctest", "--test-dir", BIN.parent, "--show-only=json-v1"],
                                 capture_output=True, text=True, check=True)
        registered = [test["name"] for test in json.loads(listing.stdout)["tests"]]
        programs = sorted(BIN.glob("*_tests"))
        self.assertTrue(programs)
        for program in programs:
            # Catch2 2.13 returns the number of tests as exit code.
            cases = subprocess.run([program, "--list-test-names-only"], capture_output=True,
                                   text=True).stdout.splitlines()
            cases = [case for case in cases if case.strip()]
            module = program.name.removesuffix("_tests")
            self.assertTrue(cases, program.name)
            for case in cases:
                self.assertEqual(registered.count(f"{module}:{case}"), 1, f"{module}:{case}")


if __name__ == "__main__":
    unittest.main()
