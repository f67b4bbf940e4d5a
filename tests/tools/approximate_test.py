"""palpa prepare from outside: a ligand that the force field lacks is refused, typed approximately
when asked, with bonds of a file where one is given, and taken from a stream file of parameters."""
import json
import math
import os
import subprocess
import tempfile
import unittest
from pathlib import Path

PROGRAM = os.environ["PALPA_PROGRAM"]

# Toluene: a regular hexagon of 1.39 A, a methyl carbon 1.51 A from its first atom.
HEAVY = [(1.39 * math.cos(math.pi / 3 * i), 1.39 * math.sin(math.pi / 3 * i), 0.0)
         for i in range(6)] + [(2.90, 0.0, 0.0)]


def pdb():
    lines = [f"HETATM{i + 1:5d}  C{i + 1}  XYL A   1    {x:8.3f}{y:8.3f}{z:8.3f}"
             "  1.00  0.00           C" for i, (x, y, z) in enumerate(HEAVY)]
    return "\n".join(lines + ["END", ""])


def sdf(orders):
    atoms = [f"{x:10.4f}{y:10.4f}{z:10.4f} C   0  0" for x, y, z in HEAVY]
    bonds = [(i + 1, (i + 1) % 6 + 1, order) for i, order in enumerate(orders)] + [(1, 7, 1)]
    return "\n".join(["XYL", "  hand", "", f"{len(atoms):3d}{len(bonds):3d}  0  0  0  0  0  0  0  0999 V2000",
                      *atoms, *(f"{a:3d}{b:3d}{order:3d}  0" for a, b, order in bonds),
                      "M  END", "$$$$", ""])


class Approximate(unittest.TestCase):
    def setUp(self):
        self._folder = tempfile.TemporaryDirectory()
        self.addCleanup(self._folder.cleanup)
        self.folder = Path(self._folder.name)
        (self.folder / "xyl.pdb").write_text(pdb())

    def prepare(self, out, *options):
        return subprocess.run([PROGRAM, "prepare", "xyl.pdb", "-o", out, "--no-scene", "--json", *options],
                              cwd=self.folder, capture_output=True, text=True, timeout=120)

    def types(self, out):
        rows = [line.split() for line in (self.folder / out / "system.psf").read_text().splitlines()]
        return sorted(row[5] for row in rows if len(row) == 9 and row[3] == "XYL")

    def test_refused_by_default(self):
        result = self.prepare("no")
        self.assertEqual(result.returncode, 2)
        self.assertEqual([entry["name"] for entry in json.loads(result.stdout)["residues_unknown"]],
                         ["XYL"])
        self.assertIn("--approximate-ligands", result.stderr)
        self.assertFalse((self.folder / "no").exists())

    def test_a_file_of_bonds_gives_toluene(self):
        (self.folder / "xyl.sdf").write_text(sdf([2, 1, 2, 1, 2, 1]))
        result = self.prepare("out", "--approximate-ligands", "--ligand", "xyl.sdf")
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertEqual([entry["residue"] for entry in json.loads(result.stdout)["approximate"]], ["XYL"])
        # CGenFF's own toluene (TOLU): six aromatic carbons with five hydrogens, and a methyl.
        self.assertEqual(self.types("out"), ["CG2R61"] * 6 + ["CG331"] + ["HGA3"] * 3 + ["HGR61"] * 5)

    def test_other_bonds_give_another_molecule(self):
        (self.folder / "xyl.sdf").write_text(sdf([1] * 6))
        result = self.prepare("out", "--approximate-ligands", "--ligand", "xyl.sdf")
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertEqual(len(self.types("out")), 7 + 14)  # methylcyclohexane, C7H14
        self.assertNotIn("CG2R61", self.types("out"))

    def test_its_own_stream_is_taken_as_parameters(self):
        (self.folder / "xyl.sdf").write_text(sdf([2, 1, 2, 1, 2, 1]))
        self.prepare("out", "--approximate-ligands", "--ligand", "xyl.sdf")
        again = self.prepare("again", "--parameters", "out/approximate.str")
        self.assertEqual(again.returncode, 0, again.stderr)
        self.assertEqual(json.loads(again.stdout)["approximate"], [])
        self.assertEqual(self.types("again"), self.types("out"))


if __name__ == "__main__":
    unittest.main()
