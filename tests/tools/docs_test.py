"""The pages' commands are commands of the program: their options and scenes exist, and those of
READMEs that take a few seconds and need neither a window nor a device are run as they stand. Links
into pages find their heading."""
import functools
import os
import pathlib
import re
import shlex
import subprocess
import tempfile
import unittest

ROOT = pathlib.Path(os.environ["PALPA_ROOT"])
PROGRAM = os.environ["PALPA_PROGRAM"]
LAB = os.environ["PALPA_LAB"]
PAGES = [page for page in sorted(ROOT.glob("**/*.md"))
         if page.relative_to(ROOT).parts[0] not in ("build", "recordings")]
# Inputs of these are made by a script from an entry of the PDB.
NOT_MADE = ("scenes/groel",)


@functools.lru_cache(maxsize=None)
def help_of(program, command):
    return subprocess.run([program, command, "--help"], capture_output=True, text=True,
                          check=False).stdout


@functools.lru_cache(maxsize=None)
def commands(program):
    listed = subprocess.run([program, "--help"], capture_output=True, text=True, check=True).stdout
    return set(re.findall(r"^    ([a-z-]+) +[A-Z]", listed, re.M)) | {"help"}


def fenced(text):
    """The lines of fenced blocks; those that end in a backslash with the next."""
    for block in re.findall(r"^```[^\n]*\n(.*?)^```", text, re.M | re.S):
        yield from re.sub(r"\\\n\s*", "", block).splitlines()


def inline(text):
    return re.findall(r"(?<!`)`([^`]+)`(?!`)", re.sub(r"^```.*?^```", "", text, flags=re.M | re.S))


def palpa_arguments(line):
    """The program, and the arguments of `palpa ...`, `palpa-lab ...` or `tools/run ...`; nothing for another line."""
    line = re.sub(r"^(\w+=\S+ )+", "", " ".join(line.split()))
    started = re.match(r"(?:build/release/bin/)?palpa(-lab)? (.*)|tools/run ?(.*)", line)
    if not started:
        return None
    if started[2] is not None:
        arguments = split(started[2])
        return [LAB if started[1] else PROGRAM, *arguments] if arguments else None
    rest = split(started[3])
    if rest and "--headless" in rest and "--record" not in rest:  # as the script does
        rest += ["--record", "recordings/" + pathlib.Path(rest[0]).name, "--overwrite"]
    return [PROGRAM, "run", *rest]


def split(text):
    # Some in the text are cut off, with an open quotation mark.
    try:
        return shlex.split(text, comments=True)
    except ValueError:
        return text.split()


def is_runnable(line, arguments):
    """Takes seconds, and needs neither a window nor a device nor what stands for something else."""
    if "# long" in line or any(scene in line for scene in NOT_MADE) or re.search(r"\[--|[A-Z]{4,}|\.\.\.", line):
        return False
    return arguments[1] == "render" or "--headless" in arguments or "--check" in arguments


def anchors(text):
    """Of a page's headings, as GitHub makes them."""
    found = set()
    for heading in re.findall(r"^#+ (.*)$", re.sub(r"^```.*?^```", "", text, flags=re.M | re.S), re.M):
        words = re.sub(r"[^\w\- ]", "", re.sub(r"\]\([^)]*\)|[`\[\]]", "", heading.lower()))
        found.add(words.replace(" ", "-"))
    return found


class Pages(unittest.TestCase):
    def test_links_into_pages_find_their_heading(self):
        seen = 0
        for page in PAGES:
            for target, anchor in re.findall(r"\]\(([^)#\s]*)#([^)\s]+)\)", page.read_text()):
                if target.startswith("http"):
                    continue
                seen += 1
                with self.subTest(page=str(page.relative_to(ROOT)), link=f"{target}#{anchor}"):
                    other = page.parent / target if target else page
                    self.assertIn(anchor, anchors(other.read_text()))
        self.assertGreater(seen, 10)

    def each_command(self):
        for page in PAGES:
            text = page.read_text()
            for line in [*fenced(text), *inline(text)]:
                arguments = palpa_arguments(line)
                if arguments:
                    yield page.relative_to(ROOT), line, arguments

    def test_options_are_the_programs(self):
        seen = 0
        for page, line, arguments in self.each_command():
            program, command, *arguments = arguments
            if not re.fullmatch(r"[a-z-]+", command) or command.startswith("-"):
                continue
            with self.subTest(page=str(page), line=line):
                is_scene = (ROOT / "scenes" / command).is_dir()
                self.assertTrue(command in commands(program) or is_scene, command)
                known = set(re.findall(r"--[a-z][a-z-]*", help_of(program, command)))
                for argument in arguments:
                    option = re.match(r"\[?(--[a-z][a-z-]*)", argument)
                    if option and not is_scene:
                        self.assertIn(option[1], known | {"--help"})
                        seen += 1
        self.assertGreater(seen, 150)

    def test_scenes_are_there(self):
        for page, line, arguments in self.each_command():
            for argument in arguments[1:]:
                if re.match(r"scenes/[\w/.-]+$", argument) and not argument.endswith(
                        (".png", ".crd", ".psf", ".csv")):
                    with self.subTest(page=str(page), line=line):
                        self.assertTrue((ROOT / argument).exists(), argument)

    def test_short_commands_of_readmes_run(self):
        ran = 0
        for page in PAGES:
            if page.name == "README.md" and "tests" not in page.parts:
                with tempfile.TemporaryDirectory() as folder:
                    (pathlib.Path(folder) / "scenes").symlink_to(ROOT / "scenes")
                    ran += self.run_short_commands(page, folder)
        self.assertGreater(ran, 6)

    def run_short_commands(self, page, folder):
        ran = 0
        for line in fenced(page.read_text()):
            arguments = palpa_arguments(line)
            if not arguments or not is_runnable(line, arguments):
                continue
            ran += 1
            with self.subTest(page=str(page.relative_to(ROOT)), line=line):
                result = subprocess.run(arguments, cwd=folder, check=False,
                                        capture_output=True, text=True, timeout=300)
                self.assertEqual(result.returncode, 0, result.stderr[-500:])
        return ran


class Paper(unittest.TestCase):
    """engine/paper.md: what it names is there."""

    def test_names_are_in_the_files_that_it_links(self):
        page = ROOT / "engine/paper.md"
        names = 0
        for line in page.read_text().splitlines():
            for part in re.split(r"(?=\[[^\]]+\]\()", line):
                link = re.match(r"\[[^\]]+\]\(([^)#]+)[^)]*\)(.*)", part)
                if not link:
                    continue
                file = page.parent / link[1]
                self.assertTrue(file.is_file(), f"{page}: there is no {link[1]}")
                if file.suffix != ".h":
                    continue
                for name in re.findall(r"`(\w+)`", link[2].partition("|")[0].partition("; key")[0]):
                    names += 1
                    self.assertTrue(re.search(rf"\b{name}\b", file.read_text()), f"{page}: {link[1]} has no {name}")
        self.assertGreater(names, 25)

    def test_every_key_is_a_key_of_scenes(self):
        keys = subprocess.run([PROGRAM, "help", "keys"], capture_output=True, text=True, check=True).stdout.splitlines()
        named = re.findall(r"`([a-z]+\.\w+)`", (ROOT / "engine/paper.md").read_text())
        self.assertGreater(len(named), 10)
        for key in named:
            self.assertIn(key, keys)


if __name__ == "__main__":
    unittest.main()
