"""How late the servo wakes: palpa devices --wake-up and its check of this machine, and tools/lab/scripts/wake_up."""
import json
import os
import shutil
import subprocess
import tempfile
import unittest
from pathlib import Path

PROGRAM = os.environ["PALPA_PROGRAM"]
SCRIPT = Path(os.environ["PALPA_ROOT"]) / "tools" / "lab" / "scripts" / "wake_up"


def run(*words):
    return subprocess.run([str(word) for word in words], capture_output=True, text=True, stdin=subprocess.DEVNULL)


class WakeUp(unittest.TestCase):
    def test_every_tick_is_in_a_class(self):
        result = run(PROGRAM, "devices", "--wake-up", "0.05", "--json")
        self.assertEqual(result.returncode, 0, result.stderr)
        rows = json.loads(result.stdout)["wake_ups"]
        self.assertEqual([row["priority"] for row in rows], ["real-time", "ordinary"])
        for row in rows:
            self.assertTrue(0 < row["ticks"] <= 50 <= row["ticks"] + row["missed"], row)
            self.assertEqual(sum(each["ticks"] for each in row["classes"]), row["ticks"])
            self.assertTrue(0 <= row["median_us"] <= row["p99_us"] <= row["p999_us"] <= row["most_us"])
            last = row["classes"][-1]
            self.assertTrue(last["below_us"] / 2 <= row["most_us"] < last["below_us"] or last["below_us"] == 1)
        self.assertFalse(rows[1]["granted"])

    def test_devices_says_what_the_servo_is_granted(self):
        checks = json.loads(run(PROGRAM, "devices", "emulated", "--json").stdout)["machine"]
        self.assertEqual([check["layer"] for check in checks], ["real-time", "memory"])
        self.assertIn("this machine", run(PROGRAM, "devices", "emulated").stdout)

    def test_what_is_not_granted_is_told_with_what_mends_it(self):
        rights = "-sys_nice,-ipc_lock,-sys_resource"
        without = ["setpriv", f"--bounding-set={rights}", f"--inh-caps={rights}"] if os.geteuid() == 0 else []
        result = run("prlimit", "--rtprio=0", "--memlock=65536", *without, PROGRAM, "devices", "emulated", "--json")
        checks = json.loads(result.stdout)["machine"]
        self.assertEqual([check["outcome"] for check in checks], ["failed", "failed"])
        for check in checks:
            self.assertIn("rtprio 50", check["remedy"])
            self.assertIn("memlock unlimited", check["remedy"])

    def test_the_table_is_of_what_was_measured(self):
        row = {"granted": True, "locked": True, "ticks": 100, "missed": 2, "median_us": 1.5, "p99_us": 20,
               "p999_us": 30, "most_us": 40, "classes": [{"below_us": 1, "ticks": 40}, {"below_us": 2, "ticks": 60}]}
        found = {"none": {"load_average": 0.5, "wake_ups": [{"priority": "real-time", **row},
                                                            {"priority": "ordinary", **row, "granted": False}]}}
        found["busy"] = {"load_average": 2.5, "wake_ups": [{"priority": "real-time", **row, "granted": False},
                                                           {"priority": "ordinary", **row}]}
        with tempfile.TemporaryDirectory() as folder:
            (Path(folder) / "wake_up.json").write_text(json.dumps(found))
            result = run(SCRIPT, folder, "--draw")
            self.assertEqual(result.returncode, 0, result.stderr)
            self.assertIn("| none | real-time | 1.5 | 20.0 | 30.0 | 40 | 100 | 2 | 0.5 |", result.stdout)
            self.assertIn("| none | ordinary | 1.5", result.stdout)
            self.assertIn("| busy | real-time, not granted | 1.5", result.stdout)
            if shutil.which("gnuplot"):
                self.assertEqual((Path(folder) / "wake_up.png").read_bytes()[:8], b"\x89PNG\r\n\x1a\n")
            self.assertNotEqual(run(SCRIPT, Path(folder) / "nowhere", "--draw").returncode, 0)


if __name__ == "__main__":
    unittest.main()
