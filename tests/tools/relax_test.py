"""palpa relax from outside: flexible molecules come to rest, and a scene can begin from there."""
import json
import os
import shutil
import subprocess
import tempfile
import unittest
from pathlib import Path

PROGRAM = os.environ["PALPA_PROGRAM"]
ROOT = Path(os.environ["PALPA_ROOT"])
DATA = ROOT / "tests" / "data"
REST = 0.05

SCENE = (DATA / "two_peptides" / "scene.toml").read_text()


class Relax(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name) / "two_peptides"
        shutil.copytree(DATA / "two_peptides", self.folder)

    def palpa(self, *arguments):
        return subprocess.run([PROGRAM, *map(str, arguments)], capture_output=True, text=True,
                              stdin=subprocess.DEVNULL)

    def relax(self, *arguments, code=0):
        result = self.palpa("relax", self.folder, *arguments)
        self.assertEqual(result.returncode, code, result.stdout + result.stderr)
        return result

    def assert_bad_input(self, result, *expected):
        self.assertEqual(result.returncode, 2, result.stdout + result.stderr)
        self.assertEqual(len(result.stderr.strip().splitlines()), 1, result.stderr)
        for text in expected:
            self.assertIn(text, result.stderr)

    def test_it_has_help(self):
        self.assertIn("relax", self.palpa("--help").stdout)
        result = self.palpa("relax", "--help")
        self.assertEqual(result.returncode, 0)
        self.assertIn("--output", result.stdout)
        self.assert_bad_input(self.palpa("relax"), "palpa relax: ")

    def test_molecules_come_to_rest_and_it_says_how(self):
        text = self.relax().stdout
        report = json.loads(self.relax("--json").stdout)
        self.assertIn("32 joints", text)
        self.assertIn("at rest", text)
        self.assertEqual(report["joints"], 32)
        self.assertEqual(report["end"], "at rest")
        self.assertLess(report["energy_after"], report["energy_before"])
        self.assertLessEqual(report["rms_force"], REST)
        self.assertGreater(report["largest_move"], 0)
        self.assertGreater(report["evaluations"], report["steps"])

    def test_a_scene_begins_where_they_rest(self):
        first = json.loads(self.relax("-o", self.folder / "rest.crd", "--json").stdout)
        # Rounding of coordinates to ten decimals adds less than this to the rms force.
        again = json.loads(self.relax("--json", "--set", "molecules.resting.structure=rest.crd",
                                      "--set", "molecules.held.structure=rest.crd", "--set",
                                      f"statics.rest_kcal_per_mol={REST * 1.0001}").stdout)
        self.assertEqual(again["steps"], 0)
        self.assertEqual(again["largest_move"], 0)
        self.assertAlmostEqual(again["energy_before"], first["energy_after"], delta=1e-5)
        self.assertAlmostEqual(again["rms_force"], first["rms_force"], delta=1e-4 * REST)
        self.assertIn("Two peptides: relaxed", (self.folder / "rest.crd").read_text())

    def test_the_same_command_writes_the_same_bytes(self):
        for name in ("a.crd", "b.crd"):
            self.relax("-o", self.folder / name)
        self.assertEqual((self.folder / "a.crd").read_bytes(),
                         (self.folder / "b.crd").read_bytes())

    def test_what_is_not_at_rest_fails_and_says_so(self):
        result = self.relax("--set", "statics.relax_steps=2", "-o", self.folder / "way.crd", code=1)
        self.assertIn("not at rest", result.stdout)
        self.assertTrue((self.folder / "way.crd").exists())
        report = json.loads(self.relax("--json", "--set", "statics.relax_steps=2", code=1).stdout)
        self.assertEqual(report["steps"], 2)
        self.assertGreater(report["rms_force"], REST)

    def test_molecules_in_one_place_are_told_of(self):
        lines = (self.folder / "both.crd").read_text().splitlines()
        atoms = (len(lines) - 3) // 2
        for i in range(3, 3 + atoms):
            lines[i + atoms] = lines[i + atoms][:40] + lines[i][40:100] + lines[i + atoms][100:]
        (self.folder / "both.crd").write_text("\n".join(lines) + "\n")
        result = self.palpa("relax", self.folder, "--set", "statics.relax_steps=0")
        self.assertRegex(result.stderr, r"^warning: atoms overlap: PEP. .* are 0\.00 Å "
                                        rf"apart, and {atoms - 1} more such pairs\n$")

    def test_a_rigid_scene_has_nothing_to_relax(self):
        self.assert_bad_input(self.palpa("relax", ROOT / "scenes" / "water"), "scene.toml: ",
                              "no molecule of this scene moves by itself", 'shape = "flexible"')

    def test_bad_input_is_told_with_file_and_line(self):
        (self.folder / "scene.toml").write_text(SCENE + '[joints]\nturn = ["PEPA 2 CA CX"]\n')
        line = SCENE.count("\n") + 2
        self.assert_bad_input(self.palpa("relax", self.folder), f"scene.toml:{line}:", "'CX'")

    def test_an_output_that_cannot_be_written_is_told(self):
        self.assert_bad_input(self.palpa("relax", self.folder, "-o", self.folder / "no" / "x.crd"),
                              "x.crd")


if __name__ == "__main__":
    unittest.main()
