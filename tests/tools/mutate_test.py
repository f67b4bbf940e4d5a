"""tools/scripts/mutate: which changes it finds, that their names last, and what it makes of results. Nothing is
built here."""
import contextlib
import importlib.machinery
import importlib.util
import io
import os
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

ROOT = Path(os.environ["PALPA_ROOT"])


def load_tool():
    sys.dont_write_bytecode = True
    loader = importlib.machinery.SourceFileLoader("mutate", str(ROOT / "tools" / "scripts" / "mutate"))
    module = importlib.util.module_from_spec(importlib.util.spec_from_loader(loader.name, loader))
    loader.exec_module(module)
    return module


TOOL = load_tool()


def lines_of(text, path="engine/math/a.cpp"):
    """The line that each mutant of a text makes, after the line that it was."""
    changed = {}
    for mutant in TOOL.find_mutants(path, text):
        after = TOOL.mutated(mutant, text).splitlines()
        before = text.splitlines()
        different = [i for i in range(len(before)) if before[i] != after[i]]
        assert different == [mutant.line - 1], (mutant, different)
        changed.setdefault(before[mutant.line - 1], []).append(after[mutant.line - 1])
    return changed


class Changes(unittest.TestCase):
    def check(self, line, *expected):
        self.assertEqual(sorted(lines_of(line + "\n").get(line, [])), sorted(expected))

    def test_arithmetic_and_comparisons_are_changed(self):
        self.check("a = b + c * 2;", "a = b - c * 2;", "a = b + c / 2;")
        self.check("a -= b / c;", "a += b / c;", "a -= b * c;")
        self.check("if (a < b) return;", "if (a <= b) return;", "if (a >= b) return;")
        self.check("if (a != b) return;", "if (a == b) return;")
        self.check("return -x;", "return x;")
        self.check("f(-x, -(y));", "f(x, -(y));", "f(-x, (y));")
        self.check("x = std::min(a, b);", "x = std::max(a, b);")
        self.check("x = hn::Mul(a, b);", "x = hn::Add(a, b);")
        self.check("    a +", "    a -")  # goes on in the next line

    def test_what_is_no_such_operator_stays(self):
        for line in ("std::vector<int> a;", "template <class T>", "const T& f(T* a, T&& b) noexcept;",
                     "++i;", "p->x();", "// a + b < c", "/* a + b */ x();", "#include <a + b>", 'f("a + b");',
                     "PALPA_ASSERT(a < (b + c));", "static_assert(a == b);", "a <<= 1;",
                     "auto order = a <=> b;"):
            with self.subTest(line=line):
                self.check(line)

    def test_code_behind_an_assertion_on_its_line_is_still_code(self):
        self.check("PALPA_ASSERT(a < b); c = a + b;", "PALPA_ASSERT(a < b); c = a - b;")

    def test_names_last_where_other_lines_change_and_differ_where_lines_are_alike(self):
        text = "a = b + c;\nd = e;\na = b + c;\n"
        before = [mutant.id for mutant in TOOL.find_mutants("engine/math/a.cpp", text)]
        after = [mutant.id for mutant in TOOL.find_mutants("engine/math/a.cpp", "\n  x();\n  " + text)]
        self.assertEqual(len(set(before)), 2)
        self.assertEqual(before, after)
        self.assertNotEqual(before, [m.id for m in TOOL.find_mutants("engine/math/b.cpp", text)])

    def test_the_order_is_that_of_the_seed(self):
        ids = [[mutant.id for mutant in TOOL.draw(ROOT, ["math", "ecs"], seed)] for seed in (1, 1, 2)]
        self.assertEqual(ids[0], ids[1])
        self.assertNotEqual(ids[0], ids[2])
        self.assertEqual(sorted(ids[0]), sorted(ids[2]))
        self.assertEqual(len(set(ids[0])), len(ids[0]))


class Results(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)

    def test_the_last_line_of_a_mutant_counts(self):
        path = self.folder / "results.tsv"
        row = dict.fromkeys(TOOL.FIELDS, "")
        for verdict in ("survived", "failed"):
            TOOL.add_result(path, {**row, "id": "12345678", "verdict": verdict})
        self.assertEqual(TOOL.read_results(path)["12345678"]["verdict"], "failed")

    def test_the_share_leaves_out_what_is_equivalent(self):
        rows = [{"id": name, "verdict": verdict, "file": "engine/math/a.h", "line": "3", "change": "+ -> -"}
                for name, verdict in (("a", "failed"), ("b", "crashed"), ("c", "timed-out"),
                                      ("d", "survived"), ("e", "survived"), ("f", "not-compiled"))]
        notes = {"d": ("equivalent", "the sum is the same"), "e": ("stays", "too rare")}
        self.assertEqual(TOOL.share(rows, notes), (3, 4))
        with contextlib.redirect_stdout(io.StringIO()) as out:
            self.assertFalse(TOOL.write_summary(rows, notes, [], self.folder / "README.md"))
            notes["e"] = ("equivalent", "it is, after all")
            self.assertTrue(TOOL.write_summary(rows, notes, [], self.folder / "README.md"))
        self.assertIn("5 mutants, 1 equivalent, 3 of 4 others caught (75.0 %)", out.getvalue())
        self.assertIn("the sum is the same", (self.folder / "README.md").read_text())

    def test_notes_are_read_with_their_reasons(self):
        path = self.folder / "notes.txt"
        path.write_text("# about\n\n12345678 equivalent\n    the sum\n    is the same\n9abcdef0 stays\n    rare\n")
        self.assertEqual(TOOL.read_notes(path), {"12345678": ("equivalent", "the sum is the same"),
                                                 "9abcdef0": ("stays", "rare")})
        for bad in ("12345678 maybe\n", "    a reason of nothing\n"):
            path.write_text(bad)
            with self.assertRaises(SystemExit) as error:
                TOOL.read_notes(path)
            self.assertIn("notes.txt:1:", str(error.exception))

    def test_every_note_in_the_repository_is_of_a_mutant_with_a_result(self):
        folder = ROOT / "tests" / "mutations"
        notes, results = TOOL.read_notes(folder / "notes.txt"), TOOL.read_results(folder / "results.tsv")
        self.assertEqual(set(notes) - set(results), set())
        for name, (_, reason) in notes.items():
            self.assertTrue(reason, name)


class CommandLine(unittest.TestCase):
    def test_a_change_is_shown_and_an_unknown_module_is_refused(self):
        mutant = TOOL.draw(ROOT, ["math"], 1)[0]
        shown = subprocess.run([ROOT / "tools" / "scripts" / "mutate", "--show", mutant.id], capture_output=True, text=True)
        self.assertEqual(shown.returncode, 0, shown.stderr)
        self.assertIn(f"{mutant.id} {mutant.path}:{mutant.line}", shown.stdout)
        self.assertEqual(sum(line.startswith("+") for line in shown.stdout.splitlines()), 1)
        refused = subprocess.run([ROOT / "tools" / "scripts" / "mutate", "--modules", "render"], capture_output=True, text=True)
        self.assertEqual(refused.returncode, 2)
        self.assertIn("unknown module 'render'", refused.stderr)


if __name__ == "__main__":
    unittest.main()
