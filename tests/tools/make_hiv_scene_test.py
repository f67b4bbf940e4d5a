"""The inputs of scenes/hiv are what tools/scripts/make_hiv_scene makes with palpa prepare."""
import os
import subprocess
import tempfile
import unittest
from pathlib import Path

ROOT = Path(os.environ["PALPA_ROOT"])
DATA = os.environ.get("PALPA_DATA")


def places(path):
    lines = [line for line in path.read_text().splitlines() if not line.startswith("*")]
    return [line.split() for line in lines[1:]]


@unittest.skipUnless(DATA, "PALPA_DATA names no folder with data/hiv and data/charmm")
class MakeHivScene(unittest.TestCase):
    def test_it_makes_what_is_committed(self):
        with tempfile.TemporaryDirectory() as folder:
            subprocess.run([ROOT / "tools" / "scripts" / "make_hiv_scene", folder], check=True,
                           capture_output=True)
            for part in (".", "charged"):
                made, kept = Path(folder) / part, ROOT / "scenes" / "hiv" / part
                for name in ("system.psf", "system.prm"):
                    self.assertEqual((made / name).read_text(), (kept / name).read_text(), name)
                ours, theirs = places(made / "system.crd"), places(kept / "system.crd")
                self.assertEqual(len(ours), len(theirs))
                for a, b in zip(ours, theirs):
                    self.assertEqual(a[:4] + a[7:9], b[:4] + b[7:9])
                    # Minimising magnifies what compilers round differently.
                    for x, y in zip(a[4:7], b[4:7]):
                        self.assertAlmostEqual(float(x), float(y), delta=0.02, msg=a[:4])


if __name__ == "__main__":
    unittest.main()
