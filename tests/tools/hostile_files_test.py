"""Files that are too large, endless or from a stranger: one sentence, in time, and nothing given away."""
import json
import os
import shutil
import signal
import subprocess
import tempfile
import time
import unittest
from pathlib import Path

PROGRAM = os.environ["PALPA_PROGRAM"]
ROOT = Path(os.environ["PALPA_ROOT"])
WATER = ROOT / "scenes" / "water"
PEPTIDES = ROOT / "tests" / "data" / "two_peptides"
PATIENCE = 60  # seconds until a hang is one


class HostileFiles(unittest.TestCase):
    def setUp(self):
        temporary = tempfile.TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        self.tmp = Path(temporary.name)
        self.scene = Path(shutil.copytree(WATER, self.tmp / "scene"))
        self.file = self.scene / "scene.toml"

    def palpa(self, *arguments, **environment):
        return subprocess.run([PROGRAM, *map(str, arguments)], capture_output=True, text=True,
                              cwd=self.tmp, stdin=subprocess.DEVNULL, timeout=PATIENCE,
                              env={**os.environ, **environment})

    def assert_refused(self, result, *expected):
        self.assertEqual(result.returncode, 2, result.stdout + result.stderr)
        self.assertEqual(len(result.stderr.strip().splitlines()), 1, result.stderr)
        for text in expected:
            self.assertIn(text, result.stderr)

    def change(self, old, new):
        text = self.file.read_text()
        self.assertIn(old, text)
        self.file.write_text(text.replace(old, new))

    def sparse(self, name):
        path = self.tmp / name
        with open(path, "wb") as file:
            file.truncate(40 << 30)
        return path

    # ---- signals

    def start(self, *arguments):
        program = subprocess.Popen([PROGRAM, *map(str, arguments)], cwd=self.tmp,
                                   stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL,
                                   stderr=subprocess.DEVNULL,
                                   preexec_fn=lambda: [signal.signal(number, signal.SIG_DFL) for
                                                       number in (signal.SIGINT, signal.SIGTERM)])
        self.addCleanup(program.wait)
        self.addCleanup(program.kill)
        return program

    def ends_by(self, program, number):
        self.assertIsNone(program.poll(), "it ended by itself")
        program.send_signal(number)
        code = program.wait(timeout=PATIENCE)
        self.assertIn(code, (-number, 128 + number))

    def test_a_signal_ends_the_reading_of_a_long_script(self):
        script = self.tmp / "long.csv"
        with open(script, "w") as file:
            file.write("time_s,handle_x_m,handle_y_m,handle_z_m\n")
            for begin in range(0, 6_000_000, 100_000):
                file.write("".join(f"{i},0,0,0\n" for i in range(begin, begin + 100_000)))
        for number in (signal.SIGINT, signal.SIGTERM):
            program = self.start("run", WATER, "--headless", "--device", f"script:{script}",
                                 "--record", self.tmp / "recording")
            while "long.csv" not in self.open_files(program):
                self.assertIsNone(program.poll(), "it ended by itself")
            self.ends_by(program, number)
            self.assertFalse((self.tmp / "recording").exists())

    @staticmethod
    def open_files(program):
        try:
            folder = Path(f"/proc/{program.pid}/fd")
            return " ".join(os.readlink(path) for path in folder.iterdir())
        except OSError:
            return ""

    @staticmethod
    def work(program):
        """Seconds that the program has computed so far."""
        fields = Path(f"/proc/{program.pid}/stat").read_text().rpartition(")")[2].split()
        return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")

    def wait_for_work(self, program, seconds):
        while self.work(program) < seconds:
            self.assertIsNone(program.poll(), "it ended by itself")
            time.sleep(0.01)

    def test_a_signal_ends_a_long_relaxation(self):
        for number in (signal.SIGINT, signal.SIGTERM):
            begins = [f"--set=molecules.{name}.structure=system.crd"
                      for name in ("protease_a", "protease_b", "inhibitor")]
            program = self.start("relax", ROOT / "scenes" / "hiv" / "flexible.toml", *begins,
                                 "--set", "rest_kcal_per_mol=1e-6", "--set", "statics.pairs=double")
            self.wait_for_work(program, 2)  # loading takes a fraction of that
            self.ends_by(program, number)

    def test_a_signal_ends_a_long_step_and_the_recording_is_whole(self):
        folder = self.tmp / "recording"
        program = self.start("run", PEPTIDES, "--headless", "--record", folder, "--set",
                             "statics.steps=10000", "--seconds", "1000", "--mode", "4", "--set",
                             "statics.pairs=double", "--period-ms", "2")
        trace = folder / "trace.csv"
        while not (trace.exists() and trace.stat().st_size > 0):
            self.assertIsNone(program.poll(), "it ended by itself")
            time.sleep(0.01)
        self.wait_for_work(program, self.work(program) + 1)  # into a step
        self.ends_by(program, signal.SIGTERM)
        self.assertTrue((folder / "summary.json").exists())

    # ---- sizes, and what is no file

    def test_a_file_that_is_too_large_is_refused(self):
        large = self.sparse("large.crd")
        for arguments in (["energy", large, "--toppar", WATER / "tip3p.str"],
                          ["energy", WATER / "dimer.crd", "--toppar", large],
                          ["run", WATER, "--headless", "--device", f"script:{large}"],
                          ["run", WATER, "--headless", "--device", f"replay:{large}"]):
            with self.subTest(arguments=arguments):
                self.assert_refused(self.palpa(*arguments), "large.crd: is 40.0 GiB large")
        self.sparse("scene/scene.toml")
        self.assert_refused(self.palpa("run", self.scene), "scene.toml: is 40.0 GiB large")

    def test_a_picture_that_is_too_large_is_refused(self):
        for arguments in (["--size", "16384x16384"], ["--size", "8192x8192", "--samples", "4"]):
            with self.subTest(arguments=arguments):
                self.assert_refused(self.palpa("render", WATER, "-o", "x.png", *arguments),
                                    "67108864")

    def test_what_is_no_regular_file_is_not_read(self):
        recording = self.tmp / "recording"
        result = self.palpa("run", WATER, "--headless", "--seconds", "0.1", "--record", recording)
        self.assertEqual(result.returncode, 0, result.stderr)
        for name in ("summary.json", "trace.csv", "session.toml"):
            with self.subTest(name=name):
                copy = self.tmp / f"with-{name}"
                shutil.copytree(recording, copy)
                (copy / name).unlink()
                os.mkfifo(copy / name)
                self.assert_refused(self.palpa("replay", copy, "--verify"), name,
                                    "is not a regular file")
                self.assertEqual(self.palpa("run", WATER, "--headless", "--record", copy,
                                            "--overwrite").returncode, 2)

    # ---- scenes of strangers

    def test_a_scene_names_files_of_its_own(self):
        (self.tmp / "outside.crd").write_text("hidden words\n")
        (self.scene / "link.crd").symlink_to(self.tmp / "outside.crd")
        for name in ("../outside.crd", str(self.tmp / "outside.crd"), "link.crd",
                     "/proc/self/environ"):
            with self.subTest(name=name):
                shutil.copy(WATER / "scene.toml", self.file)
                self.change('structure = "dimer.crd"', f'structure = "{name}"')
                result = self.palpa("run", "--check", self.scene, HIDDEN="hidden")
                self.assert_refused(result, "scene.toml:", "outside of the scene's folder",
                                    "--allow-outside")
                self.assertNotIn("hidden", result.stderr)

    def test_outside_is_allowed_on_demand(self):
        shutil.move(self.scene / "dimer.crd", self.tmp / "dimer.crd")
        self.change('"dimer.crd"', '"../dimer.crd"')
        commands = (["run", "--check", self.scene],
                    ["run", self.scene, "--headless", "--seconds", "0.1", "--record", "recording"])
        for command in commands:
            self.assert_refused(self.palpa(*command), "outside of the scene's folder")
            result = self.palpa(*command, "--allow-outside")
            self.assertEqual(result.returncode, 0, result.stderr)
        # A recording has copies, and needs nobody's trust.
        self.assertEqual(self.palpa("replay", "recording", "--verify").returncode, 0)

    def test_the_scenes_of_the_program_are_for_every_scene(self):
        os.remove(self.scene / "tip3p.str")
        self.change('"tip3p.str"', f'"{WATER / "tip3p.str"}"')
        result = self.palpa("run", "--check", self.scene)
        self.assertEqual(result.returncode, 0, result.stderr)

    def test_a_message_quotes_a_word_at_most(self):
        secret = "".join(f"secret{i:04}" for i in range(400))
        for name, arguments in (
                ("a.str", ["energy", WATER / "dimer.crd", "--toppar", "a.str"]),
                ("a.csv", ["run", WATER, "--headless", "--device", "script:a.csv"]),
                ("a.crd", ["energy", "a.crd", "--toppar", WATER / "tip3p.str"]),
                ("a.psf", ["energy", "a.psf", "--coordinates", WATER / "dimer.crd", "--toppar", WATER / "tip3p.str"]),
                ("a.pdb", ["prepare", "a.pdb", "-o", "out"]), ("a.cif", ["prepare", "a.cif", "-o", "out"])):
            with self.subTest(name=name):
                (self.tmp / name).write_text(secret + "\n")
                result = self.palpa(*arguments)
                self.assert_refused(result, name)
                self.assertNotIn("secret0009", result.stderr.lower())

    def test_a_title_reaches_the_terminal_escaped(self):
        self.change('title = "Two waters"', 'title = "Two\\u001b]0;owned\\u0007 waters"')
        result = self.palpa("run", self.scene, "--headless", "--seconds", "0.1")
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertIn("Two\\x1b]0;owned\\x07 waters: 0.1 s", result.stdout)
        for letter in "\x1b\x07":
            self.assertNotIn(letter, result.stdout + result.stderr)

    def test_made_by_is_not_offered_as_a_command(self):
        os.remove(self.scene / "dimer.crd")
        self.file.write_text('made_by = "curl example.org/x | sh"\n' + self.file.read_text())
        result = self.palpa("run", self.scene)
        self.assert_refused(result, "dimer.crd; expected a file in the scene", "made_by")
        self.assertNotIn("curl", result.stderr)

    # ---- numbers

    def test_a_number_at_either_end_of_its_range_gives_a_finite_trace(self):
        """Or one sentence, where numbers contradict each other."""
        listed = self.palpa("run", "--keys").stdout
        for line in listed.splitlines():
            key, kind = (part.strip(" `") for part in line.split("|")[1:3])
            if not kind.startswith(("number", "whole number")) or "STEP" in key:
                continue
            lowest, highest = kind.split(", ")[1].split(" or ")[-1].split(" to ")
            if key in ("run.seconds", "coupling.pairs_per_tick", "hand.cycles"):
                continue
            for value in (lowest, highest):
                with self.subTest(key=key, value=value):
                    folder = self.tmp / f"{key}={value}"
                    result = self.palpa("run", WATER, "--headless", "--set", "run.seconds=0.05",
                                        "--set", f"{key}={value}", "--record", folder)
                    if result.returncode == 2:
                        self.assertEqual(len(result.stderr.strip().splitlines()), 1, result.stderr)
                        continue
                    self.assertEqual(result.returncode, 0, result.stderr)
                    rows = (folder / "trace.csv").read_text().split("\n", 1)[1]
                    self.assertNotRegex(rows, "[a-df-zA-Z]")  # numbers have no letter but e

    def test_a_trace_that_is_not_finite_is_not_verified(self):
        folder = self.tmp / "recording"
        self.palpa("run", WATER, "--headless", "--seconds", "0.1", "--record", folder)
        trace = folder / "trace.csv"
        lines = trace.read_text().splitlines(keepends=True)
        for word in ("nan", "inf", "-inf"):
            with self.subTest(word=word):
                row = lines[50].split(",")
                row[3] = word
                trace.write_text("".join(lines[:50] + [",".join(row)] + lines[51:]))
                result = self.palpa("replay", folder, "--verify", "--json")
                self.assertEqual(result.returncode, 1)
                self.assertEqual(json.loads(result.stdout)["not_finite"], 1)
                self.assertIn("not finite", self.palpa("replay", folder, "--verify").stdout)

    def test_molecules_far_apart_are_refused(self):
        for scene in (WATER, WATER / "space.toml", PEPTIDES):
            for far in ("10000", "99000"):
                with self.subTest(scene=scene, far=far):
                    shutil.rmtree(self.scene)
                    folder = scene.parent if scene.suffix else scene
                    shutil.copytree(folder, self.scene)
                    structure = self.scene / ("both.crd" if scene == PEPTIDES else "dimer.crd")
                    lines = structure.read_text().splitlines()
                    last = lines[-1].split()[7]
                    for i, line in enumerate(lines):
                        if line.split()[7:8] == [last]:
                            lines[i] = f"{line[:40]}{float(line[40:60]) + float(far):20.10f}{line[60:]}"
                    structure.write_text("\n".join(lines) + "\n")
                    result = self.palpa("run", "--check", self.scene / (scene.name if scene.suffix
                                                                        else "scene.toml"))
                    self.assert_refused(result, "Å apart; expected 1000 Å at most")


if __name__ == "__main__":
    unittest.main()
