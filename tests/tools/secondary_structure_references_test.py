"""tests/data/secondary_structure is what make_secondary_structure_references makes with the program DSSP."""
import filecmp
import os
import shutil
import subprocess
import tempfile
import unittest
from pathlib import Path

ROOT = Path(os.environ["PALPA_ROOT"])
MAKER = ROOT / "tools" / "scripts" / "make_secondary_structure_references"
DATA = os.environ.get("PALPA_DATA")


@unittest.skipUnless(DATA, "PALPA_DATA names no folder with data/structures, data/entries, data/hiv")
@unittest.skipUnless(shutil.which("mkdssp"), "mkdssp is not installed")
class SecondaryStructureReferences(unittest.TestCase):
    def test_they_are_made_again_as_committed(self):
        kept = ROOT / "tests" / "data" / "secondary_structure"
        with tempfile.TemporaryDirectory() as folder:
            result = subprocess.run([MAKER, Path(DATA) / "data", folder], capture_output=True, text=True)
            self.assertEqual(result.returncode, 0, result.stderr)
            names = sorted(path.name for path in kept.iterdir())
            self.assertEqual(len(names), 10)
            same, *others = filecmp.cmpfiles(kept, folder, names, shallow=False)
            self.assertEqual((same, others), (names, [[], []]))
