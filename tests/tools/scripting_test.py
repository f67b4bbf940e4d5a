"""palpa run --commands from outside: the example of the page, answers that repeat, recordings, ends."""
import json
import os
import re
import signal
import subprocess
import tempfile
import unittest
from pathlib import Path

PROGRAM = os.environ["PALPA_PROGRAM"]
ROOT = Path(os.environ["PALPA_ROOT"])
WATER = ROOT / "scenes" / "water"
EDITS = ((0.5, 'add = { residue = "TIP3", name = "third", at_angstrom = [5.0, 3.0, 0.0] }'),
         (0.5, 'coupling = { mode = "4" }'), (1.0, 'remove = "third"'), (1.2, "let_go = true"))


class Scripting(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)

    def play(self, text, *options, scene=WATER):
        return subprocess.run([PROGRAM, "run", str(scene), "--headless", *map(str, options)],
                              input=text.encode(), capture_output=True, check=False,
                              cwd=self.folder, timeout=120)

    def script(self, text, *options, scene=WATER):
        result = self.play(text, "--commands", *options, scene=scene)
        return result, [json.loads(line) for line in result.stdout.splitlines()]

    def count_ticks(self, recording):
        return (self.folder / recording / "trace.csv").read_bytes().count(b"\n") - 1

    def test_the_example_of_the_page_runs(self):
        (example,) = re.findall(r"```python\n(.*?)```", (ROOT / "tools" / "scripting.md").read_text(), re.S)
        result = subprocess.run(["python3", "-c", example.replace('"palpa"', repr(PROGRAM))], cwd=self.folder,
                                capture_output=True, text=True, check=False, timeout=120)
        self.assertEqual(result.returncode, 0, result.stderr)
        rows = [line.split(" ", 2) for line in result.stdout.splitlines()]
        self.assertEqual([row[0] for row in rows], ["40", "30", "20", "10", "0"])
        self.assertLess(float(rows[-1][1]), float(rows[0][1]))

    def test_save_replaces_own_files_alone_and_only_with_overwrite(self):
        (self.folder / "mine.pdb").write_text("not from this program\n")
        lines = 'save = "now.pdb"\nsave = "mine.pdb"\n'
        for options, expected in (((), [True, False]), ((), [False, False]), (("--overwrite",), [True, False])):
            _, answers = self.script(lines, *options)
            self.assertEqual([answer["ok"] for answer in answers], expected)
        self.assertEqual((self.folder / "mine.pdb").read_text(), "not from this program\n")

    def test_a_recording_is_that_of_the_same_edits(self):
        lines, before = [], 0
        for at_s, edit in EDITS:
            if at_s > before:
                lines.append(f"run = {at_s - before}")
            lines.append(edit)
            before = at_s
        text = "\n".join([*lines, "run = 0.3"])
        edited = self.folder / "scene.toml"
        edited.write_text((WATER / "scene.toml").read_text() +
                          "".join(f"[[edits]]\nat_s = {at_s}\n{edit}\n" for at_s, edit in EDITS))
        (self.folder / "tip3p.str").write_bytes((WATER / "tip3p.str").read_bytes())
        (self.folder / "dimer.crd").write_bytes((WATER / "dimer.crd").read_bytes())

        # The stroke is planned for the same time.
        scripted, answers = self.script(text, "--record", "scripted", "--seconds", 1.501)
        played = self.play("", "--record", "played", "--seconds", 1.501, scene=edited)

        self.assertEqual((scripted.returncode, played.returncode), (0, 0), scripted.stderr + played.stderr)
        self.assertTrue(all(answer["ok"] for answer in answers))
        self.assertEqual(len(answers), len(lines) + 1)
        trace = (self.folder / "scripted" / "trace.csv").read_bytes()
        self.assertEqual(trace, (self.folder / "played" / "trace.csv").read_bytes())
        self.assertEqual(trace.count(b"\n"), 1502)
        replayed = subprocess.run([PROGRAM, "replay", "scripted"], cwd=self.folder, capture_output=True, text=True,
                                  check=False)
        self.assertEqual(replayed.returncode, 2)
        self.assertIn("--commands", replayed.stderr)
        # It begins again from its session.
        again, same = self.script(text, "--record", "again", scene=self.folder / "scripted" / "session.toml")
        self.assertEqual(again.returncode, 0, again.stderr)
        self.assertEqual(same, answers)
        self.assertEqual(trace, (self.folder / "again" / "trace.csv").read_bytes())

    def test_the_same_lines_give_the_same_bytes(self):
        text = "run 1\nread\nhand_mm = [5, 0, 0]\nrun 1\nread = \"water\"\nstep 3\nread"
        first, answers = self.script(text)
        self.assertEqual(first.returncode, 0, first.stderr)
        self.assertEqual(first.stdout, self.script(text)[0].stdout)
        self.assertEqual(answers[4]["atoms"], 6)
        self.assertEqual(len(answers[4]["places_angstrom"]), 6)

    def test_what_is_refused_is_told_and_the_rest_goes_on(self):
        long = "read = \"" + "x" * 200000 + "\""
        result, answers = self.script("\n".join(["# nothing", "jump", "step 2", long, b"\x00\x01".decode(), "",
                                                 "hand_mm = 3", "read"]) + "\n")
        self.assertEqual(result.returncode, 1)
        self.assertEqual([answer["ok"] for answer in answers], [False, True, False, False, False, True])
        self.assertEqual([answer["line"] for answer in answers if not answer["ok"]], [2, 4, 5, 7])
        self.assertIn("65536", answers[2]["error"])
        self.assertEqual(answers[5]["time_s"], answers[1]["time_s"])

    def test_the_hand_that_is_not_there_cannot_be_led(self):
        _, answers = self.script("hand_mm = [1, 0, 0]", "--set", "hand.grip=none", "--set", "hand.stroke=hold")
        self.assertIn("nobody holds the handle", answers[0]["error"])
        script = self.folder / "way.csv"
        script.write_text("time_s,handle_x_m,handle_y_m,handle_z_m\n0,0,0,0\n1,0.01,0,0\n")
        result, answers = self.script("hand_mm = [1, 0, 0]", "--device", f"script:{script}")
        self.assertEqual(result.returncode, 1, result.stderr)
        self.assertIn("another device", answers[0]["error"])

    def test_no_input_is_a_run_of_one_tick(self):
        result, answers = self.script("", "--record", "empty")
        self.assertEqual((result.returncode, answers), (0, []))
        self.assertEqual(self.count_ticks("empty"), 1)

    def test_options_that_contradict_it(self):
        for options, said in ((["--commands", "--json", "--headless"], "--json"), (["--commands"], "--headless")):
            result = subprocess.run([PROGRAM, "run", str(WATER), *options], stdin=subprocess.DEVNULL,
                                    capture_output=True, text=True, check=False)
            self.assertEqual(result.returncode, 2)
            self.assertIn(said, result.stderr)

    @unittest.skipIf(os.name == "nt", "signals of POSIX")
    def test_a_signal_ends_it_while_it_waits(self):
        with subprocess.Popen([PROGRAM, "run", str(WATER), "--headless", "--commands", "--record", "cut"],
                              cwd=self.folder, stdin=subprocess.PIPE, stdout=subprocess.PIPE,
                              stderr=subprocess.DEVNULL) as program:
            program.stdin.write(b"run 0.5\n")
            program.stdin.flush()
            self.assertTrue(json.loads(program.stdout.readline())["ok"])
            program.send_signal(signal.SIGTERM)
            self.assertEqual(program.wait(timeout=60), 128 + signal.SIGTERM)
        self.assertTrue((self.folder / "cut" / "summary.json").exists())
        self.assertEqual(self.count_ticks("cut"), 501)


if __name__ == "__main__":
    unittest.main()
