"""The bundled flexible scene from outside: its molecules stand at rest."""
import json
import os
import subprocess
import unittest
from pathlib import Path

PROGRAM = os.environ["PALPA_PROGRAM"]
ROOT = Path(os.environ["PALPA_ROOT"])


class BundledScene(unittest.TestCase):
    SCENE = ROOT / "scenes" / "hiv" / "flexible.toml"

    def palpa(self, *arguments):
        return subprocess.run([PROGRAM, *map(str, arguments)], capture_output=True, text=True, check=False)

    def test_it_stands_at_rest_and_counts_its_freedom(self):
        report = json.loads(self.palpa("relax", self.SCENE, "--json").stdout)
        self.assertEqual(report["steps"], 0)
        # 385 a chain, one for the proton of Asp 25, 27 in TL-3, counted by hand (assembly's tests).
        self.assertEqual(report["joints"], 2 * 385 + 1 + 27)
        check = self.palpa("run", "--check", self.SCENE)
        self.assertEqual(check.returncode, 0, check.stderr)
        self.assertIn("807 degrees of freedom: 798 joints, 9 of bases; 3 more of the hand", check.stdout)

    def test_the_force_that_the_hand_feels_is_that_on_the_joints_cutoff_or_not(self):
        for setting in ("statics.rest_kcal_per_mol=0.05", "statics.cutoff_angstrom=12"):
            check = self.palpa("run", "--check", self.SCENE, "--set", setting)
            start = next(line for line in check.stdout.splitlines() if line.startswith("  start"))
            force_nN = float(start.split(",")[1].split()[0])
            # Relaxed with nobody holding it, the molecule is pulled at by no one.
            self.assertLess(force_nN, 0.002, check.stdout)

    def test_a_region_holds_the_rest(self):
        check = self.palpa("run", "--check", self.SCENE, "--set", "joints.within_angstrom=8",
                           "--set", "statics.relax_steps=0")
        self.assertIn("498 joints outside of the region are fixed", check.stdout)


if __name__ == "__main__":
    unittest.main()
