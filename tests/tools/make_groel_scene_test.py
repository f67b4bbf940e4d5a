"""tools/scripts/make_groel_scene makes what scenes/groel names; both say what is missing."""
import gzip
import os
import shutil
import subprocess
import tempfile
import unittest
from pathlib import Path

PROGRAM = os.environ["PALPA_PROGRAM"]
ROOT = Path(os.environ["PALPA_ROOT"])
SCRIPT = ROOT / "tools" / "scripts" / "make_groel_scene"


def run(*command, **environment):
    kept = {key: value for key, value in os.environ.items() if key != "PALPA_DATA"}
    return subprocess.run([str(word) for word in command], capture_output=True, text=True,
                          env={**kept, **environment})


FILES = ("structures/1aon.pdb.gz", "charmm/top_all36_prot.rtf", "charmm/par_all36m_prot.prm",
         "charmm/top_all36_cgenff.rtf", "charmm/par_all36_cgenff.prm",
         "charmm/toppar_water_ions.str")

# Writes what it was asked for; relax says that it did not come to rest, or what it is told to.
STAND_IN = """#!/bin/sh
command=$1
while [ "$1" != -o ]; do shift; done
case $command in
    prepare) for file in system.psf system.crd system.prm report.txt; do
                 echo "prepared $file" >"$2/$file"
             done ;;
    relax) echo relaxed >"$2"; exit "${RELAX_ENDS:-1}" ;;
esac
"""


class MakeGroelScene(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)

    def refused(self, result, *words):
        self.assertEqual(result.returncode, 2, result.stderr)
        self.assertEqual(len(result.stderr.splitlines()), 1, result.stderr)
        for word in words:
            self.assertIn(word, result.stderr)

    def test_it_explains_itself(self):
        result = run(SCRIPT, "--help")
        self.assertEqual(result.returncode, 0)
        self.assertIn("PALPA_DATA", result.stdout)

    def test_without_data_it_says_what_is_expected(self):
        self.refused(run(SCRIPT, self.folder / "made"), "PALPA_DATA", "data/charmm")
        self.assertFalse((self.folder / "made").exists())

    def test_it_names_the_file_that_is_missing(self):
        (self.folder / "data" / "structures").mkdir(parents=True)
        (self.folder / "data" / "structures" / "1aon.pdb.gz").touch()
        result = run(SCRIPT, self.folder / "made", PALPA_DATA=str(self.folder))
        self.refused(result, "charmm/top_all36_prot.rtf", "no such file")
        self.assertFalse((self.folder / "made").exists())

    def stand_in(self):
        for name in FILES:
            path = self.folder / "data" / name
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_bytes(gzip.compress(b"") if name.endswith(".gz") else b"")
        program = self.folder / "palpa"
        program.write_text(STAND_IN)
        program.chmod(0o755)
        return {"PALPA_DATA": str(self.folder), "PALPA_PROGRAM": str(program)}

    def made_folder(self, *options, files):
        made = self.folder / "made"
        result = run(SCRIPT, *options, made, **self.stand_in())
        self.assertEqual(result.returncode, 0, result.stderr)
        for name in ("system.psf", "system.prm", "report.txt"):
            self.assertEqual((made / name).read_text(), f"prepared {name}\n")
        scene = (ROOT / "scenes" / "groel" / "scene.toml").read_text()
        self.assertEqual((made / "scene.toml").read_text(), scene)
        self.assertEqual(sorted(path.name for path in made.iterdir()),
                         sorted(["report.txt", "scene.toml", "system.prm", "system.psf", *files]))
        return made

    def test_the_folder_has_what_was_prepared_and_the_pose(self):
        made = self.made_folder(files=["relaxed.crd"])
        pose = gzip.decompress((ROOT / "scenes" / "groel" / "pose.crd.gz").read_bytes())
        self.assertEqual((made / "relaxed.crd").read_bytes(), pose)
        self.assertIn(b"    120400  EXT\n", pose[:1000])

    def test_made_anew_it_has_where_it_came_to_rest(self):
        made = self.made_folder("--anew", files=["relaxed.crd", "pose.crd.gz"])
        self.assertEqual((made / "relaxed.crd").read_text(), "relaxed\n")
        self.assertEqual(gzip.decompress((made / "pose.crd.gz").read_bytes()), b"relaxed\n")

    def test_nothing_is_written_where_relaxing_fails(self):
        made = self.folder / "made"
        result = run(SCRIPT, "--anew", made, **self.stand_in(), RELAX_ENDS="2")
        self.assertEqual(result.returncode, 2)
        self.assertFalse(made.exists())

    def test_the_scene_without_its_inputs_says_where_to_look(self):
        shutil.copy(ROOT / "scenes" / "groel" / "scene.toml", self.folder)
        result = run(PROGRAM, "run", "--check", self.folder)
        self.refused(result, "names a file that does not exist", "made_by says")


if __name__ == "__main__":
    unittest.main()
