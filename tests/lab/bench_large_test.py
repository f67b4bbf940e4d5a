"""palpa-lab bench --render --atoms: a scene repeated until it is as large as wanted."""
import json
import os
import subprocess
import unittest
from pathlib import Path

PROGRAM = os.environ["PALPA_LAB"]
WATER = Path(os.environ["PALPA_ROOT"]) / "scenes" / "water"


class Large(unittest.TestCase):
    def test_two_waters_become_a_hundred_atoms(self):
        result = subprocess.run([PROGRAM, "bench", "--render", "--atoms", "100", "--json", WATER],
                                capture_output=True, text=True)
        self.assertEqual(result.returncode, 0, result.stderr)
        names = [row["name"] for row in json.loads(result.stdout)["rows"]]
        looks = ("ball-and-stick", "space-filling", "lines", "cartoon")
        # 17 times 6 atoms.
        self.assertEqual(names, [f"large/water/atoms=102/{look}/{what}" for look in looks
                                 for what in ("build", "draw", "frame")])

    def test_only_pictures_are_of_repeated_scenes(self):
        result = subprocess.run([PROGRAM, "bench", "--atoms", "100", WATER], capture_output=True,
                                text=True)
        self.assertNotEqual(result.returncode, 0)
        self.assertIn("--render", result.stderr)


if __name__ == "__main__":
    unittest.main()
