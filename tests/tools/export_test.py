"""palpa export from outside: coordinates that other programs read, of all or of some molecules."""
import os
import shutil
import subprocess
import tempfile
import unittest
from pathlib import Path

PROGRAM = os.environ["PALPA_PROGRAM"]
WATER = Path(os.environ["PALPA_ROOT"]) / "scenes" / "water"


def rows_of(text, path):
    """Atom name and position in angstrom of each atom, by the columns of each format."""
    lines = text.splitlines()
    if path.suffix == ".pdb":
        return [(line[12:16].strip(), *(float(line[k:k + 8]) for k in (30, 38, 46)))
                for line in lines if line.startswith("ATOM")]
    if path.suffix == ".cif":
        names = [line.strip() for line in lines if line.startswith("_atom_site.")]
        at = [names.index("_atom_site." + name) for name in ("label_atom_id", "Cartn_x", "Cartn_y", "Cartn_z")]
        return [(row[at[0]], *(float(row[k]) for k in at[1:]))
                for row in (line.split() for line in lines if line.startswith("ATOM"))]
    if path.suffix == ".gro":
        return [(line[10:15].strip(), *(10 * float(line[k:k + 8]) for k in (20, 28, 36))) for line in lines[2:-1]]
    rows = [line.split() for line in lines if not line.startswith("*")][1:]
    return [(row[3], *map(float, row[4:7])) for row in rows]


class Export(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)
        self.tmp = Path(self.folder.name)

    def export(self, name, *arguments, code=0):
        result = subprocess.run([PROGRAM, "export", WATER, "-o", self.tmp / name, *map(str, arguments)],
                                capture_output=True, text=True)
        self.assertEqual(result.returncode, code, result.stderr)
        return result

    def rows(self, name, *arguments):
        self.export(name, *arguments)
        return rows_of((self.tmp / name).read_text(), self.tmp / name)

    def test_every_format_has_the_atoms_where_the_scene_has_them(self):
        told = rows_of((WATER / "dimer.crd").read_text(), WATER / "dimer.crd")
        for name, digits in (("w.pdb", 3), ("w.cif", 5), ("w.gro", 2), ("w.crd", 7)):
            with self.subTest(name):
                rows = self.rows(name)
                self.assertEqual([row[0] for row in rows], [row[0] for row in told])
                for row, expected in zip(rows, told):
                    for a, b in zip(row[1:], expected[1:]):
                        self.assertAlmostEqual(a, b, delta=0.51 * 10 ** -digits)

    def test_elements_chains_and_their_ends(self):
        self.export("w.pdb")
        lines = (self.tmp / "w.pdb").read_text().splitlines()
        atoms = [line for line in lines if line.startswith("ATOM")]
        self.assertEqual([line[76:78].strip() for line in atoms], ["O", "H", "H"] * 2)
        self.assertEqual(len({line[21] for line in atoms}), 2)
        self.assertEqual(sum(line.startswith("TER") for line in lines), 2)

    def test_time_moves_the_molecule_in_hand_alone(self):
        start, later = self.rows("a.crd"), self.rows("b.crd", "--time", 3)
        self.assertEqual(start[:3], later[:3])
        self.assertGreater(abs(start[3][1] - later[3][1]), 0.5)

    def test_some_molecules(self):
        self.assertEqual(self.rows("m.crd", "--of", "moved"), self.rows("all.crd")[3:])
        self.assertEqual(self.rows("both.crd", "--of", "moved", "--of", "fixed"), self.rows("all2.crd"))
        result = self.export("x.pdb", "--of", "movde", code=2)
        self.assertIn("did you mean 'moved'", result.stderr)
        self.assertFalse((self.tmp / "x.pdb").exists())

    def test_a_psf_comes_with_its_coordinates(self):
        self.export("w.psf", "--of", "moved")
        self.assertIn("3 !NATOM", (self.tmp / "w.psf").read_text())
        self.assertEqual(len(rows_of((self.tmp / "w.crd").read_text(), self.tmp / "w.crd")), 3)
        energy = subprocess.run([PROGRAM, "energy", self.tmp / "w.psf", "--coordinates", self.tmp / "w.crd",
                                 "--toppar", WATER / "tip3p.str"], capture_output=True, text=True)
        self.assertEqual(energy.returncode, 0, energy.stderr)

    def test_nothing_is_overwritten_unless_asked_and_ours(self):
        for name in ("w.pdb", "w.cif", "w.gro", "w.crd", "w2.psf"):
            with self.subTest(name):
                self.export(name)
                self.export(name, code=2)
                self.export(name, "--overwrite")
                (self.tmp / name).write_text("somebody's")
                self.export(name, "--overwrite", code=2)
                self.assertEqual((self.tmp / name).read_text(), "somebody's")

    def test_another_ending_is_refused(self):
        self.assertIn(".gro", self.export("w.xyz", code=2).stderr)

    def test_gromacs_reads_what_it_wrote(self):
        gmx = shutil.which("gmx")
        if not gmx:
            return
        for name in ("w.gro", "w.pdb"):
            told = self.rows(name)
            result = subprocess.run([gmx, "-nobackup", "editconf", "-f", self.tmp / name, "-o",
                                     self.tmp / ("by-gmx-" + name)], capture_output=True, text=True)
            self.assertEqual(result.returncode, 0, result.stderr)
            read = rows_of((self.tmp / ("by-gmx-" + name)).read_text(), self.tmp / name)
            self.assertEqual(len(read), len(told))
            for row, expected in zip(read, told):
                for a, b in zip(row[1:], expected[1:]):
                    self.assertAlmostEqual(a, b, delta=0.011)


if __name__ == "__main__":
    unittest.main()
