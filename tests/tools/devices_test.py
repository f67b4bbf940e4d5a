"""palpa devices, with libraries in the makers' places behind which an emulated Omni stands."""
import json
import os
import subprocess
import tempfile
import unittest
from pathlib import Path

PROGRAM = os.environ["PALPA_PROGRAM"]
WATER = Path(os.environ["PALPA_ROOT"]) / "scenes" / "water"


def palpa(*arguments, stub="free", answer="", **environment):
    return subprocess.run([PROGRAM, *map(str, arguments)], capture_output=True, text=True,
                          input=answer, env={**os.environ, "PALPA_STUB": stub, "PALPA_DHD_STUB": "absent", **environment})


class Devices(unittest.TestCase):
    def examine(self, code, *arguments, **settings):
        result = palpa("devices", "omni", "--json", *arguments, **settings)
        self.assertEqual(result.returncode, code, result.stdout + result.stderr)
        told = json.loads(result.stdout)
        device = told["devices"][0]
        self.assertEqual(device["usable"], code == 0)
        return {check["layer"]: check for check in device["checks"]}, told["next"]

    def test_a_device_that_works(self):
        checks, after = self.examine(0)
        self.assertEqual(list(checks)[:3], ["library", "symbols", "bus"])
        for layer in ("library", "symbols", "init", "limits", "calibration", "motors", "rate",
                      "readings"):
            self.assertEqual(checks[layer]["outcome"], "ok", checks[layer])
        self.assertNotIn("force", checks)
        self.assertIn("--device omni", after[0])

    def test_every_failure_says_what_mends_it(self):
        for stub, layer, remedy in (("free,absent", "init", "power and cable"),
                                    ("free,inkwell", "calibration", "inkwell"),
                                    ("free,broken-calibration", "calibration", "diagnostic")):
            with self.subTest(stub=stub):
                checks, after = self.examine(1, stub=stub)
                self.assertEqual(checks[layer]["outcome"], "failed")
                self.assertIn(remedy, checks[layer]["remedy"])
                self.assertTrue(any(remedy in line for line in after), after)
        checks, after = self.examine(1, PALPA_OPENHAPTICS="/nowhere/libHD.so")
        self.assertIn("/nowhere/libHD.so", checks["library"]["found"])
        self.assertIn("ldconfig", after[0])

    def test_force_dimension_is_checked_layer_by_layer(self):
        def examine(code, stub="", **environment):
            result = palpa("devices", "force-dimension", "--json", PALPA_DHD_STUB=stub, **environment)
            self.assertEqual(result.returncode, code, result.stdout + result.stderr)
            return {check["layer"]: check for check in json.loads(result.stdout)["devices"][0]["checks"]}

        checks = examine(0)
        for layer in ("library", "symbols", "init", "limits", "calibration", "readings"):
            self.assertEqual(checks[layer]["outcome"], "ok", checks[layer])
        self.assertIn("12 N", checks["limits"]["found"])
        absent = examine(1, stub="absent")["init"]
        self.assertEqual(absent["found"], "no device found")
        self.assertIn("sudo cp devices/udev/70-palpa.rules ", absent["remedy"])
        self.assertIn("rest position", examine(1, stub="uncalibrated")["calibration"]["remedy"])
        missing = examine(1, PALPA_FORCE_DIMENSION="/nowhere/libdhd.so.3")["library"]
        self.assertIn("/nowhere/libdhd.so.3", missing["found"])
        self.assertIn("www.forcedimension.com", missing["remedy"])

    def test_a_second_hand_is_one_of_the_scene(self):
        def run(scene, *arguments):
            return palpa("run", scene, "--headless", "--json", "--seconds", 1, *arguments)

        two = WATER / "two-hands.toml"
        both = json.loads(run(two).stdout)
        self.assertEqual(both["hand_2"]["device"], both["device"])
        self.assertEqual(json.loads(run(two, "--second", "emulated").stdout)["hand_2"]["net_work_J"],
                         both["hand_2"]["net_work_J"])
        self.assertNotIn("hand_2", json.loads(run(WATER).stdout))
        for scene, name, reason in ((WATER, "emulated", "of two hands"),
                                    (two, "mouse", "needs a person and a window"),
                                    (two, "omni", "needs a person and a window")):
            result = run(scene, "--second", name)
            self.assertEqual(result.returncode, 2)
            self.assertIn(reason, result.stderr)

    def test_warm_motors_are_told(self):
        checks, _ = self.examine(0, stub="free,warm")
        self.assertEqual(checks["motors"]["outcome"], "failed")
        self.assertIn("cool for some minutes", checks["motors"]["remedy"])

    def test_what_the_library_does_not_tell_is_unknown(self):
        checks, _ = self.examine(0, stub="free,silent")
        for layer in ("limits", "motors"):
            self.assertEqual(checks[layer]["outcome"], "unknown")

    def test_the_handle_is_pushed_only_by_consent(self):
        checks, _ = self.examine(0, "--force-test", answer="no\n")
        self.assertEqual(checks["force"]["found"], "skipped")
        checks, _ = self.examine(0, "--force-test", answer="\n")
        self.assertEqual(checks["force"]["outcome"], "ok", checks["force"])

    def test_text_ends_with_what_to_do(self):
        result = palpa("devices", stub="free,absent")
        self.assertEqual(result.returncode, 1)
        self.assertIn("emulated: ", result.stdout)
        self.assertIn("palpa run scenes/water, with the mouse", result.stdout.splitlines()[-1])

    def test_run_lists_devices_and_knows_their_names(self):
        listed = palpa("run", "--device", "list")
        self.assertEqual(listed.returncode, 0)
        self.assertIn("found: emulated Omni", listed.stdout)
        self.assertIn("found: emulated PHANTOM Omni", listed.stdout)
        self.assertIn("not found: init", palpa("run", "--device", "list", stub="absent").stdout)
        for arguments, told in ((["--device", "omi"], "did you mean 'omni'"),
                                (["--device", "omni", "--headless"], "needs a person and a window"),
                                (["--device", "omni", "--play"], "--play")):
            with self.subTest(arguments=arguments):
                result = palpa("run", WATER, *arguments)
                self.assertEqual(result.returncode, 2)
                self.assertIn(told, result.stderr)
        result = palpa("run", WATER, "--device", "omni", stub="absent")
        self.assertEqual(result.returncode, 2)
        self.assertIn("--device omni: init: ", result.stderr)

    def test_a_recorded_hand_plays_again_and_the_trace_is_the_same(self):
        with tempfile.TemporaryDirectory() as folder:
            first, second = Path(folder) / "first", Path(folder) / "second"
            run = ("run", WATER, "--headless", "--seconds", 3)
            self.assertEqual(palpa(*run, "--record", first).returncode, 0)
            again = palpa(*run, "--record", second, "--device", f"replay:{first}")
            self.assertEqual(again.returncode, 0, again.stderr)
            self.assertEqual((first / "trace.csv").read_bytes(),
                             (second / "trace.csv").read_bytes())
            verified = palpa("replay", second, "--verify")
            self.assertEqual(verified.returncode, 2)
            self.assertIn("expected a recording of the emulated hand", verified.stderr)

    def test_a_script_leads_the_molecule_in(self):
        with tempfile.TemporaryDirectory() as folder:
            script = Path(folder) / "in.csv"
            # 3 Å at 2.5 cm/Å, in two seconds, from 7 Å.
            script.write_text("# inward\ntime_s,handle_x_m,handle_y_m,handle_z_m\n"
                              "0,0,0,0\n0.5,0,0,0\n2.5,-0.075,0,0\n")
            result = palpa("run", WATER, "--headless", "--seconds", 3, "--mode", 4, "--json",
                           "--device", f"script:{script}")
            self.assertEqual(result.returncode, 0, result.stderr)
            summary = json.loads(result.stdout)
            self.assertEqual(summary["device"], "script")
            self.assertAlmostEqual(summary["last_angstrom"], 4, delta=0.01)


if __name__ == "__main__":
    unittest.main()
