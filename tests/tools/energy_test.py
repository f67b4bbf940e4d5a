"""palpa energy from outside, against what other programs print for the same structures."""
import csv
import json
import os
import subprocess
import tempfile
import unittest
from pathlib import Path

PROGRAM = os.environ["PALPA_PROGRAM"]
DATA = Path(os.environ["PALPA_ROOT"]) / "tests" / "data"
PEPTIDES = DATA / "two_peptides"
SHARED = os.environ.get("PALPA_DATA")
KJ_PER_KCAL = 4.184


def first_row(path):
    with open(path, newline="") as file:
        return next(csv.DictReader(file))


class Energy(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)

    def palpa(self, *arguments):
        return subprocess.run([PROGRAM, "energy", *map(str, arguments)], capture_output=True,
                              text=True)

    def energy(self, *arguments):
        result = self.palpa(*arguments, "--json")
        self.assertEqual(result.returncode, 0, result.stderr)
        return json.loads(result.stdout)

    def aera(self):
        """A CRD file of the tetrapeptide, and what OpenMM found for it."""
        system = json.loads((DATA / "tetra_aera_c36m.ff.json").read_text())
        frame = json.loads((DATA / "tetra_aera_c36m.frames.json").read_text())["frames"][0]
        atoms = [dict(zip(system["atoms"]["columns"], row)) for row in system["atoms"]["rows"]]
        lines = ["* AERA", "*", f"{len(atoms):10}  EXT"]
        for i, (atom, place) in enumerate(zip(atoms, frame["x"]), 1):
            x, y, z = (10 * value for value in place)
            lines.append(f"{i:10}{atom['resid']:10}  {atom['resname']:<8}  {atom['name']:<8}"
                         f"{x:20.10f}{y:20.10f}{z:20.10f}  {'PEP':<8}  {atom['resid']:<8}{0:20.10f}")
        path = self.folder / "aera.crd"
        path.write_text("\n".join(lines) + "\n")
        return path, frame

    def test_a_structure_is_typed_and_summed_as_by_another_program(self):
        path, frame = self.aera()
        forces = self.folder / "forces.csv"
        energy = self.energy(path, "--toppar", PEPTIDES / "aera_c36m.rtf", PEPTIDES / "aera_c36m.prm",
                             "--coulomb-constant", 332.06371, "--forces", forces)
        theirs = frame["energy"]
        for ours, name in (("bond", "bond"), ("angle", "angle"), ("urey_bradley", "urey"),
                           ("dihedral", "proper"), ("improper", "improper"), ("cmap", "cmap"),
                           ("lj14", "lj14")):
            self.assertAlmostEqual(energy[ours] * KJ_PER_KCAL, theirs[name], delta=1e-6, msg=name)
        self.assertEqual(list(energy), ["bond", "angle", "urey_bradley", "dihedral", "improper",
                                        "cmap", "lj", "lj14", "coulomb", "coulomb14",
                                        "solvation", "total"])
        with open(forces, newline="") as file:
            rows = list(csv.DictReader(file))
        self.assertEqual(len(rows), len(frame["f"]))
        for row, theirs in zip(rows, frame["f"]):
            for axis, value in zip("xyz", theirs):
                mine = float(row[f"force_{axis}_kcal_per_mol_angstrom"]) * KJ_PER_KCAL * 10
                self.assertAlmostEqual(mine, value, delta=2e-2)  # of hundreds; constant's digits

    def test_bad_input_is_one_line(self):
        path, _ = self.aera()
        toppar = ["--toppar", PEPTIDES / "aera_c36m.rtf", PEPTIDES / "aera_c36m.prm"]
        psf = self.folder / "some.psf"
        psf.write_text("PSF\n")
        for arguments, expected in (
                ([psf, *toppar], "expected --coordinates"),
                ([path, *toppar, "--method", "cutof"], "did you mean 'cutoff'?"),
                ([path, *toppar, "--method", "cutoff", "--cutoff", 8], "--method cutoff"),
                ([path, "--toppar", PEPTIDES / "aera_c36m.rtf"], "aera"),
                ([self.folder / "none.crd", *toppar], "none.crd"),
                ([path, *toppar, "--cutoff", 12], "expected --method cutoff"),
                ([path, *toppar, "--forces", "/dev/full"], "cannot be written"),
                ([path, *toppar, "--dielectric", "nan"], "nan")):
            with self.subTest(arguments=arguments):
                result = self.palpa(*arguments)
                self.assertEqual(result.returncode, 2, result.stdout)
                self.assertEqual(len(result.stderr.strip().splitlines()), 1, result.stderr)
                self.assertIn(expected, result.stderr)

    def aera_as_pdb(self, edit):
        """The tetrapeptide as a PDB file, of whose lines `edit` makes others."""
        path, _ = self.aera()
        lines = []
        for number, line in enumerate(path.read_text().splitlines()[3:], 1):
            residue, atom = line[22:30].strip(), line[32:40].strip()
            x, y, z = (float(line[at:at + 20]) for at in (40, 60, 80))
            lines.append(f"ATOM  {number:5} {atom if len(atom) > 3 else ' ' + atom:<4} {residue:<4}P"
                         f"{line[112:120].strip():>4}    {x:8.3f}{y:8.3f}{z:8.3f}")
        structure = self.folder / "aera.pdb"
        structure.write_text("\n".join([*edit(lines), "END", ""]))
        return structure

    def test_what_is_to_be_prepared_first_is_one_line(self):
        toppar = ["--toppar", PEPTIDES / "aera_c36m.rtf", PEPTIDES / "aera_c36m.prm"]
        def without_hydrogens(lines):
            return [line for line in lines if not line[12:16].strip().startswith("H")]
        def in_two_places(lines):
            return [lines[0][:16] + "A" + lines[0][17:], lines[0][:16] + "B" + lines[0][17:],
                    *lines[1:]]
        def in_two_models(lines):
            return ["MODEL        1", *lines, "ENDMDL", "MODEL        2", *lines, "ENDMDL"]
        for edit, expected in ((without_hydrogens, ".pdb:1: the structure holds no hydrogens"),
                               (in_two_places, " again in location B, first in location A on line 1"),
                               (in_two_models, " again in model 2, first in model 1 on line 2 (")):
            with self.subTest(edit=edit.__name__):
                result = self.palpa(self.aera_as_pdb(edit), *toppar)
                self.assertEqual(result.returncode, 2, result.stdout)
                self.assertEqual(len(result.stderr.strip().splitlines()), 1, result.stderr)
                self.assertIn(expected, result.stderr)
                self.assertIn("palpa prepare", result.stderr)

    def test_atoms_in_one_place_are_named(self):
        toppar = ["--toppar", PEPTIDES / "aera_c36m.rtf", PEPTIDES / "aera_c36m.prm"]
        def unchanged(lines):
            return lines
        def last_at_the_one_before(lines):  # the two oxygens of the end
            return [*lines[:-1], lines[-1][:30] + lines[-2][30:54]]

        self.assertEqual(self.palpa(self.aera_as_pdb(unchanged), *toppar).stderr, "")
        structure = self.aera_as_pdb(last_at_the_one_before)
        result = self.palpa(structure, *toppar)

        self.assertEqual(result.returncode, 0, result.stderr)
        last = len(structure.read_text().splitlines()) - 1
        self.assertRegex(result.stderr,
                         rf"^warning: atoms .*aera\.pdb:{last - 1}\) and .*aera\.pdb:{last}\) are 0\.000 Å apart")
        # Orders of magnitude too much, in as many letters as ever.
        self.assertLess(max(map(len, result.stdout.splitlines())), 40)

    def test_charmm_s_own_numbers_from_native_files(self):
        if not SHARED:
            self.skipTest("PALPA_DATA names no folder with data/charmm and data/energies")
        data = Path(SHARED) / "data"
        folder = data / "energies"
        energy = self.energy(folder / "crambin_c36m.crd", "--toppar",
                             data / "charmm" / "top_all36_prot.rtf",
                             data / "charmm" / "par_all36m_prot.prm", "--method", "cutoff",
                             "--electrostatics", "fshift", "--van-der-waals", "fswitch",
                             "--switch-from", 10, "--cutoff", 12)
        charmm = first_row(folder / "crambin_energies.csv")
        for name in ("bond", "angle", "urey_bradley", "dihedral", "improper", "cmap", "total"):
            self.assertAlmostEqual(energy[name], float(charmm[name]), delta=1.01e-5, msg=name)
        self.assertAlmostEqual(energy["lj"] + energy["lj14"], float(charmm["vdw_vfswitch_10_12"]),
                               delta=1.01e-5)
        self.assertAlmostEqual(energy["coulomb"] + energy["coulomb14"],
                               float(charmm["elec_fshift_12"]), delta=1.01e-5)

        ala = folder / "ala_ala_ala"
        older = data / "charmm" / "older"
        energy = self.energy(ala / "ala_ala_ala.psf", "--coordinates", ala / "ala_ala_ala.crd",
                             "--toppar", older / "top_all22_prot.inp", older / "par_all22_prot.inp")
        charmm = first_row(ala / "energies.csv")
        for name in ("bond", "angle", "dihedral", "improper", "cmap"):
            if name in charmm:
                self.assertAlmostEqual(energy[name], float(charmm[name]), delta=2e-4, msg=name)


if __name__ == "__main__":
    unittest.main()
