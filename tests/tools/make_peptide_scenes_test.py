"""The inputs of scenes/hairpin and scenes/peptide are what tools/scripts/make_peptide_scenes makes."""
import os
import subprocess
import tempfile
import unittest
from pathlib import Path

ROOT = Path(os.environ["PALPA_ROOT"])
DATA = os.environ.get("PALPA_DATA")
SCRIPT = ROOT / "tools" / "scripts" / "make_peptide_scenes"
SCENES = ROOT / "scenes"


def places(path):
    lines = [line for line in path.read_text().splitlines() if not line.startswith("*")]
    return [line.split() for line in lines[1:]]


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
                if not name.endswith(".crd"):
                    continue
                for a, b in zip(places(Path(folder) / name), places(SCENES / name), strict=True):
                    self.assertEqual(a[:4] + a[7:9], b[:4] + b[7:9])
                    # At rest to 0.001 kcal/mol; sums in single precision or double differ by 0.002 Å.
                    for x, y in zip(a[4:7], b[4:7]):
                        self.assertAlmostEqual(float(x), float(y), delta=0.02, msg=a[:4])

    def test_it_explains_itself_and_says_what_is_missing(self):
        kept = {key: value for key, value in os.environ.items() if key != "PALPA_DATA"}
        told = subprocess.run([SCRIPT, "--help"], capture_output=True, text=True, env=kept)
        self.assertEqual(told.returncode, 0)
        self.assertIn("PALPA_DATA", told.stdout)
        refused = subprocess.run([SCRIPT], capture_output=True, text=True, env=kept)
        self.assertEqual(refused.returncode, 2)
        self.assertIn("PALPA_DATA is not set", refused.stderr)


if __name__ == "__main__":
    unittest.main()
