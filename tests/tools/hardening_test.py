"""The program's file is hardened: position-independent, no writable jump tables, checked stacks and buffers."""
import json
import os
import re
import shutil
import subprocess
import tempfile
import unittest
from pathlib import Path

PROGRAM = Path(os.environ["PALPA_PROGRAM"])
BUILD = PROGRAM.parent.parent


def readelf(*arguments):
    return subprocess.run(["readelf", "-W", *map(str, arguments)], capture_output=True, text=True, check=True).stdout


@unittest.skipUnless(shutil.which("readelf"), "readelf is not installed")
class Hardening(unittest.TestCase):
    def test_it_is_position_independent(self):
        # Else its addresses are the same in every run. A library would be DYN too: the flag tells them apart.
        self.assertRegex(readelf("-h", PROGRAM), r"Type:\s+DYN")
        self.assertRegex(readelf("-d", PROGRAM), r"\(FLAGS_1\).*\bPIE\b")

    def test_what_is_relocated_is_read_only_before_main(self):
        self.assertIn("GNU_RELRO", readelf("-l", PROGRAM))
        # All of it: the loader resolves every function at the start.
        self.assertRegex(readelf("-d", PROGRAM), r"\(FLAGS_1\).*\bNOW\b|\(BIND_NOW\)|\(FLAGS\).*\bBIND_NOW\b")

    def test_the_stack_is_not_executable(self):
        self.assertRegex(readelf("-l", PROGRAM), r"GNU_STACK .* RW +0")

    def test_stacks_and_buffers_are_checked_in_a_release(self):
        kind = re.search(r"^CMAKE_BUILD_TYPE:\w+=(\w*)", (BUILD / "CMakeCache.txt").read_text(), re.M)[1]
        if kind != "Release":  # others are for finding mistakes, with checks of their own
            return
        self.assertRegex(readelf("--dyn-syms", PROGRAM), r"UND __stack_chk_fail\b")
        # A compiler that proves all buffers large enough leaves no symbol: the commands say.
        commands = json.loads((BUILD / "compile_commands.json").read_text())
        own = [entry["command"] for entry in commands if "/engine/" in entry["file"]]
        self.assertGreater(len(own), 20)
        for command in own:
            self.assertIn("-D_FORTIFY_SOURCE=2", command)
            self.assertIn("-fstack-protector-strong", command)

    def test_no_path_of_libraries_is_built_in(self):
        with tempfile.TemporaryDirectory() as folder:
            subprocess.run(["cmake", "--install", BUILD, "--prefix", folder], capture_output=True, check=True)
            self.assertNotRegex(readelf("-d", Path(folder) / "bin" / "palpa"), r"\((RPATH|RUNPATH)\)")
        # The archive's program has one: tools/packaging.md, package_test.py.


if __name__ == "__main__":
    unittest.main()
