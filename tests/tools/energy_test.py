"""palpa energy from outside, against what other programs print for the same structures."""
import csv
import json
import math
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


BRIDGE = Path(os.environ["PALPA_ROOT"]) / "scenes" / "salt-bridge"


def read_bonds(psf):
    """Pairs of atoms, from 0."""
    lines = iter(psf.read_text().splitlines())
    numbers = []
    for line in lines:
        if "!NBOND" in line:
            count = 2 * int(line.split()[0])
            while len(numbers) < count:
                numbers += [int(word) - 1 for word in next(lines).split()]
    return list(zip(numbers[::2], numbers[1::2]))


def solvation_by_hand(atoms, places, bonds, end):
    """EEF1 of each atom: the published formula on heavy atoms, without pairs 1-2 and 1-3."""
    table = Path(os.environ["PALPA_ROOT"]) / "engine/charmm/eef1sb.csv"
    with open(table, newline="") as file:
        rows = {row["type"]: row for row in csv.DictReader(line for line in file if line[0] != "#")}
    near = {frozenset(bond) for bond in bonds}
    near |= {frozenset((a, b)) for a in range(len(atoms)) for b in range(a)
             if any({frozenset((a, c)), frozenset((c, b))} <= near for c in range(len(atoms)))}
    energies = [float(rows[atom["type"]]["dG_ref"]) if atom["type"] in rows else 0.0 for atom in atoms]
    for a, first in enumerate(atoms):
        for b, second in enumerate(atoms):
            r = math.dist(places[a], places[b])
            if a == b or frozenset((a, b)) in near or r >= end or not {first["type"], second["type"]} <= rows.keys():
                continue
            of_a = {key: float(rows[first["type"]][key]) for key in ("dG_free", "lambda_A", "R_min_half_A")}
            x = (r - of_a["R_min_half_A"]) / of_a["lambda_A"]
            energies[a] -= (of_a["dG_free"] * float(rows[second["type"]]["volume_A3"]) * math.exp(-x * x)
                            / (2 * math.pi ** 1.5 * of_a["lambda_A"] * r * r))
    return energies


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

    def test_solvation_of_every_atom_is_the_published_formula(self):
        crd, atoms = BRIDGE / "system.crd", self.folder / "atoms.csv"
        energy = self.energy(BRIDGE / "solvent.psf", "--coordinates", crd, "--toppar", BRIDGE / "system.prm",
                             BRIDGE / "solvent.prm", "--solvent", "eef1-sb", "--solvent-end", "sharp",
                             "--per-atom", atoms)
        with open(atoms, newline="") as file:
            rows = list(csv.DictReader(file))
        places = [tuple(map(float, line.split()[4:7])) for line in crd.read_text().splitlines()
                  if not line.startswith("*")][1:]
        by_hand = solvation_by_hand(rows, places, read_bonds(BRIDGE / "solvent.psf"), 9)
        self.assertEqual(len(rows), len(places))
        for row, expected in zip(rows, by_hand):
            self.assertAlmostEqual(float(row["solvation_kcal_per_mol"]), expected, delta=1e-9, msg=row)
        self.assertAlmostEqual(energy["solvation"], sum(by_hand), delta=1e-8)
        self.assertLess(energy["solvation"], -30)
        self.assertAlmostEqual(sum(float(row["charge_e"]) for row in rows), 0, delta=1e-9)

    def forces(self, *arguments):
        """Of each atom, kcal/mol/A, and its segment."""
        path = self.folder / "forces.csv"
        self.energy(*arguments, "--forces", path, "--overwrite")
        with open(path, newline="") as file:
            return [(row["segment"], [float(row[f"force_{axis}_kcal_per_mol_angstrom"]) for axis in "xyz"])
                    for row in csv.DictReader(file)]

    def test_little_electrostatics_is_left_out_by_the_end_at_9_A(self):
        hiv = BRIDGE.parent / "hiv"
        arguments = [hiv / "solvent.psf", "--coordinates", hiv / "relaxed.crd", "--toppar",
                     hiv / "system.prm", hiv / "solvent.prm", "--solvent", "eef1-sb", "--solvent-end"]
        def electrostatics(end):
            whole, without = (self.forces(*arguments, end, *extra) for extra in ([], ["--coulomb-constant", 0]))
            return [(segment, [f - g for f, g in zip(force, other)])
                    for (segment, force), (_, other) in zip(whole, without)]
        ended, endless = electrostatics("smooth"), electrostatics("sharp")
        def net(forces):
            return [sum(force[axis] for segment, force in forces if segment == "TL3C") for axis in range(3)]
        self.assertAlmostEqual(math.hypot(*net(endless)), 10.8, delta=0.1)
        self.assertLess(math.dist(net(ended), net(endless)), 0.01 * math.hypot(*net(endless)))
        off = sum(math.dist(force, other) ** 2 for (_, force), (_, other) in zip(ended, endless))
        self.assertLess(off, 0.04 ** 2 * sum(math.hypot(*force) ** 2 for _, force in endless))

    def test_charged_groups_in_implicit_water_are_said(self):
        arguments = ["--coordinates", BRIDGE / "system.crd", "--toppar", BRIDGE / "system.prm",
                     BRIDGE / "solvent.prm", "--solvent", "eef1-sb"]
        result = self.palpa(BRIDGE / "vacuum.psf", *arguments)
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertIn("warning: ionic groups are not neutral", result.stderr)
        self.assertEqual(self.palpa(BRIDGE / "solvent.psf", *arguments).stderr, "")
        vacuum = self.palpa(BRIDGE / "solvent.psf", *arguments[:-2])
        self.assertEqual(vacuum.returncode, 0, vacuum.stderr)
        self.assertIn("has EEF1-SB's neutral charges, but the energy is computed in vacuum", vacuum.stderr)
        self.assertEqual(self.palpa(BRIDGE / "vacuum.psf", *arguments[:-2]).stderr, "")

    def test_a_psf_has_the_terms_that_scenes_have(self):
        """Asp's changed type keeps its dihedral without a file for it, and the NBFIX of NC2 and OC is off."""
        hiv = BRIDGE.parent / "hiv"
        def energy(*toppar):
            return self.energy(hiv / "solvent.psf", "--coordinates", hiv / "solvent.crd", "--toppar", *toppar,
                               "--solvent", "eef1-sb")
        text = (hiv / "system.prm").read_text()
        without = self.folder / "without.prm"
        without.write_text("\n".join(line for line in text.splitlines() if line.split()[:2] != ["NC2", "OC"]) + "\n")
        self.assertNotEqual(text, without.read_text())
        whole = energy(hiv / "system.prm", hiv / "solvent.prm")
        for toppar in ([hiv / "system.prm"], [without, hiv / "solvent.prm"]):
            for name, value in energy(*toppar).items():
                self.assertAlmostEqual(value, whole[name], delta=1e-9, msg=name)

    def test_structural_water_has_no_solvation(self):
        water = BRIDGE.parent / "water"
        arguments = [water / "dimer.crd", "--toppar", water / "tip3p.str", "--solvent", "eef1-sb"]
        refused = self.palpa(*arguments)
        self.assertEqual(refused.returncode, 2)
        self.assertIn("--structural-water", refused.stderr)
        self.assertEqual(self.energy(*arguments, "--structural-water")["solvation"], 0)

    def test_tetrapeptides_have_charmm_s_solvation(self):
        if not SHARED:
            self.skipTest("PALPA_DATA names no folder with data/energies and reference/solvent")
        folder = Path(SHARED) / "data/energies/eef1sb"
        totals = Path(SHARED) / "reference/solvent/oracle/charmm/tetra_totals.csv"
        with open(totals, newline="") as file:
            expected = [row for row in csv.DictReader(file)]
        self.assertEqual(len(expected), 38)
        for row in expected:
            energy = self.energy(folder / "tetra" / f"{row['name']}.pdb", "--toppar",
                                 folder / "top_all36_prot_eef1sb.rtf", folder / "param_all36_eef1sb.prm",
                                 "--solvent", "eef1-sb", "--solvent-end", "sharp", "--solvent-exp", "table")
            self.assertAlmostEqual(energy["solvation"], float(row["solvation_charmm"]), delta=1.01e-5,
                                   msg=row["name"])

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
                ([path, *toppar, "--solvent", "eef1"], "expected one of none, eef1-sb"),
                ([path, *toppar, "--solvent-end", "sharp"], "expected --solvent eef1-sb"),
                ([path, *toppar, "--structural-water"], "expected --solvent eef1-sb"),
                ([path, *toppar, "--solvent", "eef1-sb", "--method", "cutoff"], "--solvent-end sharp"),
                ([path, *toppar, "--solvent", "eef1-sb", "--solvent-table", PEPTIDES / "aera_c36m.prm"],
                 "not the header of a solvation table"),
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
        for edit, expected in ((without_hydrogens, ".pdb:1: the structure has no hydrogens"),
                               (in_two_places, " is repeated in location B, first in location A on line 1"),
                               (in_two_models, " is repeated in model 2, first in model 1 on line 2 (")):
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
