"""palpa engine: what it writes is run by GROMACS and LAMMPS, whose energies are those of palpa energy."""
import json
import math
import os
import re
import socket
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

ROOT = Path(os.environ["PALPA_ROOT"])
sys.path.insert(0, str(ROOT / "tests/support"))
import engines  # noqa: E402

PROGRAM = os.environ["PALPA_PROGRAM"]
PEPTIDES = ROOT / "tests/data/two_peptides"
HIV = ROOT / "scenes/hiv"
BOXES = ROOT / "scenes/engine"
EDGES = "18.631,18.631,18.631"
KJ_PER_KCAL = 4.184

NO_GROMACS = engines.missing("gmx", "gmx_d")
NO_LAMMPS = engines.missing("lmp")


def palpa(*words):
    return subprocess.run([PROGRAM, *map(str, words)], capture_output=True, text=True)


def peptides():
    """Two peptides with cross-terms, Urey-Bradley terms and NBFIX pairs."""
    return (PEPTIDES / "both.psf", PEPTIDES / "both.crd",
            [PEPTIDES / "aera_c36m.rtf", PEPTIDES / "aera_c36m.prm"])


def hiv():
    return HIV / "system.psf", HIV / "system.crd", [HIV / "system.prm"]


def box(name):
    return BOXES / name / "system.psf", BOXES / name / "system.crd", [BOXES / name / "system.prm"]


class Case(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name) / "run"

    def write(self, engine, system, *options):
        psf, coordinates, toppar = system
        result = palpa("engine", engine, "-o", self.folder, "--psf", psf, "--coordinates", coordinates,
                       *options, "--toppar", *toppar)
        self.assertEqual(result.returncode, 0, result.stderr)
        return result

    def energy(self, system):
        psf, coordinates, toppar = system
        result = palpa("energy", psf, "--coordinates", coordinates, "--json", "--toppar", *toppar)
        self.assertEqual(result.returncode, 0, result.stderr)
        return json.loads(result.stdout)

    def assert_same(self, ours, theirs, name):
        print(f"{self.id()}: {name}: {abs(ours - theirs) / max(abs(ours), 1e-3):.1e} of {ours:.6g}")
        self.assertLessEqual(abs(ours - theirs), 1e-6 * max(abs(ours), 1e-3), f"{name}: {ours} and {theirs}")


@unittest.skipIf(NO_GROMACS, NO_GROMACS)
class Gromacs(Case):
    def compare(self, system, has_maps=True):
        self.write("gromacs", system)
        ours, theirs = self.energy(system), engines.gromacs_energies(self.folder)
        # Angles with a Urey-Bradley term are one kind of term with it there, all others another.
        pairs = {"Bond": ("bond",), "Angle U-B": ("angle", "urey_bradley"), "Proper Dih.": ("dihedral",),
                 "Improper Dih.": ("improper",), "CMAP Dih.": ("cmap",), "LJ (SR)": ("lj",), "LJ-14": ("lj14",),
                 "Coulomb (SR)": ("coulomb",), "Coulomb-14": ("coulomb14",), "Potential": ("total",)}
        theirs["Angle U-B"] = theirs.get("Angle", 0) + theirs.get("U-B", 0)
        for name, terms in pairs.items():
            value = KJ_PER_KCAL * sum(ours[term] for term in terms)
            self.assert_same(value, theirs.get(name, 0.0), name)
        self.assertEqual(ours["cmap"] != 0, has_maps)
        return ours

    def test_peptides_with_cross_terms_and_nbfix_have_its_energies(self):
        ours = self.compare(peptides())
        self.assertGreater(ours["urey_bradley"], 1)
        top = (self.folder / "system.top").read_text()
        self.assertRegex(top, r"\[ nonbond_params \]\nOC NC2 1|\[ nonbond_params \]\nNC2 OC 1")
        # Both peptides are one kind of molecule.
        self.assertEqual(top.count("[ moleculetype ]"), 1)
        self.assertTrue(top.endswith("[ molecules ]\nPEPA 2\n"), top[-100:])

    def test_a_protease_with_its_inhibitor_has_its_energies(self):
        self.compare(hiv())

    def test_waters_in_vacuum_have_its_energies(self):
        self.compare(box("water"), has_maps=False)
        self.assertIn("[ settles ]", (self.folder / "system.top").read_text())

    def test_a_peptide_in_water_runs(self):
        result = self.write("gromacs", box("peptide"), "--box", EDGES, "--steps", 100)
        self.assertIn("8.3 Å is used instead", result.stderr)
        start = (self.folder / "run.sh").read_text()
        self.assertIn("-imdport 8888 -imdwait -imdpull", start)
        grompp = re.search(r"grompp (.*?) &&", start)[1].split()
        engines.run(self.folder, "gmx", "grompp", *grompp)
        engines.run(self.folder, "gmx", "mdrun", "-s", "run.tpr", "-deffnm", "run", "-nt", 1)
        engines.run(self.folder, "gmx", "energy", "-f", "run.edr", "-o", "run.xvg",
                    answers="Potential\nTemperature\n\n")
        rows = [[float(word) for word in line.split()] for line in (self.folder / "run.xvg").read_text().splitlines()
                if line[0] not in "#@"]
        self.assertAlmostEqual(rows[-1][0], 0.2, delta=1e-6)  # ps
        for _, potential, temperature in rows:
            self.assertLess(potential, -8000)
            self.assertGreater(temperature, 200)
            self.assertLess(temperature, 400)


@unittest.skipIf(NO_LAMMPS, NO_LAMMPS)
class Lammps(Case):
    def compare(self, system):
        self.write("lammps", system)
        ours = self.energy(system)
        theirs = engines.lammps_rows(self.folder, "-var", "steps", 0, "-var", "rigid", 0)[0]
        pairs = {"E_bond": ("bond",), "E_angle": ("angle", "urey_bradley"), "E_dihed": ("dihedral",),
                 "E_impro": ("improper",), "f_maps": ("cmap",), "E_vdwl": ("lj", "lj14"),
                 "E_coul": ("coulomb", "coulomb14"), "PotEng": ("total",)}
        for name, terms in pairs.items():
            self.assert_same(sum(ours[term] for term in terms), theirs.get(name, 0.0), name)

    def test_peptides_with_cross_terms_and_nbfix_have_its_energies(self):
        self.compare(peptides())

    def test_a_protease_with_its_inhibitor_has_its_energies(self):
        self.compare(hiv())

    def test_waters_in_vacuum_have_its_energies(self):
        self.compare(box("water"))

    def test_a_peptide_in_water_runs(self):
        self.write("lammps", box("peptide"), "--box", EDGES, "--steps", 100)
        self.assertIn("imd ${port} unwrap on trate 2", (self.folder / "run.in").read_text())
        rows = engines.lammps_rows(self.folder)
        self.assertEqual(rows[-1]["Step"], 100)
        for row in rows:
            self.assertTrue(all(map(math.isfinite, row.values())), row)
            self.assertGreater(row["Temp"], 200)
            self.assertLess(row["Temp"], 400)


class Live(Case):
    def join(self, engine):
        """Starts run.sh as it is, joins it, pulls an atom and ends it; sizes of the frames that came."""
        with socket.socket() as free:
            free.bind(("127.0.0.1", 0))
            port = free.getsockname()[1]
        self.write(engine, box("peptide"), "--box", EDGES, "--send", "PEPA", "--port", port)
        with open(self.folder / "out", "w") as out:
            running = subprocess.Popen(["sh", "run.sh"], cwd=self.folder, env=engines.environment(self.folder),
                                       stdin=subprocess.DEVNULL, stdout=out, stderr=out)
        try:
            return engines.pull(port, running, frames=20)
        except OSError as error:
            self.fail(f"{error}\n{(self.folder / 'out').read_text()[-2000:]}")
        finally:
            running.kill()
            running.wait()

    @unittest.skipIf(NO_GROMACS, NO_GROMACS)
    def test_a_client_joins_gromacs(self):
        self.assertEqual(self.join("gromacs"), [62] * 20)

    @unittest.skipIf(NO_LAMMPS, NO_LAMMPS)
    def test_a_client_joins_lammps(self):
        self.assertEqual(self.join("lammps"), [62] * 20)


class Files(Case):
    def test_boxes_are_made_again_by_their_script(self):
        made = self.folder.parent / "made"
        subprocess.run([ROOT / "tools/scripts/make_engine_scene", made], check=True, capture_output=True)
        for name in ("water", "peptide"):
            for path in sorted((BOXES / name).iterdir()):
                self.assertEqual((made / name / path.name).read_text(), path.read_text(), path)

    def test_a_segment_alone_is_sent(self):
        self.write("gromacs", box("peptide"), "--box", EDGES, "--send", "PEPA", "--port", 9001)
        index = (self.folder / "index.ndx").read_text()
        self.assertEqual(index.split("[ sent ]")[1].split(), [str(i) for i in range(1, 63)])
        self.assertIn("62 !NATOM", (self.folder / "sent.psf").read_text())
        self.assertIn("-imdport 9001", (self.folder / "run.sh").read_text())
        self.write("lammps", box("peptide"), "--box", EDGES, "--send", "PEPA", "--overwrite")
        self.assertIn("group sent id 1:62\n", (self.folder / "run.in").read_text())

    def test_a_scene_is_taken_and_the_next_line_is_printed(self):
        result = palpa("engine", "gromacs", ROOT / "scenes/hairpin/vacuum.toml", "-o", self.folder)
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertIn(f"palpa connect 127.0.0.1:8888 --topology {self.folder}/system.psf", result.stdout)
        again = palpa("engine", "gromacs", ROOT / "scenes/hairpin/vacuum.toml", "-o", self.folder)
        self.assertEqual(again.returncode, 2)
        for engine in "gromacs", "lammps":
            again = palpa("engine", engine, ROOT / "scenes/hairpin/vacuum.toml", "-o", self.folder, "--overwrite")
            self.assertEqual(again.returncode, 0, again.stderr)

    def test_names_with_spaces_are_quoted_in_the_next_line(self):
        folder = self.folder.parent / "my run"
        result = palpa("engine", "gromacs", ROOT / "scenes/hairpin/vacuum.toml", "-o", folder)
        self.assertIn(f'sh "{folder}/run.sh"\n', result.stdout)
        self.assertIn(f'--topology "{folder}/system.psf"\n', result.stdout)

    def test_a_box_too_short_for_a_run_has_no_next_line(self):
        for waters, expected in ((8, "too short for a run"), (64, "palpa engine gromacs")):
            folder = self.folder / str(waters)
            result = palpa("engine", "box", "-o", folder, "--waters", waters, "--toppar",
                           ROOT / "scenes/water/tip3p.str")
            self.assertEqual(result.returncode, 0, result.stderr)
            self.assertIn(expected, result.stdout)
        self.assertNotIn("too short", result.stdout)

    def test_what_cannot_be_run_is_refused(self):
        psf, coordinates, toppar = box("peptide")
        system = ["--psf", psf, "--coordinates", coordinates, "--toppar", *toppar]
        for words, message in (
                ([ROOT / "scenes/hairpin"], "implicit water"),
                ([], "expected a scene, or --psf"),
                (["--psf", psf], "--psf, --coordinates and --toppar together"),
                (["--box", "8,30,30", *system], "too short for a cutoff"),
                (["--box", "18,18", *system], "expected three edges"),
                (["--send", "PEPX", *system], "there is no segment of this name; did you mean 'PEPA'"),
        ):
            result = palpa("engine", "gromacs", "-o", self.folder, *words)
            self.assertEqual(result.returncode, 2, words)
            self.assertIn(message, result.stderr)
        result = palpa("engine", "box", "-o", self.folder, "--waters", 100, "--toppar", *toppar)
        self.assertEqual(result.returncode, 2)
        self.assertIn("8 times a cube number", result.stderr)
        self.assertFalse(self.folder.exists())


if __name__ == "__main__":
    unittest.main()
