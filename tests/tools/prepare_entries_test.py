"""Entries of the PDB become what tests/data/entries.csv says: those that take a few seconds, with what comes with the program."""
import csv
import importlib.machinery
import importlib.util
import os
import tempfile
import unittest
from pathlib import Path

ROOT = Path(os.environ["PALPA_ROOT"])
DATA = os.environ.get("PALPA_DATA")
FOLDERS = ("entries", "structures", "hiv")
QUICK_S = 4


def load_script():
    loader = importlib.machinery.SourceFileLoader("prepare_entries", str(ROOT / "tools/scripts/prepare_entries"))
    module = importlib.util.module_from_spec(importlib.util.spec_from_loader(loader.name, loader))
    loader.exec_module(module)
    module.PALPA = Path(os.environ["PALPA_PROGRAM"])
    return module


@unittest.skipUnless(DATA, "PALPA_DATA names no folder with data/entries, data/structures and data/hiv")
class PrepareEntries(unittest.TestCase):
    def setUp(self):
        self.script = load_script()
        self.table = self.script.read_table(ROOT / "tests/data/entries.csv")
        self.entries = self.script.find_entries([Path(DATA) / "data" / name for name in FOLDERS])

    def test_every_structure_at_hand_is_in_the_table(self):
        self.assertEqual({entry.name for entry in self.entries}, set(self.table))
        self.assertGreaterEqual(len(self.table), 25)

    def test_each_runs_or_is_refused_for_a_residue_that_the_force_field_lacks(self):
        runs = [row for row in self.table.values() if row["outcome"] == "runs"]
        self.assertGreaterEqual(len(runs), 20)
        for row in self.table.values():
            if row["outcome"] != "runs":
                self.assertEqual(row["outcome"], "exit code 2", row)
                self.assertRegex(row["what was decided"], "no topology for residue|is a chemical component .*, not a structure")

    def test_quick_ones_are_as_the_table_says(self):
        quick = [entry for entry in self.entries if float(self.table[entry.name]["seconds"]) < QUICK_S]
        self.assertGreaterEqual(len(quick), 10)
        for entry in quick:
            with self.subTest(entry=entry.name):
                row, expected = self.script.prepare(entry, []), self.table[entry.name]
                self.assertEqual(row["outcome"], expected["outcome"])
                self.assertEqual(str(row.get("atoms", "")), expected["atoms"])
                self.assertEqual(row.get("in the hand", ""), expected["in the hand"])


class ReadTable(unittest.TestCase):
    def test_a_table_reads_as_it_was_written(self):
        script = load_script()
        rows = {name: {"entry": name, "outcome": "runs", "seconds": "1.0", "atoms": 22, "in the hand": "a, b",
                       "what was decided": 'DA, "x"; y'} for name in ("b.pdb", "A.cif")}
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / "table.csv"
            self.assertEqual(script.read_table(path), {})
            script.write_table(path, rows)
            with open(path, encoding="utf-8", newline="") as file:
                self.assertEqual([row["entry"] for row in csv.DictReader(file)], ["A.cif", "b.pdb"])
            again = script.read_table(path)
        self.assertEqual(again, {name: {**row, "atoms": "22"} for name, row in rows.items()})


if __name__ == "__main__":
    unittest.main()
