"""palpa-lab bench --kernel from outside: its rows, whatever the times are."""
import json
import os
import re
import subprocess
import unittest
from pathlib import Path

PROGRAM = os.environ["PALPA_LAB"]
ROOT = Path(os.environ["PALPA_ROOT"])


class BenchKernel(unittest.TestCase):
    def check(self, name, *arguments):
        """Rows by name, after what must hold of each."""
        result = subprocess.run([PROGRAM, "bench", "--kernel", "--json", *map(str, arguments)],
                                capture_output=True, text=True, stdin=subprocess.DEVNULL)
        self.assertEqual(result.returncode, 0, result.stderr)
        rows = {row["name"]: row for row in json.loads(result.stdout)["rows"]}
        for row in rows.values():
            with self.subTest(row=row["name"]):
                self.assertGreater(row["p10"], 0)
                self.assertLessEqual(row["p10"], row["median"])
                self.assertLessEqual(row["median"], row["p90"])
                if row["error"] is not None:
                    self.assertLess(row["error"], 2e-5)
        kinds = [row.split("/")[-1] for row in rows if row.startswith("kernel/peak/")]
        self.assertTrue(kinds)
        for kind in kinds:
            self.assertEqual(rows[f"kernel/peak/{kind}"]["unit"], "Gflop/s")
            for case in "all-pairs", "force-switch=12":
                for result in "forces", "energies":
                    for threads in 1, 2:
                        row = rows[f"kernel/{name}/{case}/{result}/{kind}/threads={threads}"]
                        self.assertIsNotNone(row["error"])
                        self.check_share(row["reference"])
            self.check_share(rows[f"kernel/{name}/130-in-1000/stiffness/{kind}"]["reference"])
        for what in "build", "1%-moved", "10%-moved/told":
            self.assertIn(f"kernel/{name}/list/{what}", rows)
        return kinds, rows

    def check_share(self, text):
        share = re.search(r"([\d.]+) M pairs, (\d+) M/s, (\d+) % of peak$", text)
        self.assertTrue(share, text)
        self.assertGreater(float(share[1]), 0)
        self.assertLess(int(share[3]), 100)

    def test_without_a_scene(self):
        _, rows = self.check("gas")
        self.assertFalse([row for row in rows if "all-terms" in row])

    def test_of_a_scene_with_a_topology(self):
        kinds, rows = self.check("hiv", ROOT / "scenes" / "hiv")
        for kind in kinds:
            for case in "all-pairs", "force-switch=12":
                for threads in 1, 2:
                    row = rows[f"kernel/hiv/{case}/all-terms/{kind}/threads={threads}"]
                    self.assertIsNotNone(row["error"])


if __name__ == "__main__":
    unittest.main()
