"""The inputs of scenes/hiv are what make_hiv_scene makes of the reference set."""
import os
import re
import subprocess
import tempfile
import unittest
from pathlib import Path

ROOT = Path(os.environ["PALPA_ROOT"])
MAKER = Path(os.environ["PALPA_PROGRAM"]).with_name("make_hiv_scene")
DATA = os.environ.get("PALPA_DATA")


@unittest.skipUnless(DATA, "PALPA_DATA names no folder with reference/hiv_tl3_c36m.*.json")
class MakeHivScene(unittest.TestCase):
    def test_it_makes_what_is_committed(self):
        reference = Path(DATA) / "reference"
        with tempfile.TemporaryDirectory() as folder:
            subprocess.run([MAKER, reference / "hiv_tl3_c36m.ff.json",
                            reference / "hiv_tl3_c36m.minimised_300_steps.json", folder],
                           check=True, capture_output=True)
            for name in ("system.psf", "system.crd", "system.prm"):
                made = re.split(r"\s+", (Path(folder) / name).read_text())
                kept = re.split(r"\s+", (ROOT / "scenes" / "hiv" / name).read_text())
                self.assertEqual(len(made), len(kept))
                for ours, theirs in zip(made, kept):
                    if ours != theirs:  # the last of six decimals may round either way
                        self.assertAlmostEqual(float(ours), float(theirs), delta=2e-6)


if __name__ == "__main__":
    if not DATA:
        print("SKIPPED: PALPA_DATA names no folder with reference/hiv_tl3_c36m.*.json")
    unittest.main()
