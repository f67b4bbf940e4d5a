"""palpa replay --verify from outside: whole recordings, cut ones, and ones that were tampered with."""
import gzip
import json
import os
import signal
import subprocess
import tempfile
import time
import unittest
from pathlib import Path

PROGRAM = os.environ["PALPA_PROGRAM"]
ROOT = Path(os.environ["PALPA_ROOT"])
WATER = ROOT / "scenes" / "water"


def palpa(*arguments, kernels=None):
    chosen = {"PALPA_KERNELS": kernels} if kernels else {}
    return subprocess.run([PROGRAM, *map(str, arguments)], capture_output=True, text=True,
                          stdin=subprocess.DEVNULL, env={**os.environ, **chosen})


class Replay(unittest.TestCase):
    def setUp(self):
        temporary = tempfile.TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        self.folder = Path(temporary.name) / "recording"
        self.trace = self.folder / "trace.csv"

    def record(self, *arguments, kernels=None):
        result = palpa("run", "--headless", "--overwrite", "--record", self.folder, *arguments, kernels=kernels)
        self.assertEqual(result.returncode, 0, result.stderr)

    def verify(self, kernels=None):
        result = palpa("replay", self.folder, "--verify", "--json", kernels=kernels)
        return result.returncode, json.loads(result.stdout)

    def test_a_recording_is_found_again_to_the_last_digit(self):
        for arguments in (["--seconds", "1.5", WATER],
                          ["--seconds", "1", "--mode", "1", "--period-ms", "14", "--every", "7", WATER],
                          ["--seconds", "2", WATER / "space.toml"],
                          ["--seconds", "3", WATER / "two-hands.toml"]):
            with self.subTest(arguments=arguments):
                self.record(*arguments)
                code, report = self.verify()
                self.assertEqual(code, 0)
                self.assertEqual(report["different"], 0)
                self.assertEqual(report["compared"], len(self.trace.read_text().splitlines()) - 1)

    def test_a_compressed_recording_is_found_again_and_a_damaged_one_is_named(self):
        self.record("--seconds", "1", "--compress", WATER)
        packed = self.trace.with_name("trace.csv.gz")
        self.assertEqual(sorted(file.name for file in self.folder.glob("trace*")), ["trace.csv.gz"])
        whole = packed.read_bytes()
        text = gzip.decompress(whole)
        code, report = self.verify()
        self.assertEqual((code, report["different"]), (0, 0))
        self.assertEqual(report["compared"], text.count(b"\n") - 1)
        plain = self.folder.with_name("plain")
        for arguments in ((WATER, "--seconds", "1"), (self.folder / "session.toml",),
                          (WATER, "--seconds", "1", "--device", f"replay:{self.folder}")):
            recorded = palpa("run", *arguments, "--headless", "--overwrite", "--record", plain)
            self.assertEqual(recorded.returncode, 0, recorded.stderr)
            if "--device" not in arguments:
                self.assertEqual((plain / "trace.csv").read_bytes(), text)
        for data, said in ((whole[:len(whole) // 2], "is cut off"), (whole[:2], "trace.csv.gz"),
                           (whole[:1000] + b"?" * 100 + whole[1100:], "is damaged"),
                           (gzip.compress(b"0" * (1 << 20)) * 1025, "holds more than 1024 MiB")):
            with self.subTest(said=said):
                packed.write_bytes(data)
                for arguments in (("replay", self.folder, "--verify"),
                                  ("run", WATER, "--headless", "--device", f"replay:{self.folder}")):
                    refused = palpa(*arguments)
                    self.assertEqual(refused.returncode, 2, refused.stdout)
                    self.assertIn("trace.csv.gz", refused.stderr)
                    self.assertIn(said, refused.stderr)
        packed.write_bytes(whole)
        self.record("--seconds", "0.1", WATER)  # in its place
        self.assertFalse(packed.exists())
        self.assertEqual(self.verify()[0], 0)

    def test_what_has_no_recording_or_no_journal_is_refused(self):
        for arguments in (("run", WATER, "--headless", "--compress"), ("run", WATER, "--compress")):
            refused = palpa(*arguments)
            self.assertEqual(refused.returncode, 2)
            self.assertIn("--compress: needs a recording; expected --record FOLDER with it", refused.stderr)
        self.record("--seconds", "0.1", WATER)
        refused = palpa("replay", self.folder, "--trajectory-fps", "25")
        self.assertEqual(refused.returncode, 2)
        self.assertIn("has no journal", refused.stderr)

    def test_a_recording_is_played_with_its_own_kernels_unless_others_are_chosen(self):
        best = palpa("--version").stdout.partition("processor  ")[2].split()[0]
        self.record("--seconds", "1", WATER, kernels="SCALAR")
        self.assertIn("on a processor of kind SCALAR.\n", (self.folder / "session.toml").read_text())
        self.assertIn("processor  SCALAR kernels", palpa("--version", kernels="SCALAR").stdout)
        self.assertEqual(self.verify(), (0, self.verify("SCALAR")[1]))
        self.assertEqual(self.verify(best)[0], 0 if best == "SCALAR" else 1)
        unknown = palpa("run", WATER, "--headless", kernels="MMX")
        self.assertEqual(unknown.returncode, 2)
        self.assertIn("PALPA_KERNELS: 'MMX' is no kind of kernels here; expected ", unknown.stderr)
        self.assertIn("SCALAR", unknown.stderr)

    def test_one_that_was_cut_off_is_readable_as_far_as_it_goes(self):
        self.record("--seconds", "1", WATER)
        whole = self.trace.read_bytes()
        (self.folder / "summary.json").unlink()
        self.trace.write_bytes(whole[:len(whole) // 2])
        code, report = self.verify()
        self.assertEqual((code, report["different"], report["cut_off"]), (0, 0, True))
        self.assertGreater(report["compared"], 400)
        self.assertLess(report["compared"], 600)

    def test_a_program_that_is_killed_leaves_what_it_wrote(self):
        running = subprocess.Popen([PROGRAM, "run", "--headless", "--record", self.folder,
                                    "--seconds", "100000", WATER], stdout=subprocess.DEVNULL,
                                   stderr=subprocess.DEVNULL)
        while not self.trace.exists() or self.trace.stat().st_size < 300_000:
            self.assertIsNone(running.poll())
            time.sleep(0.01)
        running.send_signal(signal.SIGKILL)
        running.wait()
        code, report = self.verify()
        self.assertEqual((code, report["different"], report["cut_off"]), (0, 0, True))
        self.assertGreater(report["compared"], 500)
        self.assertEqual(report["session_s"], 100000)
        self.assertAlmostEqual(report["recorded_s"], report["compared"] * 1e-3)

    def test_one_that_was_cut_at_the_end_of_a_line_is_told_from_a_whole_one(self):
        self.record("--seconds", "1", "--every", "3", WATER)
        lines = self.trace.read_text().splitlines(keepends=True)
        self.assertEqual(len(lines), 1 + 334)
        self.assertFalse(self.verify()[1]["cut_off"])
        self.trace.write_text("".join(lines[:1 + 100]))
        code, report = self.verify()
        self.assertEqual((code, report["compared"], report["cut_off"]), (0, 100, True))
        self.assertAlmostEqual(report["recorded_s"], 0.3)
        told = palpa("replay", self.folder, "--verify").stdout
        self.assertIn("0.3 of 1 s were recorded", told)

    def test_a_row_too_many_is_told(self):
        self.record("--seconds", "0.2", WATER)
        lines = self.trace.read_text().splitlines(keepends=True)
        self.trace.write_text("".join(lines + lines[-1:]))
        code, report = self.verify()
        self.assertEqual((code, report["different"], report["surplus"]), (1, 0, 1))
        self.assertFalse(report["cut_off"])
        told = palpa("replay", self.folder, "--verify").stdout
        self.assertIn("rows after the end of the session: 1", told)

    def test_columns_too_many_or_too_few_are_told(self):
        self.record("--seconds", "0.2", WATER)
        lines = self.trace.read_text().splitlines(keepends=True)
        columns = len(lines[0].split(","))
        for row, has in ((lines[50].rstrip("\n") + ",7\n", columns + 1),
                         (lines[50].rstrip("\n") + ",\n", columns + 1),
                         (lines[50].rpartition(",")[0] + "\n", columns - 1)):
            with self.subTest(row=row):
                self.trace.write_text("".join(lines[:50] + [row] + lines[51:]))
                code, report = self.verify()
                self.assertEqual((code, report["different"]), (1, 1))
                self.assertEqual(report["first"]["row"], 50)
                self.assertEqual(report["first"]["column"], "number of columns")
                self.assertEqual((report["first"]["recorded"], report["first"]["played"]),
                                 (str(has), str(columns)))
                told = palpa("replay", self.folder, "--verify").stdout
                self.assertNotIn("all identical", told)

    def test_recordings_state_their_format_and_newer_ones_are_refused_or_noted(self):
        self.record("--seconds", "0.1", WATER)
        session = self.folder / "session.toml"
        text, line = session.read_text(), "# Recording format 2.1\n"
        self.assertEqual(text.count(line), 1)
        self.assertIn('\nformat = "2.2"\n', text)
        versions = json.loads((self.folder / "summary.json").read_text())["versions"]
        self.assertEqual((versions["scene_format"], versions["recording_format"]), ("2.2", "2.1"))
        session.write_text(text.replace(line, "# Recording format 3.0\n"))
        refused = palpa("replay", self.folder, "--verify")
        self.assertEqual(refused.returncode, 2)
        self.assertIn("recording format 3.0 is newer than this program", refused.stderr)
        session.write_text(text.replace(line, ""))
        refused = palpa("replay", self.folder, "--verify")
        self.assertEqual(refused.returncode, 2)
        self.assertIn("recording format 1.0 is older than this program reads", refused.stderr)
        for stated in ("banana", "99999999999999999999"):
            session.write_text(text.replace(line, f"# Recording format {stated}\n"))
            refused = palpa("replay", self.folder, "--verify")
            self.assertEqual(refused.returncode, 2)
            number = text.splitlines().index(line.strip()) + 1
            self.assertIn(f"session.toml:{number}: '{stated}' is not the number of a recording's format", refused.stderr)
        session.write_text(text.replace('format = "2.2"', 'format = "3.1"'))
        refused = palpa("run", session, "--headless")
        self.assertEqual(refused.returncode, 2)
        self.assertIn("scene format 3.1 is newer than this program", refused.stderr)
        session.write_text(text.replace(line, "# Recording format 2.5\n"))
        noted = palpa("replay", self.folder, "--verify")
        self.assertEqual(noted.returncode, 0, noted.stderr)
        self.assertIn("note: ", noted.stderr)
        self.assertIn("recording format 2.5 is newer than 2.1", noted.stderr)

    def test_a_force_that_was_another_is_told_with_its_place(self):
        self.record("--seconds", "1", WATER)
        lines = self.trace.read_text().splitlines(keepends=True)
        column = lines[0].split(",").index("device_force_x_N")
        row = lines[500].split(",")
        row[column] = repr(float(row[column]) + 0.25)
        lines[500] = ",".join(row)
        self.trace.write_text("".join(lines))
        code, report = self.verify()
        self.assertEqual((code, report["different"]), (1, 1))
        self.assertEqual((report["first"]["row"], report["first"]["column"]),
                         (500, "device_force_x_N"))
        self.assertAlmostEqual(report["largest_N"], 0.25)

    def test_what_cannot_be_verified_is_refused(self):
        self.record("--seconds", "0.2", WATER)
        session = self.folder / "session.toml"
        text = session.read_text()
        session.write_text(text.replace("[statics]\n", "[statics]\nbudget_us = 5000.0\n"))
        result = palpa("replay", self.folder, "--verify")
        self.assertEqual(result.returncode, 2)
        self.assertIn("depends on the speed of the machine", result.stderr)
        session.write_text(text)
        self.trace.write_text("time_s,handle_x_m\n0,0\n")
        result = palpa("replay", self.folder, "--verify")
        self.assertEqual(result.returncode, 2)
        self.assertIn("lacks the column", result.stderr)
        result = palpa("replay", ROOT / "scenes", "--verify")
        self.assertEqual(result.returncode, 2)
        self.assertIn("has no session.toml", result.stderr)


if __name__ == "__main__":
    unittest.main()
