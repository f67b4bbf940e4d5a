"""The shell tools and the documentation: help, usage, the figure, the list of keys."""
import os
import re
import struct
import subprocess
import tempfile
import unittest
from pathlib import Path

PROGRAM = os.environ["PALPA_PROGRAM"]
ROOT = Path(os.environ["PALPA_ROOT"])


def run(*command, **options):
    return subprocess.run([str(word) for word in command], capture_output=True, text=True,
                          stdin=subprocess.DEVNULL, **options)


class Scripts(unittest.TestCase):
    def test_every_tool_explains_itself(self):
        for name in ("build", "run", "test", "scripts/plot_stroke", "lab/scripts/play_ways_out",
                     "scripts/prepare_entries", "scripts/make_secondary_structure_references",
                     "scripts/check_style", "scripts/package", "scripts/try_packages", "scripts/release",
                     "scripts/check_windows", "scripts/package_windows", "scripts/try_windows", "windows/build",
                     "windows/libraries", "scripts/make_manual", "scripts/check_skips",
                     "lab/scripts/compare_peers", "scripts/fingerprints",
                     "lab/scripts/compare_tl3", "lab/scripts/csv_table", "scripts/docs_stats", "scripts/mutate",
                     "lab/scripts/plot_adaptive", "lab/scripts/run_table", "lab/scripts/soak", "lab/scripts/wake_up",
                     "lab/scripts/plot_scenarios", "lab/scripts/stroke_table", "scripts/update_results",
                     "lab/scripts/plot_study", "scripts/update_translations"):
            with self.subTest(tool=name):
                result = run(ROOT / "tools" / name, "--help")
                self.assertEqual(result.returncode, 0)
                self.assertTrue(result.stdout.strip())

    def test_the_figure_is_drawn_from_a_recording(self):
        with tempfile.TemporaryDirectory() as folder:
            recording, image = Path(folder) / "recording", Path(folder) / "stroke.png"
            self.assertEqual(run(PROGRAM, "run", ROOT / "scenes" / "water", "--headless",
                                 "--record", recording).returncode, 0)
            result = run(ROOT / "tools" / "scripts" / "plot_stroke", recording, image)
            self.assertEqual(result.returncode, 0, result.stderr)
            data = image.read_bytes()
            self.assertEqual(data[:8], b"\x89PNG\r\n\x1a\n")
            self.assertEqual(struct.unpack(">II", data[16:24]), (1200, 480))
            self.assertEqual(run(ROOT / "tools" / "scripts" / "plot_stroke", folder, image).returncode, 2)

    def test_pages_link_to_what_is_there(self):
        for readme in ROOT.glob("**/*.md"):
            if "build" in readme.relative_to(ROOT).parts:
                continue
            for target in re.findall(r"\]\(([^)#]+)\)", readme.read_text()):
                if not target.startswith("http"):
                    with self.subTest(readme=str(readme), target=target):
                        self.assertTrue((readme.parent / target).exists())

    def test_every_folder_of_the_top_level_has_a_readme(self):
        for folder in ("engine", "shaders", "scenes", "devices", "tools", "tests"):
            self.assertTrue((ROOT / folder / "README.md").is_file(), folder)

    def test_vcpkg_lists_the_libraries_we_build_with(self):
        vcpkg = (ROOT / "vcpkg.json").read_text()
        found = set()
        for file in [ROOT / "CMakeLists.txt", *(ROOT / "engine").rglob("CMakeLists.txt"),
                     ROOT / "devices" / "CMakeLists.txt", ROOT / "tests" / "CMakeLists.txt"]:
            found |= set(re.findall(r"find_package\((\w+)", file.read_text()))
        names = {"CLI11": "cli11", "Eigen3": "eigen3", "fmt": "fmt", "Catch2": "catch2",
                 "nlohmann_json": "nlohmann-json", "tomlplusplus": "tomlplusplus",
                 "glm": "glm", "hwy": "highway", "PNG": "libpng", "Vulkan": "vulkan",
                 "glfw3": "glfw3", "SDL2": "sdl2", "ZLIB": "zlib", "hidapi": "hidapi", "imgui": "imgui",
                 "Freetype": "freetype"}
        self.assertIn('"builtin-baseline"', vcpkg)
        for package in found - {"Threads", "Python3", "PkgConfig"}:
            self.assertIn(f'"{names[package]}"', vcpkg)


if __name__ == "__main__":
    unittest.main()
