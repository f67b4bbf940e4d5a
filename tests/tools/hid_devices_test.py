"""palpa devices with a SpaceMouse that umockdev shows to the real libhidapi, and its latency."""
import json
import os
import subprocess
import tempfile
import unittest
from pathlib import Path

PROGRAM = Path(os.environ["PALPA_PROGRAM"])
WATER = Path(os.environ["PALPA_ROOT"]) / "scenes" / "water"

# What a multi-axis controller says of itself at the shortest.
DESCRIPTOR = "05010908A101C0"
DEVICE = f"""P: /devices/usb1/1-1
E: SUBSYSTEM=usb
E: DEVTYPE=usb_device
A: idVendor=256f\\n
A: idProduct=c635\\n
A: manufacturer=nobody\\n
A: product=SpaceMouse Compact\\n
A: bcdDevice=0100\\n

P: /devices/usb1/1-1/1-1:1.0
E: SUBSYSTEM=usb
E: DEVTYPE=usb_interface
A: bInterfaceNumber=00\\n

P: /devices/usb1/1-1/1-1:1.0/0003:256F:C635.0001
E: SUBSYSTEM=hid
E: HID_ID=0003:0000256F:0000C635
E: HID_NAME=SpaceMouse Compact
E: HID_UNIQ=
H: report_descriptor={DESCRIPTOR}

P: /devices/usb1/1-1/1-1:1.0/0003:256F:C635.0001/hidraw/hidraw0
N: hidraw0
E: SUBSYSTEM=hidraw
E: DEVNAME=/dev/hidraw0
L: device=../../../0003:256F:C635.0001
"""
IOCTLS = f"""@DEV /dev/hidraw0
HIDIOCGRDESCSIZE 0 07000000
HIDIOCGRDESC 0 7 {DESCRIPTOR}
"""


class HidDevices(unittest.TestCase):
    def palpa(self, *arguments):
        with tempfile.TemporaryDirectory() as folder:
            device, ioctls = Path(folder) / "device", Path(folder) / "ioctls"
            device.write_text(DEVICE)
            ioctls.write_text(IOCTLS)
            return subprocess.run(
                ["umockdev-run", "-d", device, "-i", f"/dev/hidraw0={ioctls}", "--", PROGRAM,
                 *map(str, arguments)], capture_output=True, text=True)

    def test_one_that_is_plugged_in_can_be_used(self):
        result = self.palpa("devices", "spacemouse", "--json")
        self.assertEqual(result.returncode, 0, result.stdout + result.stderr)
        told = json.loads(result.stdout)
        device = told["devices"][0]
        checks = {check["layer"]: check for check in device["checks"]}
        self.assertTrue(device["usable"])
        self.assertEqual(list(checks),
                         ["library", "bus", "permission", "open", "reports", "readings"])
        self.assertIn("256f:c635 by cable, /dev/hidraw0", checks["bus"]["found"])
        self.assertEqual(checks["readings"]["outcome"], "ok")
        self.assertIn("palpa run scenes/water --device spacemouse", told["next"])

    def test_one_that_is_not_is_asked_for(self):
        result = self.palpa("devices", "dualsense", "--json")
        self.assertEqual(result.returncode, 1)
        told = json.loads(result.stdout)
        self.assertIn("no DualSense among the 1 input devices", told["devices"][0]["checks"][-1]["found"])
        self.assertTrue(told["next"][0].startswith("dualsense: plug it in"), told["next"])
        result = self.palpa("run", WATER, "--device", "dualsense")
        self.assertEqual(result.returncode, 2)
        self.assertIn("--device dualsense: bus: no DualSense", result.stderr)

    def test_latency_is_told_of_every_device(self):
        result = subprocess.run(["umockdev-wrapper", PROGRAM.parent / "hid_latency", "4"],
                                capture_output=True, text=True)
        self.assertEqual(result.returncode, 0, result.stderr)
        for device in ("SpaceMouse", "DualSense", "DualSense, Bluetooth", "DualShock 4"):
            with self.subTest(device=device):
                line = next(line for line in result.stdout.splitlines()
                            if line.startswith(f"{device:24} "))
                median, late, latest = map(int, line[24:].split()[:3])
                self.assertTrue(0 < median <= late <= latest, line)


if __name__ == "__main__":
    unittest.main()
