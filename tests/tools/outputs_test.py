"""No command replaces what is there unless told --overwrite, and then only what it wrote itself."""
import os
import shutil
import subprocess
import tempfile
import time
import unittest
from pathlib import Path

PROGRAM = os.environ["PALPA_PROGRAM"]
ROOT = Path(os.environ["PALPA_ROOT"])
WATER = ROOT / "scenes" / "water"
PEPTIDES = ROOT / "tests" / "data" / "two_peptides"


class Outputs(unittest.TestCase):
    def setUp(self):
        temporary = tempfile.TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        self.tmp = Path(temporary.name)
        self.folder = self.tmp / "recording"

    def palpa(self, *arguments, code=0):
        result = subprocess.run([PROGRAM, *map(str, arguments)], capture_output=True, text=True,
                                cwd=self.tmp, stdin=subprocess.DEVNULL)
        self.assertEqual(result.returncode, code, result.stdout + result.stderr)
        return result

    def assert_refused(self, *arguments, told):
        result = self.palpa(*arguments, code=2)
        self.assertEqual(len(result.stderr.strip().splitlines()), 1, result.stderr)
        self.assertIn(told, result.stderr)

    def record(self, *arguments, **expected):
        return self.palpa("run", WATER, "--headless", "--seconds", "0.1", "--record", self.folder,
                          *arguments, **expected)

    def files(self):
        return {path.relative_to(self.tmp): path.read_bytes()
                for path in self.tmp.rglob("*") if path.is_file()}

    def energy(self, system, *arguments):
        return ("energy", system, "--toppar", WATER / "tip3p.str", *arguments)

    def test_nothing_is_written_but_what_was_asked_for(self):
        """Neither beside the scene, nor in the home folder, nor where the command was begun."""
        scene, home, here = self.tmp / "scene", self.tmp / "home", self.tmp / "here"
        shutil.copytree(WATER, scene)
        home.mkdir()
        here.mkdir()
        own = {key: str(home) for key in ("HOME", "XDG_CONFIG_HOME", "XDG_CACHE_HOME", "XDG_DATA_HOME",
                                          "XDG_STATE_HOME", "TMPDIR")}
        out = self.tmp / "out"
        out.mkdir()
        for command in (("run", scene, "--headless", "--seconds", "0.1", "--record", out / "recording"),
                        ("run", "--check", scene), ("replay", out / "recording", "--verify"),
                        ("select", scene, "all"), ("export", scene, "-o", out / "water.pdb"),
                        ("licences",), ("devices",), ("help", "view.colour")):
            with self.subTest(command=command[0]):
                before = {path for path in self.files() if path.parts[0] != "out"}
                result = subprocess.run([PROGRAM, *map(str, command)], capture_output=True, text=True, cwd=here,
                                        stdin=subprocess.DEVNULL, env={**os.environ, **own})
                self.assertIn(result.returncode, (0, 1), result.stderr)
                self.assertEqual({path for path in self.files() if path.parts[0] != "out"}, before)
        self.assertEqual({path.parts[1] for path in self.files() if path.parts[0] == "out"},
                         {"recording", "water.pdb"})

    # ---- one file

    def test_an_output_is_replaced_on_demand_only(self):
        relax = ("relax", PEPTIDES, "--set", "relax_steps=2")
        energy = ("energy", PEPTIDES / "both.psf", "--coordinates", PEPTIDES / "both.crd",
                  "--toppar", PEPTIDES / "aera_c36m.rtf", PEPTIDES / "aera_c36m.prm", "--forces")
        for name, command, code in (("forces.csv", energy, 0),
                                    ("rest.crd", (*relax, "-o"), 1)):
            with self.subTest(name=name):
                output = self.tmp / name
                self.palpa(*command, output, code=code)
                before = output.read_bytes()
                self.assert_refused(*command, output, told=f"{name}: already exists")
                self.assertEqual(output.read_bytes(), before)
                self.palpa(*command, output, "--overwrite", code=code)
                self.assertEqual(output.read_bytes(), before)
                output.write_text("mine\n")
                self.assert_refused(*command, output, "--overwrite", told="was not written by this")
                self.assertEqual(output.read_text(), "mine\n")
        self.assertEqual(sorted(path.name for path in self.tmp.iterdir()),
                         ["forces.csv", "rest.crd"])

    def test_an_input_is_not_replaced(self):
        scene = Path(shutil.copytree(PEPTIDES, self.tmp / "scene"))
        shutil.copy(WATER / "dimer.crd", self.tmp / "dimer.crd")
        before = self.files()
        for overwrite in ((), ("--overwrite",)):
            self.palpa(*self.energy("dimer.crd", "--forces", "dimer.crd", *overwrite), code=2)
            self.palpa("relax", scene, "-o", scene / "both.crd", *overwrite, code=2)
        self.assertEqual(self.files(), before)

    def test_a_link_is_not_written_through(self):
        target = self.tmp / "target"
        link = self.tmp / "forces.csv"
        link.symlink_to(target)
        command = self.energy(WATER / "dimer.crd", "--forces", link)
        self.assert_refused(*command, told="already exists")
        self.assert_refused(*command, "--overwrite", told="is a link")
        self.assertFalse(target.exists())

    def test_an_output_without_a_folder_is_told_before_the_work(self):
        self.assert_refused("relax", PEPTIDES, "-o", self.tmp / "no" / "x.crd",
                            told="is in a folder that does not exist")

    def test_a_picture_is_replaced_on_demand_only(self):
        image = self.tmp / "image.png"
        render = ("render", WATER, "-o", image, "--size", "16x16")
        image.write_bytes((WATER / "waters.png").read_bytes()[:33] + b"mine")
        before = image.read_bytes()
        for overwrite in ((), ("--overwrite",)):
            self.palpa(*render, *overwrite, code=2)
        self.assertEqual(image.read_bytes(), before)

    def test_prepared_files_of_others_are_not_replaced(self):
        folder = self.tmp / "out"
        folder.mkdir()
        (folder / "report.txt").write_text("mine")
        prepare = ("prepare", WATER / "dimer.crd", "--keep-waters", "--toppar", WATER / "tip3p.str",
                   "-o", folder)
        self.assert_refused(*prepare, told="report.txt: already exists")
        self.assert_refused(*prepare, "--overwrite", told="report.txt: was not written by this")
        self.assertEqual(self.files(), {Path("out/report.txt"): b"mine"})

    # ---- recordings

    def test_a_recording_is_replaced_on_demand_only(self):
        self.record()
        before = self.files()
        result = self.record(code=2)
        self.assertIn("already contains a recording", result.stderr)
        self.assertEqual(self.files(), before)
        self.record("--overwrite")
        self.assertEqual(set(self.files()), set(before))
        self.palpa("replay", self.folder, "--verify")

    def test_what_somebody_put_into_a_recording_stays(self):
        self.record()
        (self.folder / "frames").mkdir()
        mine = [self.folder / name for name in
                ("notes.txt", "inputs/notes.txt", "frames/notes.txt", "frames/0000.png",
                 "inputs/other.crd")]
        for path in mine:
            path.write_text("mine")
        self.record("--overwrite")
        for path in mine:
            self.assertEqual(path.read_text(), "mine")

    def test_a_file_of_ones_own_with_a_new_name_ends_it_before_anything_is_gone(self):
        self.record()
        other = self.tmp / "other"
        shutil.copytree(WATER, other)
        (other / "tip3p.str").rename(other / "mine.str")
        scene = (other / "scene.toml").read_text().replace("tip3p.str", "mine.str")
        (other / "scene.toml").write_text(scene)
        (self.folder / "inputs" / "mine.str").write_text("mine")
        before = self.files()
        result = self.palpa("run", other, "--headless", "--seconds", "0.01", "--record",
                            self.folder, "--overwrite", code=2)
        self.assertIn("mine.str: is not part of this recording", result.stderr)
        self.assertEqual(self.files(), before)

    def test_inputs_with_names_that_toml_escapes_are_recorded_twice(self):
        other = self.tmp / "other"
        shutil.copytree(WATER, other)
        (other / "tip3p.str").rename(other / 'a"b.str')
        scene = (other / "scene.toml").read_text().replace('"tip3p.str"', """'a"b.str'""")
        (other / "scene.toml").write_text(scene)
        for extra in ([], ["--overwrite"]):
            self.palpa("run", other, "--headless", "--seconds", "0.01", "--record", self.folder,
                       *extra)
        self.palpa("replay", self.folder, "--verify")

    def test_notes_that_quote_a_recording_are_none(self):
        self.folder.mkdir()
        (self.folder / "session.toml").write_text('# replaces "# A recorded Palpa session"\n')
        (self.folder / "trace.csv").write_text("mine")
        self.assertIn("not a recording", self.record("--overwrite", code=2).stderr)
        self.assertEqual((self.folder / "trace.csv").read_text(), "mine")

    def test_links_in_a_recording_are_not_followed(self):
        outside = self.tmp / "outside"
        outside.mkdir()
        (outside / "dimer.crd").write_text("mine")
        for name in ("inputs", "frames", "trace.csv", "summary.json"):
            with self.subTest(name=name):
                shutil.rmtree(self.folder, ignore_errors=True)
                self.record()
                path = self.folder / name
                shutil.rmtree(path) if path.is_dir() else path.unlink(missing_ok=True)
                path.symlink_to(outside if name in ("inputs", "frames") else outside / "dimer.crd")
                self.record("--overwrite", code=2)
                self.assertEqual([file.name for file in outside.iterdir()], ["dimer.crd"])
                self.assertEqual((outside / "dimer.crd").read_text(), "mine")

    def test_a_folder_without_a_recording_is_not_overwritten(self):
        self.folder.mkdir()
        (self.folder / "trace.csv").write_text("mine")
        self.assertIn("not a recording", self.record(code=2).stderr)
        self.assertIn("not a recording", self.record("--overwrite", code=2).stderr)
        self.assertEqual(self.files(), {Path("recording/trace.csv"): b"mine"})

    def test_of_two_runs_into_one_folder_the_second_is_refused(self):
        first = subprocess.Popen([PROGRAM, "run", WATER, "--headless", "--seconds", "100000",
                                  "--record", self.folder], stdout=subprocess.DEVNULL,
                                 stderr=subprocess.DEVNULL)
        self.addCleanup(first.wait)
        self.addCleanup(first.kill)
        while not (self.folder / "session.toml").exists():
            self.assertIsNone(first.poll())
            time.sleep(0.01)
        session = (self.folder / "session.toml").read_bytes()
        self.assertIn("already", self.record(code=2).stderr)
        self.assertIn("another run", self.record("--overwrite", code=2).stderr)
        self.assertEqual((self.folder / "session.toml").read_bytes(), session)
        first.kill()  # after which nothing is locked any more
        first.wait()
        self.record("--overwrite")

    def test_a_refusal_comes_before_the_work(self):
        self.record()
        result = self.palpa("run", WATER, "--headless", "--record", self.folder, "--set",
                            "molecules.moved.structure=no.crd", code=2)
        self.assertIn("no.crd", result.stderr)  # the scene is read first
        result = self.palpa("run", WATER, "--headless", "--record", self.folder, "--set",
                            "molecules.moved.segment=NONE", code=2)
        self.assertIn("already contains a recording", result.stderr)


if __name__ == "__main__":
    unittest.main()
