"""The inputs of scenes/salt-bridge are what tools/scripts/make_salt_bridge_scene makes."""
import os
import subprocess
import tempfile
import unittest
from pathlib import Path

ROOT = Path(os.environ["PALPA_ROOT"])
DATA = os.environ.get("PALPA_DATA")
SCRIPT = ROOT / "tools" / "scripts" / "make_salt_bridge_scene"
SCENE = ROOT / "scenes" / "salt-bridge"


def places(path):
    lines = [line for line in path.read_text().splitlines() if not line.startswith("*")]
    return [line.split() for line in lines[1:]]


class MakeSaltBridgeScene(unittest.TestCase):
    @unittest.skipUnless(DATA, "PALPA_DATA names no folder with data/structures and data/charmm")
    def test_it_makes_what_is_committed(self):
        with tempfile.TemporaryDirectory() as folder:
            subprocess.run([SCRIPT, folder], check=True, capture_output=True)
            for name in ("vacuum.psf", "solvent.psf", "system.prm", "solvent.prm"):
                self.assertEqual((Path(folder) / name).read_text(), (SCENE / name).read_text(), name)
            for a, b in zip(places(Path(folder) / "system.crd"), places(SCENE / "system.crd"), strict=True):
                self.assertEqual(a[:4] + a[7:9], b[:4] + b[7:9])
                for x, y in zip(a[4:7], b[4:7]):
                    self.assertAlmostEqual(float(x), float(y), delta=0.02, msg=a[:4])

    def test_the_charged_groups_face_each_other_4_angstrom_apart(self):
        atoms = {(row[7], row[3]): [float(x) for x in row[4:7]] for row in places(SCENE / "system.crd")}
        for value, expected in zip(atoms["A", "CG"] + atoms["B", "NZ"], [0, 0, 0, 4, 0, 0]):
            self.assertAlmostEqual(value, expected, delta=2e-3)
        self.assertLess(atoms["A", "CB"][0], -1)
        self.assertGreater(atoms["A", "OD1"][0], 0.3)
        self.assertGreater(atoms["B", "CE"][0], 5)

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
