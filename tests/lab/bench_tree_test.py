"""palpa-lab bench --tree from outside: its rows, whatever the times are."""
import json
import os
import subprocess
import unittest
from pathlib import Path

PROGRAM = os.environ["PALPA_LAB"]
WATER = Path(os.environ["PALPA_ROOT"]) / "scenes" / "water"


class BenchTree(unittest.TestCase):
    def test_times_assembly_trees(self):
        result = subprocess.run([PROGRAM, "bench", "--tree", str(WATER), "--json"],
                                capture_output=True, text=True, stdin=subprocess.DEVNULL)
        self.assertEqual(result.returncode, 0, result.stderr)
        rows = {row["name"]: row for row in json.loads(result.stdout)["rows"]}
        self.assertIn("tree/water/joints=0/passes", rows)
        for joints in (100, 1000, 5000, 20000):
            row = rows[f"tree/polymer/joints={joints}/metric"]
            self.assertLess(row["error"], 1e-9)
        self.assertIn("tree/polymer/passes/exponent", rows)


if __name__ == "__main__":
    unittest.main()
