"""palpa prepare from outside: downloaded structures become the systems that other programs made."""
import json
import os
import re
import signal
import subprocess
import sys
import tempfile
import time
import unittest
from collections import Counter
from pathlib import Path

sys.path.append(str(Path(__file__).resolve().parents[1] / "support"))
from prepare_case import SHARED, PrepareCase  # noqa: E402

PROGRAM = os.environ["PALPA_PROGRAM"]
KJ_PER_KCAL = 4.184


def read_psf(path):
    """Atoms as (segment, number, residue, name, type, charge), and the counts of the sections."""
    atoms, counts = [], {}
    lines = path.read_text().splitlines()
    for i, line in enumerate(lines):
        found = re.match(r"\s*(\d+) !(N\w+)", line)
        if not found:
            continue
        counts[found[2]] = int(found[1])
        if found[2] == "NATOM":
            for row in lines[i + 1:i + 1 + int(found[1])]:
                words = row.split()
                atoms.append((*words[1:6], float(words[6])))
    return atoms, counts


def residues_of(rows):
    """For each residue, in order, its atoms' types and charges as a multiset."""
    residues, before = [], None
    for key, kind, charge in rows:
        if key != before:
            residues.append(Counter())
            before = key
        residues[-1][kind, round(charge, 4)] += 1
    return residues


def residue_keys(rows):
    """The reference's atoms; every residue of a chain begins with its N."""
    begun = 0
    for row in rows:
        begun += row["name"] == "N" or row["resname"] == "3TL" and row["name"] == "O58"
        yield begun, row["type"], row["charge"]


class Prepare(PrepareCase):
    def toppar(self, kind="36"):
        if kind == "22":
            return self.charmm_files("top_all22_prot.rtf", "par_all22_prot.prm")
        return self.charmm_files("top_all36_prot.rtf", "par_all36m_prot.prm",
                                 "top_all36_cgenff.rtf", "par_all36_cgenff.prm",
                                 "toppar_water_ions.str")

    def tl3(self):
        derived = self.data / "hiv" / "derived"
        return [derived / "3tl_draft.rtf", derived / "3tl_draft.prm"]

    def palpa(self, command, *arguments):
        """Prepares with the files of --toppar alone: these are what the references were made with."""
        if command == "prepare":
            arguments = ("--only-toppar", *arguments)
        return subprocess.run([PROGRAM, command, *map(str, arguments)], capture_output=True,
                              text=True)

    def prepare(self, structure, toppar, *options):
        result = self.palpa("prepare", structure, "--toppar", *toppar, "-o", self.folder / "out",
                            "--overwrite", "--no-scene", *options)
        self.assertEqual(result.returncode, 0, result.stderr)
        return self.folder / "out"

    def energy(self, folder):
        result = self.palpa("energy", folder / "system.psf", "--coordinates",
                            folder / "system.crd", "--toppar", folder / "system.prm", "--json")
        self.assertEqual(result.returncode, 0, result.stderr)
        return json.loads(result.stdout)

    def refuse(self, structure, *options):
        result = self.palpa("prepare", structure, "--toppar", *self.toppar(), "-o",
                            self.folder / "refused", *options)
        self.assertEqual(result.returncode, 2, result.stdout)
        self.assertFalse((self.folder / "refused").exists(), "half written")
        return result.stderr

    def without_hydrogens(self, path):
        """A PDB file's heavy atoms alone."""
        kept = [line for line in path.read_text().splitlines()
                if not (line.startswith(("ATOM", "HETATM")) and
                        (line[76:78].strip() == "H" or line[12:16].strip().lstrip("0123456789")
                         .startswith("H")))]
        bare = self.folder / "bare.pdb"
        bare.write_text("\n".join(kept) + "\n")
        return bare

    def check_reference(self, folder, case):
        """The same atoms, types and charges, residue by residue."""
        reference = json.loads((Path(SHARED) / "reference" / f"{case}.ff.json").read_text())
        rows = [dict(zip(reference["atoms"]["columns"], row))
                for row in reference["atoms"]["rows"]]
        theirs = residues_of(residue_keys(rows))
        atoms, counts = read_psf(folder / "system.psf")
        self.assertEqual(len(atoms), len(rows))
        ours = residues_of(((atom[0], atom[1]), atom[4], atom[5]) for atom in atoms)
        self.assertEqual(len(ours), len(theirs))
        for i, (a, b) in enumerate(zip(ours, theirs)):
            self.assertEqual(a, b, f"residue {i + 1}")
        return reference, counts

    def check_clean(self, folder):
        """No two atoms that are not bonded within 1.5 Å, by the file's own coordinates."""
        report = (folder / "report.txt").read_text()
        closest = float(re.search(r"closest contact after: ([\d.]+) Å", report)[1])
        self.assertGreater(closest, 1.5)
        before, after = map(float, re.search(r"(-?[\d.]+) to (-?[\d.]+) kcal/mol in", report)
                            .groups())
        self.assertLess(after, before)

    def test_the_structure_may_stand_anywhere(self):
        peptide = self.data / "structures" / "alanine_dipeptide.pdb"
        toppar = self.toppar()[:2]
        written = []
        for i, arguments in enumerate(([peptide, "--toppar", *toppar],
                                       ["--toppar", *toppar, peptide],
                                       ["--no-relax", "--toppar", *toppar, peptide, "--no-flips"],
                                       ["--toppar", *toppar, "--", peptide])):
            with self.subTest(arguments=arguments):
                folder = self.folder / f"at{i}"
                result = self.palpa("prepare", "-o", folder, "--no-scene", *arguments)
                self.assertEqual(result.returncode, 0, result.stderr)
                written.append((folder / "system.psf").read_text())
        self.assertEqual(written, [written[0]] * 4)
        result = self.palpa("prepare", peptide, "-o", self.folder / "two", "--toppar", *toppar,
                            peptide)
        self.assertEqual(result.returncode, 2)
        self.assertIn("unexpected argument", result.stderr)

    def test_a_protein_alone_goes_with_implicit_water_if_that_is_left_open(self):
        ubiquitin = self.data / "structures" / "1ubq.pdb"
        vacuum = self.prepare(ubiquitin, self.toppar()[:2], "--solvent", "none")
        before, _ = read_psf(vacuum / "system.psf")
        self.assertNotIn("Solvent", (vacuum / "report.txt").read_text())
        places = (vacuum / "system.crd").read_text()
        folder = self.prepare(ubiquitin, self.toppar()[:2])
        after, _ = read_psf(folder / "system.psf")
        self.assertEqual([atom[:4] for atom in before], [atom[:4] for atom in after])
        self.assertIn(" REMARKS Charges: EEF1-SB", (folder / "system.psf").read_text())
        self.assertEqual((folder / "system.crd").read_text(), places)
        report = (folder / "report.txt").read_text()
        self.assertIn("because it covers every atom type", report)
        self.assertIn("left out 58 waters", report)
        self.assertAlmostEqual(sum(atom[5] for atom in after), 0, delta=1e-6)
        self.assertNotIn("NBFIX", (folder / "system.prm").read_text())
        self.energy(folder)  # has all of its parameters
        kept = self.prepare(ubiquitin, self.toppar(), "--keep-waters", "--no-relax")
        self.assertIn("none (vacuum), because the system has explicit waters", (kept / "report.txt").read_text())
        self.assertNotIn("EEF1-SB", (kept / "system.psf").read_text())

    def test_a_prepared_scene_in_implicit_water_can_be_run(self):
        folder = self.folder / "water"
        result = self.palpa("prepare", self.data / "structures" / "1crn.pdb", "--toppar",
                            *self.toppar()[:2], "-o", folder, "--solvent", "eef1-sb")
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertIn('solvent = "eef1-sb"', (folder / "scene.toml").read_text())
        self.assertIn("joints can turn, in EEF1-SB's implicit water", (folder / "report.txt").read_text())
        checked = self.palpa("run", "--check", folder)
        self.assertEqual(checked.returncode, 0, checked.stderr)
        vacuum = self.palpa("run", "--check", folder, "--set", "force_field.solvent=none")
        self.assertEqual(vacuum.returncode, 2)
        self.assertIn("neutral charges", vacuum.stderr)
        self.refuse(self.data / "structures" / "1crn.pdb", "--solvent", "water")
        self.refuse(self.data / "structures" / "1crn.pdb", "--solvent", "none", "--structural-water", "A:301")

    def test_an_interrupt_leaves_no_files_behind(self):
        """The scene is tried out in a temporary folder; Ctrl+C while it is there removes it."""
        for number in (signal.SIGINT, signal.SIGTERM):
            with self.subTest(signal=number), tempfile.TemporaryDirectory() as temporary:
                command = [PROGRAM, "prepare", "--only-toppar", self.data / "structures" / "1crn.pdb", "--toppar",
                           *self.toppar()[:2], "-o", self.folder / "out"]
                # A background shell has SIGINT ignored, and what it starts inherits that.
                program = subprocess.Popen(
                    command, env={**os.environ, "TMPDIR": temporary}, stdout=subprocess.DEVNULL,
                    stderr=subprocess.PIPE, text=True,
                    preexec_fn=lambda: signal.signal(signal.SIGINT, signal.SIG_DFL))
                while program.poll() is None and not list(Path(temporary).glob("palpa-*/*.crd")):
                    time.sleep(0.01)
                program.send_signal(number)
                _, errors = program.communicate(timeout=60)
                self.assertEqual(program.returncode, -number, errors)
                self.assertEqual(errors, "")
                self.assertEqual(list(Path(temporary).iterdir()), [])
                self.assertFalse((self.folder / "out").exists())

    def test_crambin_from_heavy_atoms_is_charmm_s_own(self):
        folder = self.prepare(self.data / "structures" / "1crn.pdb", self.toppar()[:2],
                              "--solvent", "none")
        _, counts = self.check_reference(folder, "crambin_c36m")
        self.assertEqual([counts[key] for key in ("NBOND", "NTHETA", "NPHI", "NIMPHI", "NCRTERM")],
                         [652, 1183, 1747, 111, 44])
        self.check_clean(folder)
        # Only what is used is written, and it is enough.
        self.assertLess((folder / "system.prm").stat().st_size, 40000)
        relaxed = self.energy(folder)["total"]
        unrelaxed = self.prepare(self.data / "structures" / "1crn.pdb", self.toppar()[:2],
                                 "--no-relax", "--solvent", "none")
        self.assertLess(relaxed, self.energy(unrelaxed)["total"])
        self.assertLess(relaxed, 0)

    def test_1hpv_in_charmm22(self):
        folder = self.prepare(self.data / "hiv" / "1hpv_protein.pdb", self.toppar("22"),
                              "--protonation", "A:69=HSE", "--protonation", "B:69=HSE",
                              "--solvent", "none")
        self.check_reference(folder, "hiv_protease_1hpv")
        self.check_clean(folder)

    def test_1hpv_s_energies_at_the_reference_s_coordinates(self):
        # The reference's places under our names: residue by residue, by name, but for the two
        # hydrogens of the first residue, which it calls otherwise.
        folder = self.prepare(self.data / "hiv" / "1hpv_protein.pdb", self.toppar("22"),
                              "--protonation", "A:69=HSE", "--protonation", "B:69=HSE",
                              "--no-relax", "--no-flips", "--solvent", "none")
        reference = Path(SHARED) / "reference"
        rows = json.loads((reference / "hiv_protease_1hpv.ff.json").read_text())["atoms"]["rows"]
        frame = json.loads((reference / "hiv_protease_1hpv.minimised_300_steps.json")
                           .read_text())["frames"][0]
        places, residue = {}, 0
        other = {"H1": "HN1", "H2": "HN2"}
        for row, place in zip(rows, frame["x"]):
            residue += row[0] == "N"
            name = other.get(row[0], row[0]) if row[1] == "PRO" else row[0]
            places[residue, name] = [10 * value for value in place]
        atoms, _ = read_psf(folder / "system.psf")
        lines, residue, before = ["* REFERENCE", "*", f"{len(atoms):10}  EXT"], 0, None
        for i, (segment, number, name, atom, *_) in enumerate(atoms, 1):
            residue += (segment, number) != before
            before = (segment, number)
            x, y, z = places[residue, atom]
            lines.append(f"{i:10}{residue:10}  {name:<8}  {atom:<8}{x:20.10f}{y:20.10f}{z:20.10f}"
                         f"  {segment:<8}  {number:<8}{0:20.10f}")
        (folder / "system.crd").write_text("\n".join(lines) + "\n")
        result = self.palpa("energy", folder / "system.psf", "--coordinates",
                            folder / "system.crd", "--toppar", folder / "system.prm", "--json",
                            "--coulomb-constant", 332.06371)
        self.assertEqual(result.returncode, 0, result.stderr)
        ours, theirs = json.loads(result.stdout), frame["energy"]
        for term, name in (("bond", "bond"), ("angle", "angle"), ("urey_bradley", "urey"),
                           ("dihedral", "proper"), ("improper", "improper"), ("cmap", "cmap"),
                           ("lj", "lj"), ("lj14", "lj14"), ("coulomb", "coulomb"),
                           ("coulomb14", "coulomb14")):
            with self.subTest(term=term):
                self.assertAlmostEqual(ours[term] * KJ_PER_KCAL / theirs[name], 1, delta=1e-7)

    def test_hiv_protease_with_tl3(self):
        folder = self.prepare(self.data / "hiv" / "derived" / "standin_2az8_tl3.pdb",
                              [*self.toppar(), *self.tl3()], "--protonation", "A:69=HSE",
                              "--protonation", "B:69=HSE", "--solvent", "none")
        reference, counts = self.check_reference(folder, "hiv_tl3_c36m")
        self.assertEqual(counts["NPHI"], reference["counts"]["dihedrals_before_expansion"])
        self.check_clean(folder)
        # Atoms of the file in its order.
        given = [line[12:16].strip() for line in (self.data / "hiv" / "derived" /
                 "standin_2az8_tl3.pdb").read_text().splitlines()
                 if line.startswith(("ATOM", "HETATM"))]
        renamed = {"CD1": "CD", "O": "OT1", "OXT": "OT2"}
        ours = iter(atom[3] for atom in read_psf(folder / "system.psf")[0])
        for name in given:
            self.assertTrue(any(mine in (name, renamed.get(name)) for mine in ours), name)

    def test_other_structures(self):
        hiv = self.data / "hiv"
        for name, options in (("1hsg_protein", []), ("1hxw_protein", []),
                              ("1hvr_protein", ["--as", "CSO=CYS"]), ("5w5w_protein", []),
                              ("4k4p_protein", []), ("4k4q_protein", []), ("5vea_protein", [])):
            with self.subTest(name=name):
                folder = self.prepare(hiv / f"{name}.pdb", self.toppar()[:2], *options)
                self.check_clean(folder)
        with self.subTest(name="a clash of the file's own hydrogens is reported"):
            folder = self.prepare(hiv / "1tw7_charmm_allH.pdb", self.toppar()[:2])
            self.assertRegex((folder / "report.txt").read_text(),
                             "a clash remains: .*PROA GLN 2 HE22 and PROB ASN 98 HD22")
        with self.subTest(name="alanine dipeptide"):
            folder = self.prepare(self.data / "structures" / "alanine_dipeptide.pdb",
                                  self.toppar()[:2])
            atoms, counts = read_psf(folder / "system.psf")
            self.assertEqual((len(atoms), counts["NCRTERM"]), (22, 1))

    def test_a_ligand_s_hydrogens(self):
        """TL-3 without hydrogens: built on the heavy atoms of a file that has them."""
        whole = self.data / "hiv" / "derived" / "5w5w_tl3_complex.pdb"
        bare = self.without_hydrogens(whole)
        folder = self.prepare(bare, [*self.toppar(), *self.tl3()])
        atoms, _ = read_psf(folder / "system.psf")
        self.assertEqual(sum(atom[2] == "3TL" for atom in atoms), 130)
        self.check_clean(folder)

    def test_what_cannot_be_prepared_is_told_in_one_line(self):
        hiv = self.data / "hiv"
        one_line = [
            (hiv / "1hsg_protein.pdb", ["--protonation", "A:25=ASPX"], "did you mean 'ASPP'"),
            (hiv / "1hsg_protein.pdb", ["--without", "HOH"], "the structure has no 'HOH'"),
            (hiv / "1hsg_protein.pdb", ["--first", "C=NTER"], "no chain or segment 'C'"),
            (hiv / "absent.pdb", [], "absent.pdb"),
            (hiv / "1hpv_protein.pdb", ["--protonation", "A:69=XXX"], "no residue and no patch 'XXX'"),
            (hiv / "1hpv_protein.pdb", ["--protonation", "A:25=LSN"],
             "patch LSN is not for ASP A 25, which has no 'HZ3'"),
            (hiv / "1hpv_protein.pdb", ["--protonation", "A:25=ASPP", "A:25=ASP"],
             "two states for ASP A 25"),
            (hiv / "1hpv_protein.pdb", ["--flip", "A:125"], "--flip: no residue A:125 here"),
            (hiv / "1hpv_protein.pdb", ["--flip", "A:25"],
             "--flip: ASP A 25 cannot be flipped; expected an ASN, GLN or HIS"),
            (hiv / "1hpv_protein.pdb", ["--flip", "25"], "--flip 25: expected CHAIN:NUMBER"),
            (hiv / "1hpv_protein.pdb", ["--first", "A=NTER"], "NTER is not for PRO A 1"),
            (hiv / "1hpv_protein.pdb", ["--as", "QQQ=ALA"], "no residue 'QQQ' here"),
            (hiv / "1hpv_protein.pdb", ["--altloc", "A:13=B"], "--altloc A:13=B"),
            (self.data / "structures" / "1crn.pdb", ["--disulphide", "A:3-A:10"],
             "expected two CYS"),
        ]
        for structure, options, expected in one_line:
            with self.subTest(expected=expected):
                message = self.refuse(structure, *options)
                self.assertRegex(message, expected)
                self.assertEqual(message.strip().count("\n"), 0, message)
        for structure, expected in (
                ("1hsg_ligand", "MK1 +45 atoms +B:902\n.*--without MK1.*\n.*a residue is not in"),
                ("1hvr_protein", "CSO +9 atoms +A:67 B:67 .*\n.*--as CSO=CYS.*\n.*a residue is not")):
            with self.subTest(expected=expected):
                self.assertRegex(self.refuse(hiv / f"{structure}.pdb"), expected)
        result = self.palpa("prepare", hiv / "5vea_ligand.pdb", "--toppar", *self.toppar(),
                            *self.tl3(), "-o", self.folder / "refused")
        self.assertEqual(result.returncode, 2)
        self.assertRegex(result.stderr, "A:101 and B:101 have each 33 of its 66.*halves")
        self.assertEqual(result.stderr.strip().count("\n"), 0, result.stderr)

    def crambin(self, change):
        """A copy of 1CRN whose ATOM lines were changed."""
        lines = (self.data / "structures" / "1crn.pdb").read_text().splitlines()
        copy = self.folder / "changed.pdb"
        copy.write_text("\n".join(change(line) if line.startswith("ATOM") else line
                                  for line in lines) + "\n")
        return copy

    @staticmethod
    def moved(line, turn):
        x, y, z = turn(*(float(line[at:at + 8]) for at in (30, 38, 46)))
        return f"{line[:30]}{x:8.3f}{y:8.3f}{z:8.3f}{line[54:]}"

    def test_coordinates_that_cannot_be_are_refused_or_told(self):
        nanometres = self.crambin(
            lambda line: self.moved(line, lambda x, y, z: (x / 10, y / 10, z / 10)))
        self.assertIn("expected coordinates in Å", self.refuse(nanometres))
        one_place = self.crambin(lambda line: self.moved(line, lambda x, y, z: (14.0, 7.0, 4.0))
                                 if line[17:26] == "SER A  11" else line)
        self.assertRegex(self.refuse(one_place), "is 0.00 Å from A2 SER 11")
        mirror = self.crambin(lambda line: self.moved(line, lambda x, y, z: (-x, y, z)))
        folder = self.prepare(mirror, self.toppar()[:2], "--no-relax")
        self.assertIn("D-amino acids, or a mirror image", (folder / "report.txt").read_text())

    def test_single_residues_beside_a_gap(self):
        for gap, warning in (("A:45", "gap between ALA A 44|gap between TYR A 44"),
                             ("A:2", "THR A 1 is a single residue before a gap")):
            with self.subTest(gap=gap):
                folder = self.prepare(self.data / "structures" / "1crn.pdb", self.toppar()[:2],
                                      "--without", gap)
                self.assertRegex((folder / "report.txt").read_text(), warning)

    def test_a_single_atom_is_an_ion(self):
        """CGenFF has a residue CA of another molecule."""
        calcium = self.folder / "calcium.pdb"
        calcium.write_text((self.data / "structures" / "1crn.pdb").read_text().replace("END", "") +
                           "HETATM  900 CA    CA I   1      60.000  60.000  60.000  1.00  0.00"
                           "          CA\n")
        folder = self.prepare(calcium, self.toppar())
        self.assertEqual(read_psf(folder / "system.psf")[0][-1][2], "CAL")

    def test_a_failed_write_leaves_nothing(self):
        blocked = self.folder / "blocked"
        (blocked / "system.crd").mkdir(parents=True)
        result = self.palpa("prepare", self.data / "structures" / "alanine_dipeptide.pdb",
                            "--toppar", *self.toppar()[:2], "-o", blocked, "--overwrite")
        self.assertEqual(result.returncode, 2)
        self.assertIn("system.crd", result.stderr)
        self.assertEqual([path.name for path in blocked.iterdir()], ["system.crd"])

    def test_what_replaces_a_preparation_leaves_nothing_of_it(self):
        crambin = self.data / "structures" / "1crn.pdb"
        folder = self.folder / "replaced"
        for structure, *options in ((crambin,), (self.data / "structures" / "alanine_dipeptide.pdb", "--no-scene")):
            result = self.palpa("prepare", structure, "--toppar", *self.toppar(), "-o", folder, "--overwrite", *options)
            self.assertEqual(result.returncode, 0, result.stderr)
            self.assertEqual((folder / "scene.toml").exists(), not options)
            (folder / "notes.txt").write_text("mine")
        self.assertEqual({path.name for path in folder.iterdir()},
                         {"system.psf", "system.pdb", "system.crd", "system.prm", "report.txt", "notes.txt"})

    def test_a_file_that_may_be_cut_off_is_a_warning(self):
        whole = (self.data / "structures" / "1crn.pdb").read_text()
        (self.folder / "cut.pdb").write_text(whole[:whole.index("ATOM    200")])
        folder = self.prepare(self.folder / "cut.pdb", self.toppar())
        self.assertIn("no END record: the file may be cut off", (folder / "report.txt").read_text())

    def test_nothing_is_overwritten_unasked(self):
        structure = self.data / "structures" / "alanine_dipeptide.pdb"
        folder = self.prepare(structure, self.toppar()[:2])
        before = (folder / "system.psf").read_text()
        result = self.palpa("prepare", structure, "--toppar", *self.toppar()[:2], "-o", folder)
        self.assertEqual(result.returncode, 2)
        self.assertIn("--overwrite", result.stderr)
        self.assertEqual((folder / "system.psf").read_text(), before)


if __name__ == "__main__":
    unittest.main()
