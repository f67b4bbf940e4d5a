"""The inputs of scenes/water are what make_water_scene makes of CHARMM's own water file."""
import os
import re
import subprocess
import tempfile
import unittest
from pathlib import Path

ROOT = Path(os.environ["PALPA_ROOT"])
MAKER = Path(os.environ["PALPA_PROGRAM"]).with_name("make_water_scene")
DATA = os.environ.get("PALPA_DATA")


@unittest.skipUnless(DATA, "PALPA_DATA names no folder with data/charmm/toppar_water_ions.str")
class MakeWaterScene(unittest.TestCase):
    def test_it_makes_what_is_committed(self):
        with tempfile.TemporaryDirectory() as folder:
            subprocess.run([MAKER, Path(DATA) / "data" / "charmm" / "toppar_water_ions.str",
                            folder], check=True, capture_output=True)
            for name in ("tip3p.str", "dimer.crd"):
                made = re.split(r"\s+", (Path(folder) / name).read_text())
                kept = re.split(r"\s+", (ROOT / "scenes" / "water" / name).read_text())
                self.assertEqual(len(made), len(kept))
                for ours, theirs in zip(made, kept):
                    try:  # the last of six decimals may round either way
                        self.assertAlmostEqual(float(ours), float(theirs), delta=2e-6)
                    except ValueError:
                        self.assertEqual(ours, theirs)

class MakeWaterSceneAgain(unittest.TestCase):
    def test_nothing_is_replaced_and_nothing_beside_it_written(self):
        with tempfile.TemporaryDirectory() as folder:
            there = Path(folder) / "dimer.crd"
            there.write_text("mine")
            result = subprocess.run([MAKER, ROOT / "scenes" / "water" / "tip3p.str", folder],
                                    capture_output=True, text=True)
            self.assertEqual(result.returncode, 2)
            self.assertIn("dimer.crd: is there already; expected another folder", result.stderr)
            self.assertNotIn("--overwrite", result.stderr)  # which it does not have
            self.assertEqual(there.read_text(), "mine")
            self.assertEqual([file.name for file in Path(folder).iterdir()], ["dimer.crd"])


if __name__ == "__main__":
    unittest.main()
