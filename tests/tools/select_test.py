"""palpa select from outside: what an expression selects, and what is said of one that is wrong."""
import json
import os
import subprocess
import unittest
from pathlib import Path

PROGRAM = os.environ["PALPA_PROGRAM"]
SCENES = Path(os.environ["PALPA_ROOT"]) / "scenes"
HIV = SCENES / "hiv"


def positions():
    """Segment, residue, number, atom and place of each atom of the file of the scene."""
    rows = [line.split() for line in (HIV / "system.crd").read_text().splitlines()
            if not line.startswith("*")][1:]
    return [(row[7], row[2], row[8], row[3], tuple(map(float, row[4:7]))) for row in rows]


class Select(unittest.TestCase):
    def select(self, scene, expression, *arguments, code=0):
        result = subprocess.run([PROGRAM, "select", scene, expression, *map(str, arguments)],
                                capture_output=True, text=True, stdin=subprocess.DEVNULL)
        self.assertEqual(result.returncode, code, result.stdout + result.stderr)
        return result

    def json(self, scene, expression):
        return json.loads(self.select(scene, expression, "--json").stdout)

    def assert_bad_input(self, expression, *expected):
        stderr = self.select(HIV, expression, code=2).stderr
        self.assertEqual(len(stderr.strip().splitlines()), 1, stderr)
        for text in expected:
            self.assertIn(text, stderr)

    def test_names_select_what_the_file_has(self):
        atoms = positions()
        found = self.json(HIV, "segment A B and name CA and resid 20:30")
        expected = [row for row in atoms if row[0] in "AB" and row[3] == "CA"
                    and 20 <= int(row[2]) <= 30]
        self.assertEqual(len(expected), 22)
        self.assertEqual(found["atoms"], len(expected))
        self.assertEqual([(r["segment"], r["residue"], r["number"]) for r in found["residues"]],
                         [row[:3] for row in expected])
        self.assertEqual({r["molecule"] for r in found["residues"]}, {"protease_a", "protease_b"})
        self.assertEqual(sum(r["atoms"] for r in found["residues"]), len(found["indices"]))

    def test_kinds_share_out_all_atoms(self):
        counts = [self.json(HIV, kind)["atoms"] for kind in ("all", "protein", "ligand", "water")]
        self.assertEqual(counts[0], len(positions()))
        self.assertEqual(counts[1] + counts[2], counts[0])
        self.assertEqual(counts[3], 0)
        self.assertEqual(self.json(HIV, "ligand")["indices"],
                         self.json(HIV, "molecule inhibitor")["indices"])
        self.assertEqual(self.json(HIV, "hand")["indices"],
                         self.json(HIV, "molecule inhibitor")["indices"])

    def test_a_list_is_printed_in_lines(self):
        page = self.select(HIV, "protein").stdout
        self.assertRegex(page, r"^\d+ atoms of 198 residues\n  protease_a \(99 residues\)\n    PRO 1,")
        self.assertIn("and 39 more (--json lists all)", page)
        self.assertLessEqual(max(map(len, page.splitlines())), 100)
        self.assertEqual(self.select(HIV, "none").stdout, "0 atoms of 0 residues\n")
        self.assertEqual(self.select(SCENES / "water", "resid 1 and heavy and segment FIX").stdout,
                         "1 atom of 1 residue\n  fixed (1 residue)\n    TIP3 1\n")

    def test_what_is_wrong_is_said_with_its_column(self):
        self.assert_bad_input("protein and nmae CA", "selection, column 13: 'nmae'",
                              "did you mean 'name'?")
        self.assert_bad_input("protein and (name CA", "selection, column 21:", "expected")
        self.assert_bad_input("molecule inhibitr", "selection, column 10: no molecule 'inhibitr'",
                              "did you mean 'inhibitor'?")
        self.assertRegex(self.select(HIV, "helix").stdout, r"protease_a \(4 residues\)\n    ARG 87, ASN 88, LEU 89, LEU 90\n")
        self.assert_bad_input("", "selection, column 1:")


if __name__ == "__main__":
    unittest.main()
