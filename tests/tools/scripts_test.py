"""The shell tools and the documentation: help, usage, the figure, the list of keys."""
import contextlib
import gzip
import io
import math
import os
import re
import struct
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

sys.path.append(str(Path(__file__).resolve().parents[1] / "support"))
from recorded_files import open_recorded  # noqa: E402

PROGRAM = os.environ["PALPA_PROGRAM"]
ROOT = Path(os.environ["PALPA_ROOT"])


def run(*command, **options):
    return subprocess.run([str(word) for word in command], capture_output=True, text=True,
                          stdin=subprocess.DEVNULL, **options)


class Scripts(unittest.TestCase):
    def test_every_tool_explains_itself(self):
        folders = (ROOT / "tools" / "scripts", ROOT / "tools" / "lab" / "scripts")
        scripts = [path.relative_to(ROOT / "tools") for folder in folders for path in folder.iterdir() if path.is_file()]
        self.assertGreater(len(scripts), 30)
        for name in ["build", "run", "test", "windows/build", "windows/libraries", *sorted(map(str, scripts))]:
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
            # The same from the compressed recording, and a sentence where that is cut off.
            packed = recording / "trace.csv.gz"
            with open_recorded(recording / "trace.csv") as file:
                text = file.read()
            packed.write_bytes(gzip.compress((recording / "trace.csv").read_bytes()))
            (recording / "trace.csv").unlink()
            with open_recorded(recording / "trace.csv") as file:
                self.assertEqual(file.read(), text)
            result = run(ROOT / "tools" / "scripts" / "plot_stroke", recording, image)
            self.assertEqual((result.returncode, image.read_bytes()), (0, data), result.stderr)
            packed.write_bytes(packed.read_bytes()[:-1000])
            result = run(ROOT / "tools" / "scripts" / "plot_stroke", recording, image)
            self.assertEqual(result.returncode, 2)
            self.assertIn("trace.csv.gz: is cut off or damaged", result.stderr)
            with self.assertRaises(SystemExit) as ended, contextlib.redirect_stderr(io.StringIO()) as said:
                with open_recorded(recording / "trace.csv") as file:
                    file.read()
            self.assertEqual(ended.exception.code, 2)
            self.assertIn("trace.csv.gz: is cut off or damaged", said.getvalue())

    def test_a_bilayer_has_bonds_of_their_length_and_natural_lipids(self):
        with tempfile.TemporaryDirectory() as folder:
            patch = Path(folder) / "patch.pdb"
            result = run(ROOT / "tools" / "scripts" / "make_bilayer", "--side", "1", "-o", patch)
            self.assertEqual(result.returncode, 0, result.stderr)
            lipids = {}
            for line in patch.read_text().splitlines():
                if line.startswith("HETATM"):
                    place = tuple(float(line[i:i + 8]) for i in (30, 38, 46))
                    lipids.setdefault(line[22:26], {})[line[12:16].strip()] = place
            self.assertEqual([len(lipid) for lipid in lipids.values()], [42, 42])
            for lipid in lipids.values():
                for a, b, length in (("P", "O13", 1.48), ("C2", "O21", 1.43), ("C31", "O32", 1.22), ("C27", "C28", 1.53)):
                    self.assertAlmostEqual(math.dist(lipid[a], lipid[b]), length, delta=0.08)
                one, two, three = ([x - y for x, y in zip(lipid[name], lipid["C2"])] for name in ("O21", "C1", "C3"))
                normal = [two[(i + 1) % 3] * three[(i + 2) % 3] - two[(i + 2) % 3] * three[(i + 1) % 3] for i in range(3)]
                self.assertGreater(sum(x * y for x, y in zip(one, normal)), 0)  # C2 is R
            # Phosphates outside, the ends of chains in the middle
            self.assertGreater(lipids["   1"]["P"][2], lipids["   1"]["C212"][2] + 10)
            self.assertLess(lipids["   2"]["P"][2], lipids["   2"]["C212"][2] - 10)

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
        names = {"CLI11": "cli11", "CURL": "curl", "Eigen3": "eigen3", "fmt": "fmt", "Catch2": "catch2",
                 "nlohmann_json": "nlohmann-json", "tomlplusplus": "tomlplusplus",
                 "glm": "glm", "hwy": "highway", "PNG": "libpng", "Vulkan": "vulkan",
                 "glfw3": "glfw3", "SDL2": "sdl2", "ZLIB": "zlib", "hidapi": "hidapi", "imgui": "imgui",
                 "Freetype": "freetype"}
        self.assertIn('"builtin-baseline"', vcpkg)
        for package in found - {"Threads", "Python3", "PkgConfig"}:
            self.assertIn(f'"{names[package]}"', vcpkg)


if __name__ == "__main__":
    unittest.main()
