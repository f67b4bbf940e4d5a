"""The force field that comes with the program: energies against GROMACS, packing, and preparing without files."""
import json
import os
import subprocess
import tempfile
import unittest
from pathlib import Path

PROGRAM = os.environ["PALPA_PROGRAM"]
LAB = os.environ["PALPA_LAB"]
ROOT = Path(os.environ["PALPA_ROOT"])
BUILT_IN = ROOT / "engine" / "charmm" / "charmm36.ff"
REFERENCES = ROOT / "tests" / "data" / "force_field"
WATER = ROOT / "scenes" / "water"
# GROMACS's, kcal A/mol/e^2
COULOMB = 1389.3545764438198 / 4.184
# Its terms, and Palpa's that are the same.
TERMS = {"Bond": ["bond"], "U-B": ["angle", "urey_bradley"], "Proper Dih.": ["dihedral"], "Improper Dih.": ["improper"],
         "CMAP Dih.": ["cmap"], "LJ-14": ["lj14"], "Coulomb-14": ["coulomb14"], "LJ (SR)": ["lj"],
         "Coulomb (SR)": ["coulomb"], "Potential": ["total"]}


class ForceField(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)

    def palpa(self, *arguments, code=0):
        program = LAB if arguments[0] == "force-field" else PROGRAM
        result = subprocess.run([program, *map(str, arguments)], capture_output=True, text=True, cwd=self.folder)
        self.assertEqual(result.returncode, code, result.stderr)
        return result

    def test_energies_of_all_kinds_of_molecules_are_those_of_gromacs(self):
        references = json.loads((REFERENCES / "energies.json").read_text())
        self.assertEqual(set(references), {"dna", "glycan", "lipid", "phosphoserine", "heme"})
        for name, expected in references.items():
            found = json.loads(self.palpa("energy", REFERENCES / f"{name}.psf", "--coordinates", REFERENCES / f"{name}.crd",
                                          "--toppar", BUILT_IN, "--coulomb-constant", repr(COULOMB), "--json").stdout)
            for term, value in expected.items():
                if term not in TERMS:  # temperatures and the like
                    continue
                with self.subTest(system=name, term=term):
                    mine = sum(found[key] for key in TERMS[term])
                    self.assertLess(abs(mine - value), 1e-6 * max(abs(value), 1))

    def test_it_says_what_it_is_and_whom_to_cite(self):
        shown = self.palpa("force-field", "show").stdout
        self.assertTrue(shown.startswith("CHARMM36, July 2024\n"))
        for words in ("Cite for proteins", "carry no licence", "Lemkul-Lab"):
            self.assertIn(words, shown)
        # Readable in the file itself.
        self.assertTrue(BUILT_IN.read_bytes().startswith(b"Palpa packed force field 1\nCHARMM36, July 2024\n"))
        self.assertEqual(json.loads(self.palpa("force-field", "show", "--json").stdout)["about"],
                         (ROOT / "engine" / "charmm" / "charmm36.txt").read_text().splitlines())
        self.assertLess(BUILT_IN.stat().st_size, 3_000_000)

    def test_a_folder_is_packed_and_used(self):
        files = self.folder / "toppar"
        files.mkdir()
        (files / "water.str").write_bytes((WATER / "tip3p.str").read_bytes())
        (files / "other.prm").write_text("BONDS\nA B 1.0 1.0\nA B 2.0 1.0\nEND\n")
        (self.folder / "about.txt").write_text("Waters\nCite nobody.\n")
        pack = ("force-field", "pack", "toppar", "--about", "about.txt", "-o", "waters.ff")
        packed = self.palpa(*pack)
        self.assertIn("1 entry of the force field defined again; the last definition is used: toppar/other.prm:3: bond A B "
                      "replaces that of toppar/other.prm:2", packed.stderr)
        self.palpa(*pack, code=2)
        counts = json.loads(self.palpa(*pack, "--overwrite", "--json").stdout)
        self.assertEqual((counts["residues"], counts["atom_types"]), (1, 2))
        self.assertEqual(len(counts["warnings"]), 1)
        energies = [json.loads(self.palpa("energy", WATER / "dimer.crd", "--json", "--toppar", toppar).stdout)
                    for toppar in (WATER / "tip3p.str", "waters.ff")]
        self.assertEqual(*energies)
        self.palpa("force-field", "pack", "toppar", code=2)
        (self.folder / "cut.ff").write_bytes((self.folder / "waters.ff").read_bytes()[:-5])
        self.assertIn("is cut", self.palpa("force-field", "show", "cut.ff", code=2).stderr)

    def test_a_structure_is_prepared_without_any_file(self):
        water = ("prepare", WATER / "dimer.crd", "--keep-waters", "--no-scene")
        self.palpa(*water, "-o", "one")
        report = (self.folder / "one" / "report.txt").read_text()
        for words in ("CHARMM36, July 2024", "Cite for water and ions"):
            self.assertIn(words, report)
        self.palpa(*water, "-o", "two", "--toppar", WATER / "tip3p.str")
        report = (self.folder / "two" / "report.txt").read_text()
        self.assertIn("tip3p.str", report)
        self.assertIn("residue TIP3 replaces that of charmm36.ff", report)
        self.palpa(*water, "-o", "three", "--toppar", WATER / "tip3p.str", "--only-toppar")
        report = (self.folder / "three" / "report.txt").read_text()
        self.assertNotIn("CHARMM36, July 2024", report)
        psf = [(self.folder / name / "system.psf").read_text() for name in ("one", "two", "three")]
        # That file's water has no bond between its hydrogens, CHARMM36's has one.
        self.assertIn("6 !NBOND", psf[0])
        self.assertIn("4 !NBOND", psf[1])
        self.assertEqual(psf[1], psf[2])
        self.assertIn("expected --toppar FILE", self.palpa(*water, "-o", "four", "--only-toppar", code=2).stderr)


if __name__ == "__main__":
    unittest.main()
