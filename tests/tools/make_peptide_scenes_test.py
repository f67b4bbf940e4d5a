"""The inputs of scenes/hairpin and scenes/peptide are what tools/scripts/make_peptide_scenes makes."""
import os
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

sys.path.append(str(Path(__file__).resolve().parents[1] / "support"))
from made_scenes import assert_explains_itself, assert_same_atoms  # noqa: E402

ROOT = Path(os.environ["PALPA_ROOT"])
DATA = os.environ.get("PALPA_DATA")
SCRIPT = ROOT / "tools" / "scripts" / "make_peptide_scenes"
SCENES = ROOT / "scenes"


class MakePeptideScenes(unittest.TestCase):
    @unittest.skipUnless(DATA, "PALPA_DATA names no folder with data/structures and data/charmm")
    def test_it_makes_what_is_committed(self):
        with tempfile.TemporaryDirectory() as folder:
            subprocess.run([SCRIPT, folder], check=True, capture_output=True)
            made = {str(path.relative_to(folder)) for path in Path(folder).glob("*/*")}
            self.assertEqual(made, {"hairpin/system.psf", "hairpin/vacuum.psf", "hairpin/system.prm",
                                    "hairpin/relaxed.crd", "hairpin/vacuum.crd", "hairpin/report.txt",
                                    "peptide/system.psf", "peptide/system.prm", "peptide/relaxed.crd",
                                    "peptide/report.txt"})
            for name in made:
                if name.endswith((".psf", ".prm")):
                    self.assertEqual((Path(folder) / name).read_text(), (SCENES / name).read_text(), name)
                if name.endswith(".crd"):
                    # At rest to 0.001 kcal/mol; sums in single precision or double differ by 0.002 Å.
                    assert_same_atoms(self, Path(folder) / name, SCENES / name, 0.02)

    def test_it_explains_itself_and_says_what_is_missing(self):
        assert_explains_itself(self, SCRIPT)


if __name__ == "__main__":
    unittest.main()
