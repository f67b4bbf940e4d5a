"""The inputs of scenes/hiv are what tools/scripts/make_hiv_scene makes with palpa prepare."""
import itertools
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


def farthest(ours, theirs):
    return max(abs(float(x) - float(y)) for a, b in zip(ours, theirs)
               for x, y in zip(a[4:7], b[4:7]))


def groups_of(rows):
    """Atoms that are compared together, of all rows: an ammonium's three hydrogens, else one."""
    groups = {}
    for i, row in enumerate(rows):
        is_ammonium = row[2] == "LYS" and row[3] in ("HZ1", "HZ2", "HZ3")
        groups.setdefault((row[7], row[8], row[2]) if is_ammonium else i, []).append(row)
    return groups


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
                kept_groups = groups_of(theirs)
                for key, group in groups_of(ours).items():
                    # The scene was made when side chains were turned over after their hydrogens
                    # were built, not before: ammonium came to its place on another way, with its
                    # three hydrogens, which are alike, in another order.
                    off = min(farthest(group, order)
                              for order in itertools.permutations(kept_groups[key]))
                    # Minimising magnifies what is rounded differently, and stops where the rms
                    # force is below 0.1 kcal/mol/Å, not at the minimum.
                    self.assertLess(off, 0.04, group)
            for name in ("solvent.psf", "solvent.prm"):
                self.assertEqual((Path(folder) / name).read_text(),
                                 (ROOT / "scenes" / "hiv" / name).read_text(), name)


class NeutralCharges(unittest.TestCase):
    def test_only_ionic_groups_differ_from_vacuum_and_all_of_them_are_neutral(self):
        def atoms(name):
            lines = (ROOT / "scenes" / "hiv" / name).read_text().splitlines()
            first = next(i for i, line in enumerate(lines) if line.endswith("!NATOM"))
            count = int(lines[first].split()[0])
            return [line.split() for line in lines[first + 1:first + 1 + count]]

        vacuum, water = atoms("system.psf"), atoms("solvent.psf")
        self.assertEqual(len(vacuum), len(water))
        sums, changed = {}, set()
        for a, b in zip(vacuum, water):
            self.assertEqual(a[:5], b[:5])
            residue = tuple(b[1:4])
            sums[residue] = sums.get(residue, 0) + float(b[6])
            if a[6] != b[6]:
                changed.add(residue)
            if a[5] != b[5]:
                self.assertEqual((a[3], a[4], a[5], b[5]), ("ASP", "CB", "CT2A", "CT2"))
        for residue, charge in sums.items():
            self.assertAlmostEqual(charge, 0, delta=1e-6, msg=residue)
        ends = {(chain, number, name) for chain in "AB" for number, name in (("1", "PRO"), ("99", "PHE"))}
        for residue in changed - ends:
            self.assertIn(residue[2], ("ARG", "LYS", "ASP", "GLU"))
        self.assertTrue(ends <= changed)
        self.assertNotIn(("B", "25", "ASP"), changed)  # has a proton


if __name__ == "__main__":
    unittest.main()
