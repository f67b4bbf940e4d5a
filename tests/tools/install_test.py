"""cmake --install and the archive of cpack: what is where, and that the program runs from there."""
import os
import re
import shutil
import subprocess
import tempfile
import unittest
from pathlib import Path

PROGRAM = Path(os.environ["PALPA_PROGRAM"])
ROOT = Path(os.environ["PALPA_ROOT"])
BUILD = PROGRAM.parent.parent


def run(*command, **options):
    return subprocess.run([str(word) for word in command], capture_output=True, text=True,
                          stdin=subprocess.DEVNULL, **options)


def commands():
    """Those of the program's help."""
    return re.findall(r"^ {4}([a-z-]+) +[A-Z]", run(PROGRAM, "help").stdout, re.M)


class Install(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(cls.folder.cleanup)
        cls.tmp = Path(cls.folder.name)
        cls.prefix = cls.tmp / "prefix"
        result = run("cmake", "--install", BUILD, "--prefix", cls.prefix)
        assert result.returncode == 0, result.stdout + result.stderr

    def play(self, program, name):
        """Plays the water scene by its name, from a folder of its own, and returns the trace."""
        here = self.tmp / name
        here.mkdir()
        result = run(program, "run", "water", "--headless", "--seconds", "0.5", "--record", "out",
                     cwd=here)
        self.assertEqual(result.returncode, 0, result.stderr)
        return (here / "out" / "trace.csv").read_bytes()

    def test_what_is_installed_plays_a_scene_by_name_as_the_build_does(self):
        self.assertEqual(self.play(self.prefix / "bin" / "palpa", "installed"),
                         self.play(PROGRAM, "built"))
        listed = run(self.prefix / "bin" / "palpa", cwd=self.tmp,
                     env={**os.environ, "DISPLAY": "", "WAYLAND_DISPLAY": "", "HOME": str(self.tmp)})
        self.assertIn("hiv/flexible", listed.stdout)
        # Its own force field and scenes, not those of the build.
        shown = run(self.prefix / "bin" / "palpa", "licences", cwd=self.tmp)
        self.assertIn(str(self.prefix / "share" / "palpa" / "force-field" / "charmm36.ff"), shown.stdout)
        # As examples in help and pages have them, in the source tree.
        for path in ("scenes/water", "scenes/hiv/flexible.toml"):
            self.assertEqual(run(self.prefix / "bin" / "palpa", "select", path, "all", cwd=self.tmp).returncode, 0)
        asked = run(self.prefix / "bin" / "palpa", "run", "wter", "--check", cwd=self.tmp)
        self.assertIn("did you mean 'water'", asked.stderr)
        (self.prefix / "share" / "palpa" / "scenes" / "water").rename(
            self.prefix / "share" / "palpa" / "scenes" / "wet")
        try:
            self.assertEqual(run(self.prefix / "bin" / "palpa", "run", "wet", "--check",
                                 cwd=self.tmp).returncode, 0)
            self.assertEqual(run(self.prefix / "bin" / "palpa", "run", "water", "--check",
                                 cwd=self.tmp).returncode, 2)
        finally:
            (self.prefix / "share" / "palpa" / "scenes" / "wet").rename(
                self.prefix / "share" / "palpa" / "scenes" / "water")

    def test_an_archive_runs_wherever_it_is_unpacked_and_moved(self):
        result = run("cpack", "-G", "TGZ", "-B", self.tmp / "packed", cwd=BUILD)
        self.assertEqual(result.returncode, 0, result.stdout + result.stderr)
        archive, = (self.tmp / "packed").glob("*.tar.gz")
        shutil.unpack_archive(archive, self.tmp / "unpacked")
        unpacked, = (self.tmp / "unpacked").iterdir()
        moved = self.tmp / "some where else"
        unpacked.rename(moved)
        self.assertEqual(self.play(moved / "bin" / "palpa", "moved"), self.play(PROGRAM, "as-built"))

    def test_files_are_where_distributions_want_them(self):
        for name in ("bin/palpa", "share/palpa/scenes/hiv/system.psf",
                     "share/palpa/scenes/hairpin/scene.toml", "share/palpa/scenes/peptide/system.psf", "share/man/man1/palpa.1",
                     "share/bash-completion/completions/palpa", "lib/udev/rules.d/70-palpa.rules",
                     "share/doc/palpa/LICENSE", "share/palpa/force-field/charmm36.ff",
                     "share/palpa/force-field/charmm36.txt"):
            with self.subTest(name=name):
                self.assertTrue((self.prefix / name).is_file())
        catalogue = "locale/de/LC_MESSAGES/palpa.mo"
        self.assertEqual((self.prefix / "share/palpa" / catalogue).is_file(), (BUILD / catalogue).is_file())
        self.assertEqual((self.prefix / "lib/udev/rules.d/70-palpa.rules").read_bytes(),
                         (ROOT / "devices" / "udev" / "70-palpa.rules").read_bytes())
        # Where a device needs them, their own place is named.
        asked = run(self.prefix / "bin/palpa", "devices", "force-dimension", cwd=self.tmp,
                    env={**os.environ, "PALPA_DHD_STUB": "absent"})
        self.assertIn(f"sudo cp {self.prefix}/lib/udev/rules.d/70-palpa.rules ", " ".join(asked.stdout.split()))
        # Scenes whose molecules are made in the source tree stay there.
        self.assertFalse((self.prefix / "share/palpa/scenes/groel").exists())

    def test_the_manual_page_explains_every_command(self):
        page = self.prefix / "share" / "man" / "man1" / "palpa.1"
        text = page.read_text()
        self.assertEqual(text.splitlines()[0].split()[:3], [".TH", "PALPA", "1"])
        self.assertLessEqual({"run", "prepare", "connect", "licences"}, set(commands()))
        for command in commands():
            self.assertIn(f".SH PALPA {command.upper()}\n", text)
        if shutil.which("man"):
            shown = run("man", "--warnings", "-l", page, env={**os.environ, "MANWIDTH": "100",
                                                              "LC_ALL": "C.UTF-8", "PAGER": "cat"})
        elif shutil.which("mandoc"):
            shown = run("mandoc", "-T", "utf8", page)
        else:
            return
        self.assertEqual(shown.returncode, 0)
        self.assertEqual(shown.stderr, "")
        for words in ("PALPA RUN", "--headless", "Coulomb friction of the emulated device"):
            self.assertIn(words, shown.stdout)

    def complete(self, *words):
        script = ('source "$1"; shift; COMP_WORDS=("$@"); COMP_CWORD=$(($# - 1)); _palpa; '
                  'printf "%s\\n" "${COMPREPLY[@]}"')
        result = run("bash", "-c", script, "bash",
                     self.prefix / "share" / "bash-completion" / "completions" / "palpa", *words)
        self.assertEqual(result.stderr, "")
        return result.stdout.split()

    def test_bash_completes_commands_and_options(self):
        self.assertEqual(set(self.complete("palpa", "")),
                         {*commands(), "help", "--help", "--version"})
        self.assertEqual(self.complete("palpa", "re"), ["relax", "render", "replay"])
        self.assertEqual(self.complete("palpa", "help", "dev"), ["devices"])
        self.assertEqual(self.complete("palpa", "run", "water", "--he"), ["--help", "--headless"])
        self.assertEqual(self.complete("palpa", "render", "--rep"), ["--representation"])
        self.assertEqual(self.complete("palpa", "run", "wat"), [])  # a file: readline's


if __name__ == "__main__":
    unittest.main()
