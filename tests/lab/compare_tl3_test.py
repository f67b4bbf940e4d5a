"""TL-3 as shipped: neutral groups, its formula and bonds; and what tools/lab/scripts/compare_tl3 prints."""
import os
import subprocess
import sys
import unittest
from pathlib import Path

ROOT = Path(os.environ["PALPA_ROOT"])
DATA = os.environ.get("PALPA_DATA")
SCENE = ROOT / "scenes" / "hiv"
ELEMENTS = {"C": 50, "H": 64, "N": 6, "O": 10}


class CompareTl3(unittest.TestCase):
    def test_every_group_is_neutral_and_the_formula_is_that_of_tl3(self):
        words = [line.split("!")[0].split() for line in (SCENE / "tl3.rtf").read_text().splitlines()]
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
        result = subprocess.run([sys.executable, ROOT / "tools" / "lab" / "scripts" / "compare_tl3"],
                                capture_output=True, text=True)
        self.assertEqual(result.returncode, 0, result.stderr)

        self.assertIn("TL3C: 130 of 130 atoms", result.stdout)
        between, alone = [{words[0]: words[1:] for words in map(str.split, part.splitlines()) if words}
                          for part in result.stdout.split("protein and ligand")[1].split("ligand alone")]
        rows = [line.replace("−", "-").strip("| ").split(" | ")
                for line in (SCENE / "TL3.md").read_text().splitlines()
                if line.startswith("| `minimised")]
        self.assertEqual(len(rows), 3)
        # Of the reference's own poses; the scene's was prepared anew and is another.
        for name, lj, draft, ours, alone_draft, alone_ours, differ in rows:
            name = name.strip("`").replace(" nm", "nm")
            with self.subTest(pose=name):
                self.assertEqual(between[name][:3], [lj, draft, ours])
                self.assertEqual(alone[name][:3], [alone_draft, alone_ours, differ])
                self.assertEqual(draft, ours)

    def test_the_results_have_what_the_scene_s_check_prints(self):
        result = subprocess.run([os.environ["PALPA_PROGRAM"], "run", "--check", SCENE],
                                capture_output=True, text=True)
        self.assertEqual(result.returncode, 0, result.stderr)

        relaxed = next(line for line in result.stdout.splitlines() if "relaxed" in line)
        self.assertIn("-152.113 to -155.906 kcal/mol", relaxed)
        self.assertIn(relaxed, (SCENE / "results.md").read_text())


if __name__ == "__main__":
    unittest.main()
