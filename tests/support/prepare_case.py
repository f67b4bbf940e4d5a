"""Shared by the tests of palpa prepare, which read structures that are not in the repository."""
import os
import tempfile
import unittest
from pathlib import Path

SHARED = os.environ.get("PALPA_DATA")


class PrepareCase(unittest.TestCase):
    """Has the data's folder, and an empty one for the results; skips where there is no data."""

    def setUp(self):
        if not SHARED:
            self.skipTest("PALPA_DATA names no folder with data/charmm and data/hiv")
        self.data = Path(SHARED) / "data"
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)

    def charmm_files(self, *names):
        return [self.data / "charmm" / name for name in names]
