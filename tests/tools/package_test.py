"""tools/scripts/package: what is in the Debian package and in the archive, and that both run unpacked."""
import gzip
import json
import os
import re
import shutil
import subprocess
import tempfile
import unittest
import xml.etree.ElementTree as ElementTree
from pathlib import Path

PROGRAM = Path(os.environ["PALPA_PROGRAM"])
ROOT = Path(os.environ["PALPA_ROOT"])
BUILD = PROGRAM.parent.parent
NEEDED = ("cpack", "dpkg-deb", "dpkg-shlibdeps", "file", "patchelf", "readelf", "objdump", "ldd")


def run(*command, **options):
    return subprocess.run([str(word) for word in command], capture_output=True, text=True,
                          stdin=subprocess.DEVNULL, **options)


def runpath(file):
    return re.findall(r"\((?:RPATH|RUNPATH)\).*\[(.*)\]", run("readelf", "-dW", file).stdout)


class Package(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        missing = [tool for tool in NEEDED if not shutil.which(tool)]
        if missing:
            raise unittest.SkipTest(f"not installed: {' '.join(missing)}")
        cls.folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(cls.folder.cleanup)
        cls.tmp = Path(cls.folder.name)
        result = run(ROOT / "tools" / "scripts" / "package", cls.tmp / "out", "--build", BUILD)
        assert result.returncode == 0, result.stdout + result.stderr
        cls.package, = (cls.tmp / "out").glob("palpa_*.deb")
        cls.archive, = (cls.tmp / "out").glob("palpa-*.tar.xz")
        run("dpkg-deb", "-x", cls.package, cls.tmp / "debian", check=True)
        cls.usr = cls.tmp / "debian" / "usr"
        (cls.tmp / "some where").mkdir()
        run("tar", "-xJf", cls.archive, "-C", cls.tmp / "some where", check=True)
        cls.portable, = (cls.tmp / "some where").iterdir()

    def field(self, name):
        return run("dpkg-deb", "-f", self.package, name).stdout.strip()

    def play(self, program, name):
        here = self.tmp / name
        here.mkdir()
        clean = {"HOME": str(here), "PATH": "/usr/bin:/bin"}  # no variable leads back to the build
        result = run(program, "run", "water", "--headless", "--seconds", "0.5", "--record", "out", cwd=here, env=clean)
        self.assertEqual(result.returncode, 0, result.stderr)
        return (here / "out" / "trace.csv").read_bytes()

    def test_both_run_from_where_they_are_unpacked(self):
        built = self.play(PROGRAM, "built")
        self.assertEqual(self.play(self.usr / "bin" / "palpa", "package"), built)
        self.assertEqual(self.play(self.portable / "bin" / "palpa", "archive"), built)

    def test_the_debian_package_asks_for_what_the_program_links(self):
        names = [entry.split()[0] for entry in self.field("Depends").split(",")]
        for name in ("libc6", "libstdc++6", "libvulkan1", "libglfw3", "libsdl2-2.0-0", "libpng16-16", "zlib1g"):
            self.assertIn(name, names)
        self.assertIn("mesa-vulkan-drivers | vulkan-icd", self.field("Recommends"))
        version = run(PROGRAM, "--version").stdout.split()[0]
        self.assertEqual(self.field("Version"), version)
        self.assertEqual(self.field("Section"), "science")
        # A summary, then paragraphs: no line of control words but single dots.
        self.assertRegex(self.field("Description"), r"(?s)^\w[^\n]*(\n \w[^\n]*)+\n \.(\n \w[^\n]*)+$")

    def test_the_debian_package_has_what_debian_wants(self):
        share = self.usr / "share"
        self.assertTrue((self.usr / "lib/udev/rules.d/70-palpa.rules").is_file())
        for name in ("bash-completion/completions/palpa", "applications/palpa.desktop",
                     "icons/hicolor/scalable/apps/palpa.svg", "mime/packages/palpa.xml", "palpa/scenes/hiv/scene.toml",
                     "palpa/force-field/charmm36.ff"):
            with self.subTest(name=name):
                self.assertTrue((share / name).is_file())
        self.assertIn(".TH PALPA 1", gzip.decompress((share / "man/man1/palpa.1.gz").read_bytes()).decode())
        changelog = gzip.decompress((share / "doc/palpa/changelog.gz").read_bytes()).decode()
        self.assertTrue(changelog.startswith(f"palpa ({self.field('Version')}) "))
        copyright_file = (share / "doc/palpa/copyright").read_text()
        # The licence's words, whatever the lines.
        words = " ".join(re.sub(r"^ \.?", "", copyright_file, flags=re.M).split())
        licence = (ROOT / "LICENSE").read_text().split("authors", 1)[1]
        self.assertIn(" ".join(licence.split()), words)
        self.assertIn("charmm36.ff", copyright_file)
        listed = run("dpkg-deb", "-c", self.package).stdout.splitlines()
        self.assertGreater(len(listed), 50)
        for line in listed:  # folders too belong to root, and nobody else may write
            self.assertRegex(line, r"^[-d][rwx-]{3}r-[x-]r-[x-] root/root ")

    def test_what_the_desktop_opens_has_a_type(self):
        share = self.usr / "share"
        desktop = (share / "applications/palpa.desktop").read_text()
        self.assertIn("\nExec=palpa %F\n", desktop)
        types = set(re.search(r"MimeType=(.*);", desktop)[1].split(";"))
        self.assertEqual(types, {"application/x-palpa-scene+toml", "chemical/x-pdb", "chemical/x-mmcif"})
        space = "{http://www.freedesktop.org/standards/shared-mime-info}"
        tree = ElementTree.parse(share / "mime/packages/palpa.xml")
        globs = {kind.get("type"): [glob.get("pattern") for glob in kind.iter(space + "glob")]
                 for kind in tree.iter(space + "mime-type")}
        self.assertEqual(set(globs), types)
        self.assertEqual(globs["application/x-palpa-scene+toml"], ["scene.toml"])
        self.assertIn("*.pdb", globs["chemical/x-pdb"])
        self.assertIn("*.cif", globs["chemical/x-mmcif"])
        self.assertLess((share / "icons/hicolor/scalable/apps/palpa.svg").stat().st_size, 60_000)
        ElementTree.parse(share / "icons/hicolor/scalable/apps/palpa.svg")
        if shutil.which("desktop-file-validate"):
            checked = run("desktop-file-validate", share / "applications/palpa.desktop")
            self.assertEqual((checked.returncode, checked.stdout), (0, ""))

    def test_the_archive_brings_its_libraries(self):
        self.assertEqual(runpath(self.portable / "bin" / "palpa"), ["$ORIGIN/../lib"])
        self.assertEqual(runpath(self.usr / "bin" / "palpa"), [])
        loaded = run("ldd", self.portable / "bin" / "palpa", env={"PATH": "/usr/bin:/bin"}).stdout
        self.assertNotIn("not found", loaded)
        own, others = set(), set()
        for name, file in re.findall(r"^\s*(\S+) => (.+) \(", loaded, re.M):
            inside = (self.portable / "lib").resolve() in Path(file).resolve().parents
            (own if inside else others).add(name)
        for name in ("libSDL2-2.0.so.0", "libglfw.so.3", "libpng16.so.16", "libfmt.so.9", "libhwy.so.1"):
            self.assertIn(name, own)
        # What has to be the system's stays out of lib/.
        bundled = {file.name for file in (self.portable / "lib").glob("*.so*")}
        self.assertEqual(own, bundled)
        for name in bundled:
            self.assertNotRegex(name, r"^lib(c|m|stdc\+\+|gcc_s|X.*|xcb.*|wayland.*|vulkan|drm)\.so")
            self.assertEqual(runpath(self.portable / "lib" / name), ["$ORIGIN"])
        # Each with its licence.
        documents = self.portable / "share/doc/palpa"
        rows = [line.split() for line in (documents / "libraries.txt").read_text().splitlines()]
        rows = {row[0]: row for row in rows if row and ".so" in row[0]}
        self.assertEqual(set(rows), bundled)
        for name, row in rows.items():
            with self.subTest(library=name):
                self.assertGreaterEqual(len(row), 4)
                self.assertNotRegex(row[3], r"^(AGPL|GPL)")
                self.assertTrue((documents / "libraries" / f"{row[1]}.txt").stat().st_size)

    def test_both_have_the_notices_of_what_is_compiled_in(self):
        libraries = json.loads(run(PROGRAM, "licences", "--json", check=True).stdout)["libraries"]
        compiled_in = [library["name"] for library in libraries if not library["files"]]
        holder = {"CLI11": "University of Cincinnati", "Eigen": "Benoit Jacob", "gemmi": "Global Phasing",
                  "GLM": "G-Truc Creation", "Dear ImGui": "Omar Cornut", "JSON for Modern C++": "Niels Lohmann",
                  "PEGTL": "Colin Hirsch"}
        self.assertEqual(set(compiled_in), set(holder))
        for share in (self.usr / "share", self.portable / "share"):
            texts = [file.read_text() for file in (share / "doc/palpa/compiled-in").iterdir()]
            self.assertEqual(len(texts), len(holder))
            for name, words in holder.items():
                with self.subTest(library=name):
                    self.assertTrue(any(words in text for text in texts))

    def test_the_readme_names_the_oldest_system(self):
        text = (self.portable / "README").read_text()
        said = re.search(r"glibc (\d+\.\d+) or newer", text)[1]
        # By readelf, which reads the versions from another section than the script's objdump.
        files = [self.portable / "bin" / "palpa", *(self.portable / "lib").glob("*.so*")]
        asked = re.findall(r"Name: GLIBC_(\d+)\.(\d+)", "".join(run("readelf", "-VW", file).stdout for file in files))
        newest = max((int(major), int(minor)) for major, minor in asked)
        self.assertEqual(said, "{}.{}".format(*newest))
        self.assertNotIn("@", text)


class Usage(unittest.TestCase):
    def test_bad_arguments_are_refused(self):
        script = ROOT / "tools" / "scripts" / "package"
        for arguments in ((), ("a", "b"), ("--what",), ("out", "--build")):
            with self.subTest(arguments=arguments):
                result = run(script, *arguments)
                self.assertEqual(result.returncode, 2)
                self.assertIn("tools/scripts/package OUT", result.stderr)
        with tempfile.TemporaryDirectory() as folder:
            result = run(ROOT / "tools" / "scripts" / "try_packages", folder)
            self.assertEqual(result.returncode, 2)
            self.assertIn("has 0 files palpa_*.deb; expected one", result.stderr)


if __name__ == "__main__":
    unittest.main()
