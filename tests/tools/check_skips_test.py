"""tools/scripts/check_skips and the list of expected skips: which skipped tests should have run."""
import importlib.machinery
import importlib.util
import json
import os
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

ROOT = Path(os.environ["PALPA_ROOT"])
TOOL = ROOT / "tools" / "scripts" / "check_skips"
BUILD = Path(os.environ["PALPA_PROGRAM"]).parent.parent


def load_tool():
    loader = importlib.machinery.SourceFileLoader("check_skips", str(TOOL))
    module = importlib.util.module_from_spec(importlib.util.spec_from_loader(loader.name, loader))
    sys.dont_write_bytecode = True
    loader.exec_module(module)
    return module


class CheckSkips(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)

    def check(self, data, outcomes):
        """Exit code and output for tests of these names, 'skipped' or 'run'."""
        cases = "".join(
            f'<testcase name="{name}">'
            + ("<skipped message='SKIP_RETURN_CODE=77'/>" if outcome == "skipped" else "")
            + "<system-out>SKIPPED: why not</system-out></testcase>"
            for name, outcome in outcomes.items())
        (self.folder / "tests.xml").write_text(f"<testsuite>{cases}</testsuite>")
        environment = {key: value for key, value in os.environ.items() if key != "PALPA_DATA"}
        if data:
            environment["PALPA_DATA"] = str(data)
        result = subprocess.run([sys.executable, TOOL, self.folder / "tests.xml"], text=True,
                                env=environment, capture_output=True)
        return result.returncode, result.stdout + result.stderr

    def test_a_skip_that_is_not_listed_fails_and_says_what_the_test_said(self):
        code, output = self.check(None, {"core:anything": "skipped", "tools: other": "run"})
        self.assertEqual(code, 1)
        self.assertIn("'core:anything' was skipped and should have run", output)
        self.assertIn("SKIPPED: why not", output)
        self.assertIn("1 ran, 1 skipped", output)

    def test_a_listed_test_may_be_skipped_only_where_its_inputs_are_missing(self):
        name = "charmm:crambin gets back all of its hydrogens"
        self.assertEqual(self.check(None, {name: "skipped"})[0], 0)
        self.assertEqual(self.check(self.folder, {name: "skipped"})[0], 0)
        for inputs in load_tool().read_expected(ROOT / "tests" / "expected_skips.txt")[name]:
            (self.folder / inputs).mkdir(parents=True)
        self.assertEqual(self.check(self.folder, {name: "skipped"})[0], 1)
        self.assertEqual(self.check(self.folder, {name: "run"})[0], 0)

    def test_every_listed_test_is_one_that_ctest_knows(self):
        listing = subprocess.run(["ctest", "--test-dir", BUILD, "--show-only=json-v1"],
                                 capture_output=True, text=True, check=True)
        registered = {test["name"] for test in json.loads(listing.stdout)["tests"]}
        listed = load_tool().read_expected(ROOT / "tests" / "expected_skips.txt")
        self.assertTrue(listed)
        self.assertEqual(set(listed) - registered, set())

    def test_what_cannot_be_read_is_one_line(self):
        (self.folder / "broken.xml").write_text("<testsuite>")
        for path in ("nowhere.xml", "broken.xml"):
            result = subprocess.run([sys.executable, TOOL, self.folder / path], text=True,
                                    capture_output=True)
            self.assertEqual(result.returncode, 1)
            self.assertEqual(len(result.stderr.strip().splitlines()), 1, result.stderr)


class SkippedAndFailed(unittest.TestCase):
    """What a skip does to the exit code, of a test program and of a file of Python tests."""

    def test_only_a_program_without_failures_is_skipped(self):
        for cases, code in (("skips", 77), ("skips and fails", 1), ("skips*", 1),
                            ("says the word and passes", 0)):
            with self.subTest(cases=cases):
                result = subprocess.run([BUILD / "bin" / "skip_cases", cases], capture_output=True,
                                        text=True)
                self.assertEqual(result.returncode, code, result.stdout)

    def run_cases(self, body):
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / "some_test.py"
            path.write_text("import unittest\n\n\nclass Some(unittest.TestCase):\n" + body)
            return subprocess.run([sys.executable, ROOT / "tests/support/run_cases.py", path],
                                  capture_output=True, text=True)

    def test_only_a_file_without_failures_is_skipped(self):
        skips = "    def test_a(self):\n        self.skipTest('no data')\n"
        passes = "    def test_b(self):\n        pass\n"
        fails = "    def test_c(self):\n        self.fail('SKIPPED: not at all')\n"
        for body, code in ((skips, 77), (skips + passes, 77), (passes, 0), (fails, 1),
                           (skips + fails, 1)):
            with self.subTest(body=body):
                result = self.run_cases(body)
                self.assertEqual(result.returncode, code, result.stderr)
        self.assertIn("SKIPPED: no data (some_test.Some.test_a)", self.run_cases(skips).stdout)


if __name__ == "__main__":
    unittest.main()
