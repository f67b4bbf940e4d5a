"""tools/check_layers.py: the repository passes, and each kind of wrong arrow fails."""
import os
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

ROOT = Path(os.environ["PALPA_ROOT"])


def check(root):
    result = subprocess.run([sys.executable, ROOT / "tools" / "check_layers.py", root],
                            capture_output=True, text=True)
    return result.returncode, result.stdout


class CheckLayers(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.root = Path(self.folder.name)
        self.module("core", [])
        self.module("math", ["core"])
        self.module("haptics", ["math"])

    def tearDown(self):
        self.folder.cleanup()

    def module(self, name, depends, include=None):
        folder = self.root / "engine" / name
        folder.mkdir(parents=True, exist_ok=True)
        arrows = f"\n    DEPENDS {' '.join(depends)}" if depends else ""
        (folder / "CMakeLists.txt").write_text(f"palpa_module({name}\n    SOURCES a.cpp{arrows})\n")
        (folder / "a.h").write_text("#pragma once\n#include <vector>\n")
        line = f'#include "{include}"\n' if include else ""
        (folder / "a.cpp").write_text(f'#include "{name}/a.h"\n{line}')

    def test_the_repository_passes(self):
        code, output = check(ROOT)
        self.assertEqual(code, 0, output)
        self.assertIn("all pointing down", output)

    def test_includes_along_the_arrows_pass_directly_or_not(self):
        self.module("haptics", ["math"], "core/a.h")
        code, output = check(self.root)
        self.assertEqual(code, 0, output)

    def test_an_include_against_the_arrows_fails_with_its_line(self):
        self.module("core", [], "haptics/a.h")
        code, output = check(self.root)
        self.assertEqual(code, 1)
        self.assertIn("engine/core/a.cpp:2: 'core' may not include 'haptics'", output)

    def test_functions_that_round_otherwise_elsewhere_are_no_physics(self):
        for line, code in (("double a = std::atan2(1, 2);", 1), ("Quat a = b.slerp(c, d);", 1),
                           ("double a = std::sqrt(2);  // std::exp(1)", 0)):
            with self.subTest(line=line):
                (self.root / "engine" / "haptics" / "a.cpp").write_text('#include "haptics/a.h"\n' + line + "\n")
                self.module("math", ["core"])
                found, output = check(self.root)
                self.assertEqual(found, code, output)
                self.assertEqual("engine/haptics/a.cpp:2: " in output and "core/repeatable.h" in output, code == 1)

    def test_a_header_of_the_operating_system_is_of_platform_alone(self):
        for header in ("unistd.h", "sys/stat.h", "windows.h", "Windows.h"):
            for name, code in (("platform", 0), ("core", 1)):
                with self.subTest(header=header, module=name):
                    self.module(name, [])
                    path = self.root / "engine" / name / "a.cpp"
                    path.write_text(f"#include <{header}>\n")
                    result, output = check(self.root)
                    self.assertEqual(result, code, output)
                    if code:
                        self.assertIn(f"engine/core/a.cpp:1: <{header}> is the operating system's", output)
                    path.write_text("")

    def test_sources_of_one_system_are_listed_too(self):
        folder = self.root / "engine" / "platform"
        folder.mkdir(parents=True)
        (folder / "a.cpp").write_text("")
        (folder / "b.cpp").write_text("")
        (folder / "CMakeLists.txt").write_text("palpa_module(platform\n    POSIX a.cpp\n    WINDOWS b.cpp)\n")
        code, output = check(self.root)
        self.assertEqual(code, 0, output)

    def test_an_include_in_angle_brackets_or_after_a_comment_is_seen(self):
        for line in ("#include <haptics/a.h>", '/* why */ #include "haptics/a.h"'):
            with self.subTest(line=line):
                self.module("core", [])
                path = self.root / "engine" / "core" / "a.cpp"
                path.write_text('/* two\nlines */\n' + line + "\n")
                code, output = check(self.root)
                self.assertEqual(code, 1)
                self.assertIn("engine/core/a.cpp:3: 'core' may not include 'haptics'", output)

    def test_a_cycle_fails_and_is_spelled_out(self):
        self.module("core", ["haptics"])
        code, output = check(self.root)
        self.assertEqual(code, 1)
        self.assertIn("cycle of arrows: ", output)
        self.assertIn("core -> haptics -> math -> core", output)

    def test_an_arrow_to_no_module_fails(self):
        self.module("math", ["core", "maths"])
        code, output = check(self.root)
        self.assertEqual(code, 1)
        self.assertIn("'maths', which is no module", output)

    def test_an_include_of_no_module_fails(self):
        for include, complaint in (("physics/a.h", "no module"), ("a.h", "names no module")):
            with self.subTest(include=include):
                self.module("math", ["core"], include)
                code, output = check(self.root)
                self.assertEqual(code, 1)
                self.assertIn(complaint, output)

    def test_a_source_that_no_module_lists_fails(self):
        (self.root / "engine" / "math" / "b.cpp").write_text("")
        code, output = check(self.root)
        self.assertEqual(code, 1)
        self.assertIn("engine/math/b.cpp: not among the SOURCES", output)

    def test_a_folder_without_a_module_fails(self):
        (self.root / "engine" / "extra").mkdir()
        (self.root / "engine" / "extra" / "a.cpp").write_text("")
        code, output = check(self.root)
        self.assertEqual(code, 1)
        self.assertIn("engine/extra/a.cpp: its folder has no palpa_module", output)

    def test_the_map_of_modules_has_all_of_them_with_their_arrows_and_no_others(self):
        right = ["| core | what all stand on | |", "| math | vectors | core |",
                 "| haptics | the servo | math |"]
        for rows, complaint in ((right, None), (right[:2], "no row of the module 'haptics'"),
                                ([*right, "| field | pairs | math |"], "'field' is no module"),
                                ([*right[:2], "| haptics | the servo | core |"],
                                 "README.md:5: 'haptics' uses core; its CMakeLists.txt has math")):
            with self.subTest(complaint=complaint):
                table = ["| module | what it is for | uses |", "| --- | --- | --- |", *rows]
                (self.root / "engine" / "README.md").write_text("\n".join(table) + "\n")
                code, output = check(self.root)
                self.assertEqual(code, 1 if complaint else 0, output)
                self.assertIn(complaint or "all pointing down", output)

    def test_an_empty_tree_fails(self):
        with tempfile.TemporaryDirectory() as empty:
            self.assertEqual(check(empty)[0], 1)


if __name__ == "__main__":
    unittest.main()
