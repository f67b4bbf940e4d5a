"""The inputs of scenes/salt-bridge are what tools/scripts/make_salt_bridge_scene makes."""
import os
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

sys.path.append(str(Path(__file__).resolve().parents[1] / "support"))
from made_scenes import assert_explains_itself, assert_same_atoms, places  # noqa: E402

ROOT = Path(os.environ["PALPA_ROOT"])
DATA = os.environ.get("PALPA_DATA")
SCRIPT = ROOT / "tools" / "scripts" / "make_salt_bridge_scene"
SCENE = ROOT / "scenes" / "salt-bridge"


class MakeSaltBridgeScene(unittest.TestCase):
    @unittest.skipUnless(DATA, "PALPA_DATA names no folder with data/structures and data/charmm")
    def test_it_makes_what_is_committed(self):
        with tempfile.TemporaryDirectory() as folder:
            subprocess.run([SCRIPT, folder], check=True, capture_output=True)
            for name in ("vacuum.psf", "solvent.psf", "system.prm", "solvent.prm"):
                self.assertEqual((Path(folder) / name).read_text(), (SCENE / name).read_text(), name)
            assert_same_atoms(self, Path(folder) / "system.crd", SCENE / "system.crd", 0.02)

    def test_the_charged_groups_face_each_other_4_angstrom_apart(self):
        atoms = {(row[7], row[3]): [float(x) for x in row[4:7]] for row in places(SCENE / "system.crd")}
        for value, expected in zip(atoms["A", "CG"] + atoms["B", "NZ"], [0, 0, 0, 4, 0, 0]):
            self.assertAlmostEqual(value, expected, delta=2e-3)
        self.assertLess(atoms["A", "CB"][0], -1)
        self.assertGreater(atoms["A", "OD1"][0], 0.3)
        self.assertGreater(atoms["B", "CE"][0], 5)

    def test_it_explains_itself_and_says_what_is_missing(self):
        assert_explains_itself(self, SCRIPT)


if __name__ == "__main__":
    unittest.main()
