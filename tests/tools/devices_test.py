"""palpa devices, with a library in OpenHaptics' place behind which an emulated Omni stands."""
import json
import os
import subprocess
import unittest
from pathlib import Path

PROGRAM = os.environ["PALPA_PROGRAM"]
WATER = Path(os.environ["PALPA_ROOT"]) / "scenes" / "water"


def palpa(*arguments, stub="free", answer="", **environment):
    return subprocess.run([PROGRAM, *map(str, arguments)], capture_output=True, text=True,
                          input=answer, env={**os.environ, "PALPA_STUB": stub, **environment})


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

    def test_warm_motors_are_told(self):
        checks, _ = self.examine(0, stub="free,warm")
        self.assertEqual(checks["motors"]["outcome"], "failed")
        self.assertIn("rest", checks["motors"]["remedy"])

    def test_what_the_library_does_not_tell_is_unknown(self):
        checks, _ = self.examine(0, stub="free,silent")
        for layer in ("limits", "motors"):
            self.assertEqual(checks[layer]["outcome"], "unknown")

    def test_the_handle_is_pushed_only_by_consent(self):
        checks, _ = self.examine(0, "--force-test", answer="no\n")
        self.assertEqual(checks["force"]["found"], "not tried")
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
                                (["--device", "omni", "--headless"], "needs the window"),
                                (["--device", "omni", "--play"], "--play")):
            with self.subTest(arguments=arguments):
                result = palpa("run", WATER, *arguments)
                self.assertEqual(result.returncode, 2)
                self.assertIn(told, result.stderr)
        result = palpa("run", WATER, "--device", "omni", stub="absent")
        self.assertEqual(result.returncode, 2)
        self.assertIn("--device omni: init: ", result.stderr)


if __name__ == "__main__":
    unittest.main()
