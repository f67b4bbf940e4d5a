"""TL-3 as shipped: neutral groups, its formula and bonds; and what tools/compare_tl3 prints."""
import os
import re
import subprocess
import sys
import unittest
from pathlib import Path

ROOT = Path(os.environ["PALPA_ROOT"])
DATA = os.environ.get("PALPA_DATA")
ELEMENTS = {"C": 50, "H": 64, "N": 6, "O": 10}


class CompareTl3(unittest.TestCase):
    def test_every_group_is_neutral_and_the_formula_is_that_of_tl3(self):
        words = [line.split("!")[0].split()
                 for line in (ROOT / "scenes" / "hiv" / "tl3.rtf").read_text().splitlines()]
        groups, atoms = [], []
        for each in filter(None, words):
            if each[0] == "GROUP":
                groups.append(0)
            elif each[0] == "ATOM":
                groups[-1] += round(1000 * float(each[3]))
                atoms.append(each[1])
        bonds = [atom for each in words if each[:1] == ["BOND"] for atom in each[1:]]

        self.assertEqual(set(groups), {0})
        self.assertEqual({element: sum(atom.startswith(element) for atom in atoms)
                          for element in ELEMENTS}, ELEMENTS)
        self.assertEqual(len(set(atoms)), 130)
        # One piece with four rings.
        self.assertEqual(len(bonds), 2 * (130 - 1 + 4))
        self.assertEqual(set(bonds), set(atoms))

    @unittest.skipUnless(DATA, "PALPA_DATA names no folder with reference/hiv_tl3_c36m.*.json")
    def test_the_energies_are_those_of_the_scene_and_the_charges_those_of_cgenff(self):
        result = subprocess.run([sys.executable, ROOT / "tools" / "compare_tl3"],
                                capture_output=True, text=True)
        self.assertEqual(result.returncode, 0, result.stderr)

        self.assertIn("TL3C: 130 of 130 atoms", result.stdout)
        lj, draft, ours = map(float, re.search(
            r"minimised_300_steps +(\S+) +(\S+) +(\S+)", result.stdout).groups())
        # What `palpa run --check scenes/hiv` prints before it relaxes TL-3.
        self.assertAlmostEqual(lj + draft, -171.178, places=2)
        self.assertEqual(draft, ours)


if __name__ == "__main__":
    if not DATA:
        print("SKIPPED: PALPA_DATA names no folder with reference/hiv_tl3_c36m.*.json")
    unittest.main()
