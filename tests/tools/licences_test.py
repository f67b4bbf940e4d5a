"""palpa licences: its list against what the program links and what CMake looks for; palpa --version."""
import json
import os
import re
import shutil
import subprocess
import tempfile
import unittest
from pathlib import Path

PROGRAM = os.environ["PALPA_PROGRAM"]
ROOT = Path(os.environ["PALPA_ROOT"])
# Found by CMake, and no library.
NOT_LIBRARIES = {"Threads", "PkgConfig", "Python3"}


def palpa(*arguments, **environment):
    return subprocess.run([PROGRAM, *arguments], capture_output=True, text=True, stdin=subprocess.DEVNULL,
                          env={**os.environ, **environment})


def sought_by_cmake():
    """Names of packages in all CMakeLists.txt but those of tests."""
    found = set()
    files = [ROOT / "CMakeLists.txt", *(file for folder in ("engine", "devices", "tools")
                                        for file in (ROOT / folder).rglob("CMakeLists.txt"))]
    for file in files:
        text = re.sub(r"#[^\n]*", "", file.read_text())
        found |= set(re.findall(r"find_package\((\w+)", text))
        found |= set(re.findall(r"pkg_check_modules\((\w+)", text))
        found |= set(re.findall(r"find_path\(\w+ (\w+)/", text))
    return found - NOT_LIBRARIES


class Licences(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        result = palpa("licences", "--json")
        assert result.returncode == 0, result.stderr
        cls.json = json.loads(result.stdout)
        cls.libraries = cls.json["libraries"]

    def test_what_the_program_links_is_listed_and_nothing_else(self):
        if not shutil.which("readelf") or not shutil.which("ldd"):
            self.skipTest("readelf and ldd are not installed")
        dynamic = subprocess.run(["readelf", "-dW", PROGRAM], capture_output=True, text=True, check=True).stdout
        needed = set(re.findall(r"\(NEEDED\).*\[(?!ld-linux)(.+?)\]", dynamic))
        self.assertGreater(len(needed), 10)
        # Those of sanitizers belong to such builds alone.
        needed = {name for name in needed if not re.match(r"lib(asan|ubsan|tsan|clang_rt)", name)}
        stems = {stem for library in self.libraries for stem in library["files"].split()}
        matched = {name: [stem for stem in stems if re.fullmatch(re.escape(stem) + r"(-[\d.]+)?\.so(\.\d+)*", name)]
                   for name in needed}
        for name, its_stems in matched.items():
            self.assertEqual(len(its_stems), 1, name)
        # The C library comes in one file or in several.
        self.assertEqual(stems - {stem for its in matched.values() for stem in its} - {"libdl", "libpthread", "libm"},
                         set())
        # ldd names these, and what they bring along.
        loaded = subprocess.run(["ldd", PROGRAM], capture_output=True, text=True, check=True).stdout
        self.assertEqual(needed - set(re.findall(r"^\s*(\S+) =>", loaded, re.M)), set())

    def test_what_cmake_looks_for_is_listed_and_nothing_else(self):
        listed = {library["package"] for library in self.libraries} - {""}
        self.assertEqual({name.split("/")[0] for name in listed} - {"tao"}, sought_by_cmake())
        # What comes along: stated by the packages that a build needs.
        packages = (ROOT / "tools" / "packages.txt").read_text().splitlines()
        self.assertIn("tao-pegtl-dev", packages)
        self.assertIn("tao/pegtl", listed)

    def test_versions_are_those_of_the_libraries(self):
        for library in self.libraries:
            with self.subTest(library=library["name"]):
                if library["name"] not in ("stb", "Font Awesome 4.7"):  # has none; is of that version
                    self.assertRegex(library["version"], r"^\d+(\.\d+)*$")
                self.assertRegex(library["home"], r"^https?://[\w.-]+(/[\w./-]*)?$")
                # An expression of SPDX.
                self.assertRegex(library["licence"], r"^[\w.+-]+( (OR|AND|WITH) [\w.+-]+)*$")
        if shutil.which("pkg-config"):
            versions = {library["package"]: library["version"] for library in self.libraries}
            for module, package in (("sdl2", "SDL2"), ("glfw3", "glfw3"), ("libpng", "PNG"), ("fmt", "fmt"),
                                    ("zlib", "ZLIB"), ("eigen3", "Eigen3"), ("libhwy", "hwy")):
                said = subprocess.run(["pkg-config", "--modversion", module], capture_output=True, text=True)
                if said.returncode == 0:
                    with self.subTest(module=module):
                        self.assertEqual(versions[package], said.stdout.strip())

    def test_the_force_field_and_its_citations_are_there(self):
        about = (ROOT / "engine" / "charmm" / "charmm36.txt").read_text().splitlines()
        self.assertEqual(self.json["force_field"], about)
        page = palpa("licences").stdout
        for line in about:
            self.assertIn(line, page)
        for library in self.libraries:
            for key in ("name", "version", "licence", "home"):
                self.assertIn(library[key], page)
        self.assertIn("Bottaro", page)


    def test_the_list_of_parts_has_every_library_once(self):
        """Fields that SPDX 2.3 demands, by its specification, clauses 6, 7 and 11."""
        parts = json.loads(palpa("licences", "--spdx").stdout)
        self.assertEqual((parts["spdxVersion"], parts["dataLicense"], parts["SPDXID"]),
                         ("SPDX-2.3", "CC0-1.0", "SPDXRef-DOCUMENT"))
        self.assertRegex(parts["creationInfo"]["created"], r"^\d{4}-\d\d-\d\dT\d\d:\d\d:\d\dZ$")
        packages = parts["packages"]
        self.assertEqual([package["name"] for package in packages],
                         ["palpa", *(library["name"] for library in self.libraries)])
        ids = [package["SPDXID"] for package in packages]
        self.assertEqual(len(set(ids)), len(ids))
        for package in packages:
            self.assertRegex(package["SPDXID"], r"^SPDXRef-[A-Za-z0-9.-]+$")
            self.assertEqual(package["downloadLocation"], "NOASSERTION")
            self.assertTrue(package["licenseDeclared"])
        related = {(row["spdxElementId"], row["relationshipType"], row["relatedSpdxElement"])
                   for row in parts["relationships"]}
        self.assertEqual(related, {("SPDXRef-DOCUMENT", "DESCRIBES", "SPDXRef-palpa"),
                                   *(("SPDXRef-palpa", "DEPENDS_ON", name) for name in ids[1:])})


class Version(unittest.TestCase):
    def test_the_first_line_is_version_and_commit_and_more_follows(self):
        lines = palpa("--version").stdout.splitlines()
        self.assertRegex(lines[0], r"^\d+\.\d+\.\d+ \(\S+\)$")
        self.assertEqual([line.split()[0] for line in lines[1:]], ["formats", "compiler", "processor", "Vulkan", "libcurl"])
        self.assertEqual(lines[1].split(None, 1)[1], "scene 2.2, recording 2.1, journal 2.2")
        self.assertRegex(lines[2], r"(GCC|Clang|MSVC) .*\d")
        # As the kernel of the operating system names what the processor can do.
        cpuinfo = Path("/proc/cpuinfo")
        flags = re.search(r"^flags\s*:(.*)$", cpuinfo.read_text(), re.M) if cpuinfo.exists() else None
        if flags:
            has = set(flags[1].split())
            kind = ("AVX3" if {"avx512f", "avx512bw", "avx512dq", "avx512vl", "avx512cd"} <= has else
                    "AVX2" if {"avx2", "fma", "bmi2"} <= has else "S")  # SSE4, SSSE3, SSE2, SCALAR
            self.assertTrue(lines[3].split()[1].startswith(kind), lines[3])

    def test_where_no_driver_is_it_says_so(self):
        with tempfile.TemporaryDirectory() as folder:
            nothing = {"VK_ICD_FILENAMES": folder + "/none.json", "VK_DRIVER_FILES": folder + "/none.json"}
            result = palpa("--version", **nothing)
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertRegex(result.stdout.splitlines()[4], r"^Vulkan +none: \w+")
        self.assertEqual(len(result.stdout.splitlines()), 6)


if __name__ == "__main__":
    unittest.main()
