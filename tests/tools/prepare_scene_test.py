"""The scenes of palpa prepare open guarded, move what they hold and let it be felt."""
import json
import os
import re
import subprocess
import sys
import tomllib
import unittest
from pathlib import Path

sys.path.append(str(Path(__file__).resolve().parents[1] / "support"))
from prepare_case import PrepareCase  # noqa: E402
from terminal import run_on_terminal  # noqa: E402

PROGRAM = os.environ["PALPA_PROGRAM"]


def palpa(*arguments):
    return subprocess.run([PROGRAM, *map(str, arguments)], capture_output=True, text=True)


class PrepareScene(PrepareCase):
    def setUp(self):
        super().setUp()
        self.toppar = self.charmm_files("top_all36_prot.rtf", "par_all36m_prot.prm",
                                        "toppar_water_ions.str")

    def prepare(self, structure, *options):
        result = palpa("prepare", "--only-toppar", self.data / structure, "-o", self.folder / "mine", "--toppar",
                       *self.toppar, *options)
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertEqual(result.stderr, "")  # progress is for a terminal
        return result.stdout

    def scene(self):
        return tomllib.loads((self.folder / "mine" / "scene.toml").read_text())

    def largest_felt(self):
        """What a run of the scene, as it is, sends to the hand; from its recording, any direction."""
        mine, record = self.folder / "mine", self.folder / "record"
        result = palpa("run", mine, "--headless", "--seconds", 10, "--record", record)
        self.assertEqual(result.returncode, 0, result.stderr)
        rows = (record / "trace.csv").read_text().splitlines()
        columns = rows[0].split(",")
        at = [columns.index(f"device_force_{axis}_N") for axis in "xyz"]
        felt = 0
        for row in rows[1:]:
            words = row.split(",")
            felt = max(felt, sum(float(words[i])**2 for i in at)**0.5)
        return felt, json.loads((record / "summary.json").read_text())

    def check_felt(self, at_most_ms):
        """Felt above friction, moved by more than that, without a warning, guarded, in the time."""
        felt, summary = self.largest_felt()
        self.assertGreater(felt, 0.3)
        self.assertGreater(summary["farthest_angstrom"], 1)
        self.assertEqual(summary["mode"], "guarded")
        # The run ends while the hand is on its way back; of nothing else it warns.
        self.assertEqual([w for w in summary["warnings"] if "run.seconds" not in w], [])
        self.assertEqual(summary["steps_not_finite"], 0)
        self.assertLessEqual(summary["period_ms"], at_most_ms)
        self.assertGreaterEqual(summary["period_ms"], 5)  # drawing takes the cores as long

    def check_range_is_of_these_forces(self):
        """The range that is felt has the forces that the trace has, not any that would do."""
        weakest, strongest = self.scene()["coupling"]["feel_pN"]
        rows = (self.folder / "record" / "trace.csv").read_text().splitlines()
        at = [rows[0].split(",").index(f"force_{axis}_nN") for axis in "xyz"]
        forces = sorted(1000 * sum(float(row.split(",")[i])**2 for i in at)**0.5
                        for row in rows[1:])
        strong = forces[len(forces) * 9 // 10]
        self.assertGreater(strong, 2 * weakest)
        self.assertLess(strong, strongest)
        self.assertGreater(strong, strongest / 15)

    def test_a_single_chain_has_a_residue_on_a_spring(self):
        told = self.prepare("structures/1crn.pdb")
        scene = self.scene()
        self.assertEqual(scene["grab"]["atom"], self.most_exposed("structures/1crn.pdb", "A"))
        self.assertIn(f"palpa run {self.folder / 'mine'} --headless", told)
        self.assertIn("in the hand: residue PRO 36 of A", told)
        self.assertRegex(told, r"period \d+ ms: 99 % of steps (without a renewal )?took")
        self.check_felt(100)
        self.check_range_is_of_these_forces()
        check = palpa("run", "--check", self.folder / "mine")
        self.assertRegex(check.stdout, "in 0 steps, largest move 0.000 Å")  # it opens at rest

    def most_exposed(self, structure, chain):
        residues, heavy = {}, []
        for line in (self.data / structure).read_text().splitlines():
            if not line.startswith("ATOM") or line[76:78].strip() == "H":
                continue
            place = tuple(float(line[at:at + 8]) for at in (30, 38, 46))
            heavy.append((line[21:26], place))
            if line[21] == chain:
                residues.setdefault(line[21:26], []).append(place)

        def neighbours(residue):
            places = residues[residue]
            middle = [sum(axis) / len(places) for axis in zip(*places)]
            return sum(other != residue and sum((a - b)**2 for a, b in zip(place, middle)) < 100
                       for other, place in heavy)
        return min(residues, key=neighbours)[1:].strip()

    def test_of_hiv_protease_whose_chains_hold_each_other_a_residue_is_in_the_hand(self):
        told = self.prepare("hiv/1hsg_protein.pdb")
        self.assertRegex(told, r"the whole molecule B needs a new model in \d+ % of the steps")
        self.assertEqual(self.scene()["grab"], {"molecule": "A", "measured_from": "A",
                                                "atom": self.most_exposed("hiv/1hsg_protein.pdb",
                                                                          "A")})
        self.check_felt(1000)
        self.check_range_is_of_these_forces()

    def test_an_inhibitor_is_held_whole(self):
        derived = self.data / "hiv" / "derived"
        charmm = self.data / "charmm"
        self.toppar[2:] = [charmm / "top_all36_cgenff.rtf", charmm / "par_all36_cgenff.prm",
                           derived / "3tl_draft.rtf", derived / "3tl_draft.prm"]
        self.prepare("hiv/derived/5w5w_tl3_complex.pdb")
        grab = self.scene()["grab"]
        self.assertEqual((grab["molecule"], "atom" in grab), ("3TL", False))
        self.check_felt(1000)
        self.check_range_is_of_these_forces()

    def test_a_small_molecule_has_a_scene_and_stays_in_its_frame_if_asked(self):
        told = self.prepare("structures/alanine_dipeptide.pdb", "--x-along", "P")
        self.assertIn("of ALA 2 P, on a spring", told)
        self.check_felt(100)
        # The rest is what turned; where the axes were asked for nothing is turned again: the
        # middle stays, but for what relaxing moved.
        middles = []
        for name in ("system.crd", "relaxed.crd"):
            lines = [line for line in (self.folder / "mine" / name).read_text().splitlines()
                     if not line.startswith("*")][1:]
            longest = max(lines, key=lambda line: float(line.split()[4]))
            middles.append(longest.split()[2:4])
        self.assertEqual(*middles)

    def test_without_a_scene(self):
        told = self.prepare("structures/alanine_dipeptide.pdb", "--no-scene")
        self.assertNotIn("palpa run", told)
        self.assertEqual(sorted(path.name for path in (self.folder / "mine").iterdir()),
                         ["report.txt", "system.crd", "system.pdb", "system.prm", "system.psf"])

    def test_what_is_to_be_grabbed_must_be_there(self):
        result = palpa("prepare", "--only-toppar", self.data / "structures" / "alanine_dipeptide.pdb", "-o",
                       self.folder / "mine", "--toppar", *self.toppar, "--grab", "P:99")
        self.assertEqual(result.returncode, 2)
        self.assertIn("--grab P:99", result.stderr)
        self.assertFalse((self.folder / "mine").exists())

    def test_a_folder_that_cannot_be_made_is_refused_before_the_work(self):
        (self.folder / "file").write_text("")
        # The structure is not there either: it was not looked for.
        for folder, expected in ((self.folder / "file" / "mine", "file is not a folder"),
                                 (self.folder / "file", "file")):
            result = palpa("prepare", "--only-toppar", self.folder / "absent.pdb", "-o", folder, "--toppar",
                           *self.toppar)
            self.assertEqual(result.returncode, 2)
            self.assertIn(expected, result.stderr)
            self.assertNotIn("absent.pdb", result.stderr)
        self.assertEqual(list(self.folder.iterdir()), [self.folder / "file"])

    def test_a_terminal_shows_what_takes_long(self):
        code, text = run_on_terminal([PROGRAM, "prepare",
                                      self.data / "structures" / "alanine_dipeptide.pdb", "-o",
                                      self.folder / "mine", "--toppar", *self.toppar])
        self.assertEqual(code, 0)
        for stage in ("reading the force field", "relaxing clashes", "measuring the forces",
                      "playing the scene"):
            self.assertIn(stage, text)
        self.assertRegex(text, r"playing the scene +\d+ %")
        self.assertNotIn("\n", text)
        self.assertRegex(text, r"\r +\r$")  # the line is wiped


if __name__ == "__main__":
    unittest.main()
