"""palpa-lab from outside: its help, what it says of bad input, and rows of its benches."""
import json
import os
import re
import subprocess
import tempfile
import unittest
from pathlib import Path

LAB = os.environ["PALPA_LAB"]
WATER = Path(os.environ["PALPA_ROOT"]) / "scenes" / "water"


class Lab(unittest.TestCase):
    def lab(self, *arguments):
        return subprocess.run([LAB, *map(str, arguments)], capture_output=True, text=True, stdin=subprocess.DEVNULL)

    def assert_bad_input(self, result, expected):
        self.assertEqual(result.returncode, 2, result.stdout + result.stderr)
        self.assertEqual(len(result.stderr.strip().splitlines()), 1, result.stderr)
        self.assertIn(expected, result.stderr)

    def test_every_command_has_help(self):
        page = self.lab().stdout
        self.assertEqual(self.lab("--help").stdout, page)
        commands = re.findall(r"^    ([a-z-]+) +[A-Z]", page, re.M)
        self.assertEqual(set(commands), {"accuracy", "bench", "closed-paths", "compare-ligands", "force-field",
                                         "report", "scenarios", "study", "unbind"})
        for command in commands:
            with self.subTest(command=command):
                result = self.lab("help", command)
                self.assertEqual(result.returncode, 0, result.stderr)
                self.assertIn(f"\n  palpa-lab {command}", result.stdout)  # an example
        self.assertEqual(self.lab("--version").returncode, 0)

    def test_bad_input_is_one_line(self):
        for arguments, said in ((["bench"], "palpa-lab bench: a scene"), (["bench", "--json"], "a scene"),
                                (["bnech"], "did you mean 'bench'"), (["help", "fly"], "palpa-lab: unknown command")):
            with self.subTest(arguments=arguments):
                self.assert_bad_input(self.lab(*arguments), said)

    def test_a_seed_is_a_whole_number_that_fits(self):
        for command in ("closed-paths", "unbind", "study", "scenarios", "report"):
            for seed in ("-1", "1.5"):
                arguments = [] if command == "report" else [WATER]
                with self.subTest(command=command, seed=seed):
                    self.assert_bad_input(self.lab(command, *arguments, "--seed", seed), "seed")

    def test_a_report_never_replaces_a_file_of_others(self):
        with tempfile.TemporaryDirectory() as folder:
            page = Path(folder) / "page.html"
            page.write_text("mine")
            for overwrite in ((), ("--overwrite",)):
                self.assert_bad_input(self.lab("report", "--scene", WATER, "-o", page,
                                               *overwrite), "page.html")
            self.assertEqual(page.read_text(), "mine")

    def test_lost_output_is_no_success(self):
        with open("/dev/full", "w") as full:
            result = subprocess.run([LAB, "bench", WATER], stdout=full, stderr=subprocess.PIPE, text=True)
            self.assertEqual(result.returncode, 2)
            self.assertIn("palpa-lab: the output cannot be written", result.stderr)

    def test_bench_prints_rows_with_their_errors(self):
        result = self.lab("bench", WATER, "--json")
        self.assertEqual(result.returncode, 0, result.stderr)
        report = json.loads(result.stdout)
        self.assertEqual(set(report), {"machine", "commit", "rows"})
        names = {row["name"] for row in report["rows"]}
        self.assertIn("step/water", names)
        self.assertTrue(any(name.startswith("lockstep/water") for name in names))
        for row in report["rows"]:
            self.assertEqual(set(row), {"name", "median", "p10", "p90", "unit", "error",
                                        "error_unit", "reference"})
            self.assertLessEqual(row["p10"], row["median"])
            if row["name"] == "step/water":
                self.assertLess(row["error"], 1e-5)

    def test_bench_times_the_reading_of_files(self):
        result = self.lab("bench", "--load", WATER / "dimer.crd", "--toppar", WATER / "tip3p.str",
                            "--json")
        self.assertEqual(result.returncode, 0, result.stderr)
        rows = json.loads(result.stdout)["rows"]
        self.assertEqual([(row["name"], row["unit"], row["reference"]) for row in rows],
                         [("load/dimer.crd", "ms", "6 atoms"), ("load/toppar", "ms", "2 types")])


if __name__ == "__main__":
    unittest.main()
