"""The program from outside: exit codes, one clear line on bad input, recordings that repeat."""
import json
import os
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import time
import unittest
from pathlib import Path

sys.path.append(str(Path(__file__).resolve().parents[1] / "support"))
from terminal import run_on_terminal  # noqa: E402

PROGRAM = os.environ["PALPA_PROGRAM"]
ROOT = Path(os.environ["PALPA_ROOT"])
WATER = ROOT / "scenes" / "water"


class Cli(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.tmp = Path(self.folder.name)

    def tearDown(self):
        self.folder.cleanup()

    def palpa(self, *arguments, cwd=None):
        return subprocess.run([PROGRAM, *map(str, arguments)], capture_output=True, text=True,
                              cwd=cwd or self.tmp, stdin=subprocess.DEVNULL)

    def run_water(self, *arguments):
        result = self.palpa("run", WATER, "--headless", *arguments)
        self.assertEqual(result.returncode, 0, result.stderr)
        return result

    def assert_bad_input(self, result, *expected):
        self.assertEqual(result.returncode, 2, result.stdout + result.stderr)
        self.assertEqual(len(result.stderr.strip().splitlines()), 1, result.stderr)
        for text in expected:
            self.assertIn(text, result.stderr)

    def copy_of_water(self):
        return Path(shutil.copytree(WATER, self.tmp / "scene"))

    # ---- signals

    def test_a_signal_ends_a_run_in_order(self):
        for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
            with self.subTest(signal=number):
                folder = self.tmp / f"signal{number}"
                program = subprocess.Popen(
                    [PROGRAM, "run", WATER, "--headless", "--seconds", "100000", "--every", "1000",
                     "--record", folder, "--json"],
                    stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
                    preexec_fn=lambda: signal.signal(number, signal.SIG_DFL))
                trace = folder / "trace.csv"
                while not (trace.exists() and trace.stat().st_size > 0):
                    self.assertIsNone(program.poll(), "it ended early")
                    time.sleep(0.01)
                program.send_signal(number)
                out, err = program.communicate(timeout=120)
                self.assertEqual(program.returncode, 128 + number, err)
                self.assertLess(json.loads(out)["seconds"], 100000)
                self.assertTrue(trace.read_text().endswith("\n"))

    # ---- help and usage

    def test_help_is_a_page_in_plain_words(self):
        page = self.palpa("--help").stdout
        self.assertLessEqual(len(page.splitlines()), 24)  # a screen
        commands = re.findall(r"^    ([a-z]+)  +[A-Z]", page, re.M)
        self.assertGreater(len(commands), 10)
        self.assertLessEqual(len(commands), 16)
        for command in commands:
            with self.subTest(command=command):
                result = self.palpa("help", command)
                self.assertEqual(result.returncode, 0, result.stderr)
                self.assertEqual(result.stdout, self.palpa(command, "--help").stdout)
                self.assertIn(f"\n  palpa {command}", result.stdout)  # an example
                # Nothing of the library's: flags with defaults, types, upper-case notes.
                self.assertNotRegex(result.stdout, r"\{|TEXT\b|FLOAT|UINT|REQUIRED|Needs:|Excludes:")
                self.assertLessEqual(max(map(len, result.stdout.split("\nExample")[0].splitlines())), 100)
        for code in ("0 done", "1 a check", "2 wrong", "3 internal", "4 no answer", "128+N ended"):
            self.assertIn(code, page)
        self.assertEqual(self.palpa("help").stdout, page)

    def test_keys_of_scenes_are_explained(self):
        every = self.palpa("help", "keys").stdout
        self.assertIn("coupling.mode\n", every)
        self.assertIn("molecules.NAME.structure\n", every)
        one = self.palpa("help", "coupling.mode").stdout
        self.assertIn(one, every)
        self.assertIn('unless given: "guarded"', one)
        self.assertEqual(self.palpa("help", "mode").stdout, one)
        table = self.palpa("help", "coupling").stdout
        self.assertIn(one, table)
        self.assertNotIn("hand.grip\n", table)
        for asked, said in ((["coupling.mod"], "did you mean 'coupling.mode'?"), (["perid_ms"], "did you mean 'period_ms'?"),
                            (["mode", "perid_ms"], "did you mean 'period_ms'?"), (["mode", "nonsense"], "'nonsense'")):
            with self.subTest(asked=asked):
                result = self.palpa("help", *asked)
                self.assert_bad_input(result, said)
                self.assertEqual(result.stdout, "")
        self.assertIn("run.period_ms\n", self.palpa("help", "run.").stdout)  # a command's name, too

    def test_what_is_misspelt_gets_the_near_name(self):
        for arguments, hint in ((["rnu", WATER], "did you mean 'run'"),
                                (["hlep"], "did you mean 'help'"),
                                (["hiv/flexible"], "did you mean 'palpa run hiv/flexible'?"),
                                (["--hepl"], "did you mean '--help'"),
                                (["run", WATER, "--hedless"], "did you mean '--headless'"),
                                (["run", WATER, "--frction=0"], "did you mean '--friction'"),
                                (["run", "hvi"], "did you mean 'hiv'"),
                                (["run", "scenes/wter"], "did you mean 'water'"),
                                (["run", "hiv/flexable.toml"], "did you mean 'hiv/flexible'")):
            with self.subTest(arguments=arguments):
                self.assert_bad_input(self.palpa(*arguments), hint)

    def test_alone_it_lists_the_scenes(self):
        clean = {key: value for key, value in os.environ.items()
                 if key not in ("DISPLAY", "WAYLAND_DISPLAY")}
        result = subprocess.run([PROGRAM], capture_output=True, text=True, env=clean, cwd=self.tmp)
        self.assertEqual(result.returncode, 0, result.stderr)
        for scene in ("water", "water/space", "hiv", "hiv/flexible"):
            self.assertRegex(result.stdout, rf"(?m)^  {scene} ")
        self.assertIn("palpa run water", result.stdout)
        (self.tmp / "palpa").mkdir()
        (self.tmp / "palpa" / "preferences.toml").write_text("scene = '/nowhere/scene.toml'\n")
        # An empty name is no display, and what is gone is not offered.
        result = subprocess.run([PROGRAM], capture_output=True, text=True, cwd=self.tmp,
                                env={**clean, "DISPLAY": "", "XDG_CONFIG_HOME": str(self.tmp)})
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertNotIn("nowhere", result.stdout)
        # Where the display does not answer they are listed too.
        (self.tmp / "mine.toml").write_text("title = 3")
        (self.tmp / "palpa" / "preferences.toml").write_text(f"recent = ['{self.tmp}/mine.toml']\n")
        result = subprocess.run([PROGRAM], capture_output=True, text=True, cwd=self.tmp,
                                env={**clean, "DISPLAY": ":4711", "XDG_CONFIG_HOME": str(self.tmp)})
        self.assert_bad_input(result, "display")
        self.assertIn("palpa run water", result.stdout)
        self.assertIn("mine.toml", result.stdout)

    def test_a_file_alone_needs_a_display_and_must_be_there(self):
        clean = {key: value for key, value in os.environ.items()
                 if key not in ("DISPLAY", "WAYLAND_DISPLAY")}
        result = subprocess.run([PROGRAM, self.tmp / "none.pdb"], capture_output=True, text=True,
                                env=clean)
        self.assert_bad_input(result, "none.pdb")
        (self.tmp / "one.pdb").write_text("END\n")
        result = subprocess.run([PROGRAM, self.tmp / "one.pdb"], capture_output=True, text=True,
                                env=clean)
        self.assert_bad_input(result, "palpa prepare")

    def test_own_scenes_go_by_name(self):
        self.assertIn("Two waters in space", self.palpa("run", "water/space", "--headless",
                                                       "--seconds", "0.1").stdout)
        # What is there under that name comes first.
        shutil.copytree(WATER, self.tmp / "water")
        file = self.tmp / "water" / "scene.toml"
        file.write_text(file.read_text().replace("Two waters", "My waters"))
        self.assertIn("My waters", self.palpa("run", "water", "--headless", "--seconds",
                                              "0.1").stdout)

    def test_what_is_no_scene_leads_to_one(self):
        (self.tmp / "1abc.pdb").write_text("END\n")
        self.assert_bad_input(self.palpa("run", "1abc.pdb"), "is a structure, not a scene",
                              "palpa prepare 1abc.pdb -o 1abc'")
        self.assert_bad_input(self.palpa("run", "."), "no scene.toml", "palpa prepare ./1abc.pdb")
        shutil.copytree(WATER, self.tmp / "mine")
        self.assert_bad_input(self.palpa("run", "."), "scenes below it: ./mine/scene.toml")
        (self.tmp / "other").mkdir()
        self.assert_bad_input(self.palpa("run", "other"), "scenes near it: ", "mine/scene.toml")
        (self.tmp / "hiv").mkdir()  # hides Palpa's own
        self.assert_bad_input(self.palpa("run", "hiv"), "Palpa's own scene of that name: ",
                              "hiv/scene.toml")
        (self.tmp / "other" / "empty").mkdir()
        self.assert_bad_input(self.palpa("run", "other/empty"), "Palpa's own scenes: ", "water")
        for name, said in (("my protein.PDB", 'palpa prepare "my protein.PDB" -o "my protein"'),
                           ("a.psf", "is a topology, not a scene"),
                           ("1abc.pdb.gz", "palpa prepare 1abc.pdb.gz -o 1abc"),
                           ("1abc.tar.gz", "is compressed")):
            (self.tmp / name).write_text("END\n")
            self.assert_bad_input(self.palpa("run", name), said)
            if name == "1abc.tar.gz":
                self.assert_bad_input(self.palpa(name), "unknown command", said)

    def test_an_error_cites_what_was_typed(self):
        for arguments in (["--mode", "7"], ["--mode=7"]):
            self.assert_bad_input(self.palpa("run", WATER, *arguments), "--mode 7: ")
        self.assert_bad_input(self.palpa("run", WATER, "--set", "coupling.mode=7"),
                              "--set coupling.mode=7: ")
        result = self.palpa("run", WATER, "--headless", "--device", "mouse")
        self.assertTrue(result.stderr.startswith("--device mouse: "), result.stderr)

    def test_a_terminal_shows_how_far_a_run_is(self):
        run = [PROGRAM, "run", WATER, "--headless", "--seconds", "2", "--record", self.tmp / "r"]
        replay = [PROGRAM, "replay", self.tmp / "r", "--verify"]
        for command in (run, replay):
            code, text = run_on_terminal(command)
            self.assertEqual(code, 0)
            self.assertRegex(text, r"playing +\d+ %")
            self.assertRegex(text, r"\r +\r$")  # the line is wiped
        self.assertEqual(run_on_terminal([*replay, "--json"]), (0, ""))

    def test_every_command_has_help(self):
        for arguments in (["--help"], ["run", "--help"], ["--version"], ["help", "keys"]):
            with self.subTest(arguments=arguments):
                result = self.palpa(*arguments)
                self.assertEqual(result.returncode, 0)
                self.assertTrue(result.stdout.strip())

    def test_wrong_usage_is_bad_input(self):
        for arguments, said in ((["fly"], "palpa: unknown command 'fly'"),
                                (["run"], "palpa run: a scene is required; 'palpa' alone lists"),
                                (["run", WATER, "--speed", "3"], "palpa run: unknown option '--speed'"),
                                (["run", WATER, WATER], "unexpected argument"),
                                (["prepare", "a.pdb", "-o", "x", "--model", "two"],
                                 "--model: 'two' is not a number"),
                                (["prepare", "--without", "MK1", "1abc.pdb", "--toppar", "a.rtf", "-o",
                                  "x"],
                                 "a structure file is required; write it before options"),
                                (["run", WATER, "--mode"], "palpa run: the option --mode needs a value;"),
                                (["--speed"], "palpa: unknown option '--speed' without a command"),
                                (["help", "fly"], "palpa: unknown command 'fly'"),
                                (["report"], "'palpa report' is 'palpa-lab report' now, which tools/build makes"),
                                (["help", "bench"], "'palpa bench' is 'palpa-lab bench' now"),
                                (["scene", "view"], "'palpa scene' is 'palpa help' now")):
            with self.subTest(arguments=arguments):
                self.assert_bad_input(self.palpa(*arguments), said)

    def test_a_seed_is_a_whole_number_that_fits(self):
        for command in ("study", "run"):
            for seed in ("-1", "99999999999999999999", "1.5", "one"):
                with self.subTest(command=command, seed=seed):
                    self.assert_bad_input(self.palpa(command, WATER, "--seed", seed), "seed")

    # ---- running

    def test_guarded_coupling_is_the_default(self):
        self.assertIn("mode guarded", self.run_water("--seconds", "0.1").stdout)
        self.assertIn("mode 2", self.run_water("--seconds", "0.1", "--mode", "2").stdout)

    def test_laws_that_cannot_be_calibrated_are_refused(self):
        result = self.palpa("run", WATER, "--headless", "--set", "coupling.force_law=calibrated",
                            "--set", "coupling.F_0_nN=0")
        self.assert_bad_input(result, "force_law", "cannot have the slopes")

    def test_the_options_are_the_scene_keys_they_name(self):
        by_option = self.run_water("--seconds", "0.5", "--mode", "3", "--period-ms", "14", "--hand",
                                   "firm", "--friction", "0.1", "--seed", "5", "--json")
        by_key = self.run_water("--set", "run.seconds=0.5", "--set", "mode=3", "--set",
                                "run.period_ms=14", "--set", "hand.grip=firm", "--set",
                                "friction_N=0.1", "--set", "seed=5", "--json")
        first, second = json.loads(by_option.stdout), json.loads(by_key.stdout)
        for summary in (first, second):
            for key in ("step_median_us", "step_p99_us"):
                del summary[key]
        self.assertEqual(first, second)
        self.assertEqual(first["steps"], 36)

    def test_the_plain_loop_at_14_ms_oscillates(self):
        summary = json.loads(self.run_water(
            "--mode", "2", "--period-ms", "14", "--friction", "0", "--hand", "medium", "--set",
            "stroke=hold", "--set", "kick_N_s=0.005", "--json").stdout)
        self.assertAlmostEqual(summary["ripple_N"], 1.08, delta=0.1)
        self.assertAlmostEqual(summary["ripple_Hz"], 6.6, delta=0.4)
        self.assertTrue(any("vibrates" in warning for warning in summary["warnings"]))

    def test_the_same_command_twice_and_its_session_give_the_same_bytes(self):
        for name in ("a", "b"):
            self.run_water("--mode", "1", "--period-ms", "14", "--seconds", "4", "--record",
                           self.tmp / name)
        again = self.palpa("run", self.tmp / "a" / "session.toml", "--headless", "--record",
                           self.tmp / "c")
        self.assertEqual(again.returncode, 0, again.stderr)
        traces = [(self.tmp / name / "trace.csv").read_bytes() for name in "abc"]
        self.assertEqual(traces[0], traces[1])
        self.assertEqual(traces[0], traces[2])

    def test_a_recording_can_be_moved_and_run_again(self):
        self.run_water("--seconds", "0.2", "--record", self.tmp / "first")
        trace = (self.tmp / "first" / "trace.csv").read_bytes()
        shutil.move(self.tmp / "first", self.tmp / "elsewhere")
        result = self.palpa("run", "elsewhere/session.toml", "--headless", "--record", "again")
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertEqual((self.tmp / "again" / "trace.csv").read_bytes(), trace)

    def test_check_only_checks(self):
        result = self.palpa("run", "--check", WATER, "--record", self.tmp / "none")
        self.assertEqual(result.returncode, 0)
        self.assertIn("no problems", result.stdout)
        self.assertFalse((self.tmp / "none").exists())

    def test_every_thins_the_trace(self):
        self.run_water("--seconds", "0.1", "--every", "10", "--record", self.tmp / "thin")
        rows = (self.tmp / "thin" / "trace.csv").read_text().splitlines()
        self.assertEqual([row.split(",")[0] for row in rows[:4]], ["time_s", "0", "0.01", "0.02"])
        self.assertEqual(len(rows), 11)

    def test_an_assembly_that_is_not_there(self):
        arguments = ("prepare", WATER / "dimer.crd", "--toppar", WATER / "tip3p.str", "-o", "out",
                     "--assembly")
        self.assert_bad_input(self.palpa(*arguments, "1"), "dimer.crd: no assembly 1")
        self.assert_bad_input(self.palpa(*arguments, "0"), "--assembly: '0' is not a number from 1")
        self.assertFalse((self.tmp / "out").exists())

    def test_check_tells_what_the_line_is_like(self):
        result = self.palpa("run", "--check", WATER)
        for text in ("-6.594 kcal/mol at 2.767 Å, 29.3 N/m", "0.322 nN at 3.10 Å, felt as 0.896 N",
                     "3 nN at 2.473 Å, felt as 2.120 N", "200 N/m on the hand at"):
            self.assertIn(text, result.stdout)
        in_space = self.palpa("run", "--check", ROOT / "scenes" / "hiv").stdout
        self.assertIn("5 nN at x = -0.300 Å", in_space)  # a place on a line, which is no distance
        self.assertNotIn("repulsion", in_space)
        self.assertIn("663 N/m on the hand at 2.760 Å",
                      self.palpa("run", "--check", WATER, "--mode", "2").stdout)
        self.assertIn("vibrates", self.palpa("run", "--check", WATER, "--mode", "1").stdout)

    def test_lost_output_is_no_success(self):
        for arguments in (["run", WATER, "--headless", "--seconds", "0.1"], ["help", "keys"],
                          ["help", "run"], ["run", "--help"]):
            with self.subTest(arguments=arguments), open("/dev/full", "w") as full:
                result = subprocess.run([PROGRAM, *map(str, arguments)], stdout=full,
                                        stderr=subprocess.PIPE, text=True)
                self.assertEqual(result.returncode, 2)
                self.assertIn("the output cannot be written", result.stderr)

    # ---- bad input: one line, exit code 2, nothing half-written

    def test_a_scene_that_is_not_there(self):
        self.assert_bad_input(self.palpa("run", "nowhere"), "nowhere: no such scene")
        (self.tmp / "folder").mkdir()
        self.assert_bad_input(self.palpa("run", "folder"), "folder: ", "no scene.toml")

    def test_an_empty_scene(self):
        (self.tmp / "empty.toml").write_text("")
        self.assert_bad_input(self.palpa("run", "empty.toml"), "empty.toml:1:1: ", "molecules")

    def test_values_that_are_no_numbers(self):
        scene = self.copy_of_water()
        file = scene / "scene.toml"
        text = file.read_text()
        for value in ("nan", "inf", '"fast"', "-1.0", "1.0.0"):
            with self.subTest(value=value):
                file.write_text(text.replace("seconds = 10.0", f"seconds = {value}"))
                line = text[:text.index("seconds =")].count("\n") + 1
                result = self.palpa("run", scene, "--headless", "--record", self.tmp / "r")
                self.assert_bad_input(result, f"scene.toml:{line}:")
                self.assertFalse((self.tmp / "r").exists())

    def test_a_misspelt_key_gets_the_near_name(self):
        scene = self.copy_of_water()
        file = scene / "scene.toml"
        file.write_text(file.read_text().replace("peak_nN", "peak_Nn"))
        self.assert_bad_input(self.palpa("run", "--check", scene), "scene.toml:33:1: ",
                              "unknown key 'hand.peak_Nn'; did you mean 'peak_nN'?")

    def test_a_parameter_file_without_the_type(self):
        scene = self.copy_of_water()
        file = scene / "tip3p.str"
        file.write_text("".join(line for line in file.read_text().splitlines(True)
                                if not line.startswith("HT ")))
        result = self.palpa("run", scene, "--headless", "--record", self.tmp / "r")
        self.assert_bad_input(result, "tip3p.str:", "'HT' has no NONBONDED parameters")
        self.assertRegex(result.stderr, r"tip3p\.str:\d+: ")
        self.assertFalse((self.tmp / "r").exists())

    def test_a_coordinate_that_is_no_number(self):
        scene = self.copy_of_water()
        file = scene / "dimer.crd"
        file.write_text(file.read_text().replace("0.7569500000", "0.75x9500000", 1))
        self.assert_bad_input(self.palpa("run", scene), "dimer.crd:7:", "'0.75x9500000'")

    def test_a_folder_that_cannot_be_written(self):
        (self.tmp / "file").write_text("mine")
        self.assert_bad_input(self.palpa("run", WATER, "--headless", "--record", self.tmp / "file" / "r"), "file")
        self.assert_bad_input(self.palpa("run", WATER, "--headless", "--record", self.tmp / "file"), "is a file")
        self.assert_bad_input(self.palpa("run", WATER, "--headless", "--record", "/proc/palpa"), "/proc/palpa")
        self.assertEqual((self.tmp / "file").read_text(), "mine")

    def test_a_folder_with_other_things_is_not_recorded_into(self):
        (self.tmp / "mine").mkdir()
        (self.tmp / "mine" / "trace.csv").write_text("not a recording's")
        self.assert_bad_input(self.palpa("run", WATER, "--headless", "--record", self.tmp / "mine"), "mine")
        self.assertEqual((self.tmp / "mine" / "trace.csv").read_text(), "not a recording's")

    def test_settings_that_name_nothing(self):
        for setting, expected in (("speed=3", "no scene key"), ("hand.strok=hold", "unknown key"),
                                  ("seconds", "KEY=VALUE"), ("mode=six", "expected one of"),
                                  ("hand.grip=[1", "not valid TOML")):
            with self.subTest(setting=setting):
                self.assert_bad_input(self.palpa("run", WATER, "--set", setting), "--set", expected)

    def test_sound_without_a_window(self):
        self.assert_bad_input(self.palpa("run", WATER, "--headless", "--sound"), "--sound",
                             "needs a window")

    def test_no_message_names_a_place_in_our_sources(self):
        result = self.palpa("run", "nowhere")
        self.assertIsNone(re.search(r"\.cpp|\.h:", result.stderr))


if __name__ == "__main__":
    unittest.main()
