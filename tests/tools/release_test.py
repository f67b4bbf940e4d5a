"""tools/scripts/release: its notes, what it refuses, and that it goes on where it was stopped. Nothing is built
here: scripts that write a word take the place of those that pack and try."""
import hashlib
import importlib.machinery
import importlib.util
import json
import os
import shutil
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

ROOT = Path(os.environ["PALPA_ROOT"])
TOOL_FILE = ROOT / "tools" / "scripts" / "release"


def load_tool():
    sys.dont_write_bytecode = True
    loader = importlib.machinery.SourceFileLoader("release", str(TOOL_FILE))
    module = importlib.util.module_from_spec(importlib.util.spec_from_loader(loader.name, loader))
    loader.exec_module(module)
    return module


TOOL = load_tool()
OWN = """# Release notes

## 1.2.0

- A [page](../tools/page.md) and [the web](https://example.org).

## Scenes

- A key.

## 1.1.0

- Old.
"""
NEXT = OWN.replace("\n## 1.2.0", "\n## Next\n\n- Not yet.\n\n## 1.2.0")

# Each notes its name in `calls`; the trials do what `OUTCOME` says.
STAND_INS = {
    "package": "echo deb >$1/palpa_1.2.0_amd64.deb; echo archive >$1/palpa-1.2.0-linux-x86_64.tar.xz",
    "package_windows": "echo zip >$1/palpa-1.2.0-windows-x86_64.zip",
    "try_packages": "echo 'ok      it runs'; eval \"${OUTCOME:-}\"",
    "try_windows": "test -s \"$1\"",
}
# A hook of git may run this: its variables would lead back to the repository.
ENVIRONMENT = {name: value for name, value in os.environ.items() if not name.startswith("GIT_")}
FILES = ["palpa-1.2.0-linux-x86_64.tar.xz", "palpa-1.2.0-windows-x86_64.zip", "palpa_1.2.0_amd64.deb"]


class Changes(unittest.TestCase):
    def test_the_notes_are_the_section_of_the_version(self):
        text, is_preview = TOOL.choose_changes(OWN, "1.2.0", preview=False)
        self.assertEqual(text, "- A page and [the web](https://example.org).\n\n## Scenes\n\n- A key.")
        self.assertFalse(is_preview)

    def test_changes_without_a_version_are_a_preview_alone(self):
        with self.assertRaisesRegex(TOOL.Refusal, 'begins with "Next"; expected "## 1.2.0".*or --preview'):
            TOOL.choose_changes(NEXT, "1.2.0", preview=False)
        text, is_preview = TOOL.choose_changes(NEXT, "1.2.0", preview=True)
        self.assertEqual((text, is_preview), ("- Not yet.", True))
        notes = TOOL.write_notes("1.2.0", "abc", text, is_preview, has_windows=False)
        self.assertIn("This is no release", notes)
        self.assertIn("Windows: no program in this release", notes)

    def test_a_section_of_another_version_and_an_empty_one_are_refused(self):
        for changelog, version, said in ((OWN, "1.3.0", 'expected "## 1.3.0"'), ("# Release notes\n", "1.2.0", "no section"),
                                         ("## 1.2.0\n\n## 1.1.0\n\n- Old.\n", "1.2.0", "nothing under")):
            with self.subTest(version=version), self.assertRaisesRegex(TOOL.Refusal, said):
                TOOL.choose_changes(changelog, version, preview=True)

    def test_the_changelog_of_this_tree_can_be_read(self):
        version = TOOL.read_version(ROOT)
        text, _ = TOOL.choose_changes((ROOT / "engine/CHANGELOG.md").read_text(), version, preview=True)
        self.assertIn("\n- ", "\n" + text)


class Release(unittest.TestCase):
    """The script in a small repository of its own."""

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.root, self.out = Path(folder.name) / "tree", Path(folder.name) / "out"
        self.calls = Path(folder.name) / "calls"
        scripts = self.root / "tools" / "scripts"
        scripts.mkdir(parents=True)
        (self.root / "engine").mkdir()
        (self.root / "engine" / "CHANGELOG.md").write_text(OWN)
        (self.root / "CMakeLists.txt").write_text("project(palpa VERSION 1.2.0 LANGUAGES CXX)\n")
        (self.root / "vcpkg.json").write_text('{"version": "1.2.0"}\n')
        shutil.copy(TOOL_FILE, scripts)
        for name, body in STAND_INS.items():
            (scripts / name).write_text(f"#!/bin/sh\necho {name} >>\"$CALLS\"\n{body}\n")
            (scripts / name).chmod(0o755)
        self.git("init", "-q")
        self.commit()

    def git(self, *arguments):
        subprocess.run(["git", "-C", self.root, "-c", "user.name=a", "-c", "user.email=a@example.org", *arguments],
                       check=True, capture_output=True, env=ENVIRONMENT)

    def commit(self):
        self.git("add", "-A")
        self.git("-c", "commit.gpgsign=false", "commit", "-q", "-m", "a", "--no-verify")

    def release(self, *options, outcome=""):
        """Exit code, what was printed, and the scripts that were called."""
        self.calls.write_text("")
        result = subprocess.run([sys.executable, self.root / "tools/scripts/release", *(options or [self.out])], text=True,
                                capture_output=True, env={**ENVIRONMENT, "CALLS": str(self.calls), "OUTCOME": outcome})
        return result.returncode, result.stdout + result.stderr, self.calls.read_text().split()

    def refused(self, said, *options):
        code, output, calls = self.release(*options)
        self.assertEqual((code, calls), (2, []), output)
        self.assertRegex(output, said)
        self.assertEqual(output.count("\n"), 1, output)

    def test_everything_is_made_tried_and_summed_up(self):
        code, output, calls = self.release()
        self.assertEqual(code, 0, output)
        self.assertEqual(calls, ["package", "try_packages", "package_windows", "try_windows"])
        for name in FILES:
            self.assertRegex(output, rf"(?m)^{name} +0\.0 MB +try_\w+ +works$")
        sums = [line.split("  ") for line in (self.out / "SHA256SUMS").read_text().splitlines()]
        self.assertEqual([name for _, name in sums], sorted([*FILES, "notes.md"]))
        for digest, name in sums:
            self.assertEqual(digest, hashlib.sha256((self.out / name).read_bytes()).hexdigest())
        notes = (self.out / "notes.md").read_text()
        self.assertTrue(notes.startswith("# Palpa 1.2.0\n\n- A page"), notes)
        for name in FILES:
            self.assertIn(name, notes)
        self.assertEqual((self.out / "tried" / "try_packages.log").read_text(), "ok      it runs\n")
        self.assertEqual(self.release()[2], [])  # nothing is left to do

    def test_what_failed_is_tried_again_and_nothing_else_is_done_twice(self):
        code, output, _ = self.release(outcome="echo 'FAILED  a window'; exit 1")
        self.assertEqual(code, 1)
        self.assertRegex(output, r"amd64\.deb +0\.0 MB +try_packages +FAILED: a window\n")
        self.assertRegex(output, r"windows-x86_64\.zip +0\.0 MB +try_windows +works\n")
        self.assertFalse((self.out / "SHA256SUMS").exists())
        code, output, calls = self.release()
        self.assertEqual((code, calls), (0, ["try_packages"]), output)
        (self.out / FILES[1]).write_text("another")
        self.assertEqual(self.release()[2], ["package_windows"])  # the same zip again, which is known to work

    def test_a_trial_that_left_something_out_is_no_success(self):
        code, output, _ = self.release(outcome="echo 'SKIPPED: new systems need root'")
        self.assertEqual(code, 1)
        self.assertIn("not all was tried: new systems need root", output)
        self.assertFalse((self.out / "SHA256SUMS").exists())

    def test_a_script_that_makes_nothing_stops_only_its_own_files(self):
        (self.root / "tools/scripts/package_windows").write_text("#!/bin/sh\nexit 3\n")
        self.commit()
        code, output, calls = self.release()
        self.assertEqual((code, calls), (1, ["package", "try_packages"]))
        self.assertIn("FAILED: not made, exit code 3", output)
        code, output, _ = self.release(self.out, "--without-windows")
        self.assertEqual(code, 0, output)
        self.assertNotIn("windows", (self.out / "SHA256SUMS").read_text())
        self.assertIn("Windows: no program in this release", (self.out / "notes.md").read_text())

    def test_what_is_no_release_is_refused_before_anything_is_made(self):
        self.refused("expected: tools/scripts/release OUT", "--what")
        self.refused("expected: tools/scripts/release OUT", self.out, self.out)
        self.refused("has something else; expected a new or an empty folder", self.root)
        (self.root / "new.txt").write_text("")
        self.refused("1 files of .* are not committed, such as new.txt", self.out)
        (self.root / "new.txt").unlink()
        for name, text, said in (("CMakeLists.txt", "project(palpa)\n", "CMakeLists.txt has no version"),
                                 ("vcpkg.json", json.dumps({"version": "1.1.0"}), "vcpkg.json has version 1.1.0; expected 1.2.0"),
                                 ("engine/CHANGELOG.md", NEXT, 'begins with "Next"')):
            with self.subTest(file=name):
                before = (self.root / name).read_text()
                (self.root / name).write_text(text)
                self.commit()
                self.refused(said, self.out)
                (self.root / name).write_text(before)
        self.assertFalse(self.out.exists())

    def test_files_of_another_commit_are_left_alone(self):
        self.assertEqual(self.release()[0], 0)
        before = (self.out / "SHA256SUMS").read_text()
        (self.root / "more.txt").write_text("")
        self.commit()
        self.refused("has files of commit", self.out)
        self.assertEqual((self.out / "SHA256SUMS").read_text(), before)


if __name__ == "__main__":
    unittest.main()
