"""tools/lab/scripts/soak: what it finds in known rows, what it goes on with, and three seconds of a scene."""
import contextlib
import csv
import importlib.machinery
import importlib.util
import io
import os
import shutil
import subprocess
import tempfile
import unittest
from pathlib import Path

ROOT = Path(os.environ["PALPA_ROOT"])
SCRIPT = ROOT / "tools" / "lab" / "scripts" / "soak"


def load():
    loader = importlib.machinery.SourceFileLoader("soak", str(SCRIPT))
    module = importlib.util.module_from_spec(importlib.util.spec_from_loader("soak", loader))
    loader.exec_module(module)
    return module


soak = load()


def sample(wall_s, memory_MB, files=5, part=1):
    return {"part": part, "wall_s": wall_s, "load": 1.0, "memory_kB": 1024 * memory_MB, "files": files, "threads": 1,
            "processor_s": 0.0}


def second(servo_s, energy_J, step_us=10.0, overruns=0, held_back=0.0):
    return {"servo_s": servo_s, "steps": 100, "step_median_us": step_us, "step_p99_us": 2 * step_us, "overruns": overruns,
            "held_back_share": held_back, "hand_energy_J": energy_J, "potential_kcal_per_mol": -0.5 * servo_s}


class Soak(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)

    def test_growth_is_that_of_the_second_half(self):
        # 100 MB at once, then 6 MB a minute.
        samples = [sample(60 * i, (100 if i > 0 else 0) + 6 * i, files=5 + i // 50) for i in range(101)]
        numbers = soak.judge(samples, [second(1, 0.0)], [])
        self.assertAlmostEqual(numbers["growth_MB_per_h"], 360, places=6)
        self.assertEqual(numbers["memory_MB"], [400, 700])
        self.assertEqual(numbers["files"], [6, 7])
        steady = soak.judge([sample(60 * i, 80) for i in range(50)], [second(1, 0.0)], [])
        self.assertEqual(steady["growth_MB_per_h"], 0)

    def test_steps_ticks_and_work_of_cycles(self):
        # 2 mJ lost in each cycle of 7 s, but 3 mJ gained in the third, and 50 in the last, in which the force was held
        # back for a while; steps take three times as long at the end.
        ends = [0, -2, -4, -1, -3, 47]
        rows = [second(s, 1e-3 * ends[s // 7] if s % 7 == 0 else 9.0, 10 if s < 20 else 30, 1 if s == 10 else 0,
                       0.5 if s == 30 else 0.0)
                for s in range(7, 36)]
        cycles = soak.works_of_cycles(rows, 7.0)
        self.assertEqual([at for at, *_ in cycles], [14, 21, 28, 35])
        for (_, work, *_), expected in zip(cycles, (-2e-3, 3e-3, -2e-3, 50e-3)):
            self.assertAlmostEqual(work, expected)
        self.assertEqual([energy for _, _, energy, _ in cycles], [-7, -10.5, -14, -17.5])
        self.assertEqual([is_whole for *_, is_whole in cycles], [True, True, True, False])
        numbers = soak.judge([sample(1, 1)], rows, cycles)
        self.assertEqual(numbers["step_us"], [10, 30])
        self.assertEqual(numbers["missed"], 1)
        self.assertEqual(numbers["cycles"], [4, 3])
        self.assertAlmostEqual(numbers["most_work_mJ"], 3)
        self.assertAlmostEqual(numbers["work_mJ"][0], -2)
        self.assertAlmostEqual(numbers["held_back_percent"], 50 / 29)

    def test_a_run_that_was_cut_off_goes_on_for_the_time_that_is_left(self):
        (self.folder / "water-window.csv").write_text(
            ",".join(soak.SAMPLES) + "\n1,5.0,1,100,5,1,0.1\n1,10.0,1,100,5,1,0.2\n1,15.0,1,1")  # the last is half
        run = soak.Run(self.folder, "water", True, 60.0, "640x400")
        self.assertEqual((run.part, run.done_s, run.left_s), (2, 10.0, 50.0))
        command = " ".join(run.command())
        self.assertIn("water-window-2.csv", command)
        self.assertIn("--after 50.0", command)

    def test_three_seconds_without_a_window_and_two_more(self):
        def play(minutes):
            return subprocess.run([str(SCRIPT), str(self.folder), "--scene", "water", "--minutes", str(minutes),
                                   "--every", "0.5"], capture_output=True, text=True, stdin=subprocess.DEVNULL)

        self.assertEqual(play(0.05).returncode, 0)
        result = play(0.08)
        self.assertEqual(result.returncode, 0, result.stderr)
        with open(self.folder / "water-headless.csv", encoding="utf-8", newline="") as file:
            rows = list(csv.DictReader(file))
        self.assertEqual(list(rows[0]), soak.SAMPLES)
        self.assertEqual({row["part"] for row in rows}, {"1", "2"})
        walls = [float(row["wall_s"]) for row in rows]
        self.assertEqual(walls, sorted(walls))
        self.assertTrue(all(float(row["memory_kB"]) > 1000 and float(row["files"]) >= 3 for row in rows))
        self.assertTrue((self.folder / "water-headless-2.csv").is_file())
        self.assertIn("| | water, headless |", result.stdout)
        if shutil.which("gnuplot"):
            self.assertEqual((self.folder / "soak.png").read_bytes()[:8], b"\x89PNG\r\n\x1a\n")

    def test_an_empty_folder_is_told(self):
        with contextlib.redirect_stderr(io.StringIO()) as told:
            self.assertEqual(soak.show(self.folder), 2)
        self.assertIn("holds no run", told.getvalue())


if __name__ == "__main__":
    unittest.main()
