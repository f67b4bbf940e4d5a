"""One session in a window under Xvfb: start, drag the molecule, move a slider, switch the mode, take
a screenshot, set the graphics up again, change the size, quit. Vulkan's validation watches."""
import ctypes
import json
import os
import shutil
import signal
import struct
import subprocess
import tempfile
import time
import unittest
from array import array
from pathlib import Path

from read_png import read_png

PROGRAM = os.environ["PALPA_PROGRAM"]
ROOT = Path(os.environ["PALPA_ROOT"])


def size_of_png(path):
    data = path.read_bytes()
    assert data[:8] == b"\x89PNG\r\n\x1a\n"
    return struct.unpack(">II", data[16:24])


class Display:
    """A display that nobody sees, on a number that is free."""

    def __init__(self, screen="1280x800"):
        self.screen = screen

    def __enter__(self):
        read, write = os.pipe()
        self.server = subprocess.Popen(
            ["Xvfb", "-displayfd", str(write), "-screen", "0", f"{self.screen}x24", "-nolisten", "tcp",
             "-noreset"],
            pass_fds=[write], stderr=subprocess.DEVNULL)
        os.close(write)
        with os.fdopen(read) as pipe:
            self.name = ":" + pipe.readline().strip()
        return self

    def __exit__(self, *_):
        self.server.terminate()
        self.server.wait()

    def do(self, *words):
        subprocess.run(["xdotool", *map(str, words)], check=True,
                       env={**os.environ, "DISPLAY": self.name}, stdout=subprocess.DEVNULL)

    def cursor(self):
        words = subprocess.run(["xdotool", "getmouselocation"], capture_output=True, text=True,
                               env={**os.environ, "DISPLAY": self.name}).stdout.split()
        return tuple(int(word.split(":")[1]) for word in words[:2])

    def find_window(self):
        return subprocess.run(["xdotool", "search", "--onlyvisible", "--name", "^Palpa - "],
                              capture_output=True, text=True,
                              env={**os.environ, "DISPLAY": self.name}).stdout.split()

    def set_dots_per_inch(self, dots):
        """As desktops tell programs how large text should be."""
        resource_manager, string, eight_bits, replace = 23, 31, 8, 0
        x11 = ctypes.CDLL("libX11.so.6")
        x11.XOpenDisplay.restype, x11.XDefaultRootWindow.restype = ctypes.c_void_p, ctypes.c_ulong
        display = ctypes.c_void_p(x11.XOpenDisplay(self.name.encode()))
        text = f"Xft.dpi:\t{dots}\n".encode()
        x11.XChangeProperty(display, ctypes.c_ulong(x11.XDefaultRootWindow(display)),
                            ctypes.c_ulong(resource_manager), ctypes.c_ulong(string), eight_bits,
                            replace, text, len(text))
        x11.XCloseDisplay(display)

    def focus_window(self):
        """Whether the window could be given the keys; it may not be there yet."""
        found = self.find_window()
        return found and subprocess.run(["xdotool", "windowfocus", "--sync", found[0]],
                                        env={**os.environ, "DISPLAY": self.name},
                                        stderr=subprocess.DEVNULL).returncode == 0


def difference(one, two):
    """In levels of 255, on average over pixels and channels."""
    return sum(abs(a - b) for a, b in zip(one, two)) / len(one)


class Session(unittest.TestCase):
    def setUp(self):
        self.folder = Path(tempfile.mkdtemp())
        self.sound = self.folder / "sound.raw"  # what the sound library plays, into a file
        os.environ.update(SDL_AUDIODRIVER="disk", SDL_DISKAUDIOFILE=str(self.sound))

    def tearDown(self):
        keep = os.environ.get("PALPA_KEEP_SCREENSHOTS")
        if keep:
            shutil.copytree(self.folder, keep, dirs_exist_ok=True)
        shutil.rmtree(self.folder)

    def wait_until(self, is_so, what):
        for _ in range(1200):
            if is_so():
                return
            self.assertIsNone(self.program.poll(), "the program ended early")
            time.sleep(0.05)
        self.fail("waited in vain for " + what)

    def start(self, display, *options, scene=ROOT / "scenes" / "water"):
        self.program = subprocess.Popen(
            [PROGRAM, "run", scene, "--screenshots", self.folder, "--json",
             "--validation", *map(str, options)],
            env={**os.environ, "DISPLAY": display.name, "XDG_CONFIG_HOME": str(self.folder)},
            stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        self.wait_until(display.focus_window, "the window")
        self.screenshots = 0
        self.screenshot(display)  # the first picture is there: it takes part from now on

    def screenshot(self, display):
        self.screenshots += 1
        path = self.folder / f"palpa-{self.screenshots:04}.png"
        display.do("key", "F12")
        self.wait_until(path.exists, path.name)
        return path

    def last_sound(self):
        """A fifth of a second of samples, the last ones so far."""
        data = self.sound.read_bytes() if self.sound.exists() else b""
        return array("f", data[:len(data) // 4 * 4])[-9600:]

    def wait_for_tone(self, amplitude):
        """Until the hand feels a force that sounds so loud: with --sound. 0.05 is 0.14 N, 0.15 is 1.1 N
        (engine/sound/tone.h)."""
        self.wait_until(lambda: max(self.last_sound(), default=0) > amplitude, "a tone")

    def quit(self, display, *, changed=False):
        display.do("key", "Escape")
        if changed:  # asked whether to save
            self.screenshot(display)
            self.assertIsNone(self.program.poll(), "it did not ask")
            display.do("key", "q")
        out, err = self.program.communicate(timeout=60)
        self.assertEqual(self.program.returncode, 0, err)
        return json.loads(out)

    def test_a_session_with_mouse_and_keys(self):
        with Display() as display:
            self.start(display)
            self.assertEqual(size_of_png(self.folder / "palpa-0001.png"), (1280, 800))

            # A plain drag turns the view and pushes no atoms.
            display.do("mousemove", 640, 330, "mousedown", 1)
            for _ in range(10):
                display.do("mousemove_relative", "--", -8, 2)
            display.do("mouseup", 1)
            display.do("key", "Home")
            # With Space held the molecule comes along.
            display.do("mousemove", 660, 330, "keydown", "space")
            for _ in range(30):
                display.do("mousemove_relative", "--", -6, 0)
                time.sleep(0.02)
            time.sleep(0.5)
            display.do("keyup", "space")
            self.screenshot(display)

            # The first slider of the gains, A_f max, to its far right.
            # A screenshot between two events makes sure that a frame has seen the first.
            display.do("mousemove", 1000, 557)
            self.screenshot(display)
            display.do("mousedown", 1)
            self.screenshot(display)
            display.do("mousemove", 1180, 557)
            self.screenshot(display)
            display.do("mouseup", 1)
            self.screenshot(display)
            display.do("key", "3")
            display.do("key", "v")
            display.do("key", "F5")
            self.screenshot(display)
            display.do("windowsize", "--sync", display.find_window()[0], 900, 600)
            self.wait_until(lambda: size_of_png(self.screenshot(display)) == (900, 600),
                            "the new size")
            summary = self.quit(display, changed=True)

        self.assertLess(summary["closest_angstrom"], 6.5)
        self.assertEqual(summary["warnings"], [])
        self.assertEqual(summary["mode"], "3")
        self.assertGreater(summary["coupling"]["A_f_max"], 6e9)
        self.assertGreater(summary["steps"], 0)
        self.assertFalse(summary["stopped"])

    def test_a_hand_that_nobody_moves_moves_nothing(self):
        with Display() as display:
            self.start(display)
            display.do("mousemove", 640, 330, "mousedown", 1)
            for _ in range(10):
                display.do("mousemove_relative", "--", -20, 0)
            display.do("mouseup", 1)
            summary = self.quit(display)
        self.assertAlmostEqual(summary["closest_angstrom"], 7, delta=0.7)

    def test_arrow_keys_pull_the_molecule_too(self):
        with Display() as display:
            self.start(display, "--sound")
            display.do("keydown", "Left")
            self.wait_for_tone(0.05)
            display.do("keyup", "Left")
            self.screenshot(display)
            summary = self.quit(display)
        self.assertEqual(summary["device"], "mouse and keys")
        self.assertLess(summary["closest_angstrom"], 6)

    def test_a_lost_device_comes_back(self):
        with Display() as display:
            self.start(display, "--lose-device-at", 5)
            self.screenshot(display)
            self.quit(display)

    def test_what_a_window_cannot_be(self):
        with Display() as display:
            for options, environment, expected in (
                    (["--size", "99999x99999"], {}, "more than 67108864 pixels"),
                    (["--size", "99999x600"], {}, "a window of "),
                    ([], {"VK_DRIVER_FILES": "/nowhere", "VK_ICD_FILENAMES": "/nowhere"},
                     "is a driver installed"),
                    (["--screenshots", "/nowhere"], {}, "/nowhere"),
                    (["--after", "nan", "--shot", "x.png"], {}, "nan")):
                with self.subTest(options=options):
                    result = subprocess.run(
                        [PROGRAM, "run", ROOT / "scenes" / "water", *options], text=True,
                        env={**os.environ, "DISPLAY": display.name, **environment},
                        capture_output=True, timeout=60)
                    self.assertEqual(result.returncode, 2, result.stderr)
                    self.assertEqual(len(result.stderr.strip().splitlines()), 1, result.stderr)
                    self.assertIn(expected, result.stderr)

    def test_a_device_that_was_chosen_is_remembered(self):
        chosen = self.folder / "palpa" / "preferences.toml"
        os.environ["PALPA_STUB"] = "free"
        try:
            with Display() as display:
                self.start(display)
                # From the list: nothing is on the bus, so that D passes the Omni over.
                display.do("mousemove", 240, 326, "click", 1)
                self.screenshot(display)
                display.do("mousemove", 180, 391)
                self.screenshot(display)
                display.do("click", 1)
                self.wait_until(lambda: "device = 'omni'" in chosen.read_text(),
                                "the choice on disk")
                self.assertEqual(self.quit(display)["device"], "emulated PHANTOM Omni")

                for file in self.folder.glob("*.png"):
                    file.unlink()
                self.start(display)
                summary = self.quit(display)
        finally:
            del os.environ["PALPA_STUB"]
        self.assertEqual(summary["device"], "emulated PHANTOM Omni")

    def test_without_hardware_an_emulated_device_is_asked_for_and_forgotten(self):
        chosen = self.folder / "palpa" / "preferences.toml"
        with Display() as display:
            self.start(display)
            display.do("key", "d")  # the Omni's library is there, but nothing on the bus
            self.screenshot(display)
            display.do("key", "Escape")  # no
            self.screenshot(display)
            display.do("key", "d")
            self.screenshot(display)
            display.do("key", "y")
            self.screenshot(display)
            self.assertEqual(self.quit(display)["device"], "emulated Omni")
        self.assertNotIn("device", chosen.read_text())

    def test_alone_it_opens_the_scene_of_last_time(self):
        with Display() as display:
            self.start(display, scene="water/space")  # by its name, which is no path from here
            self.quit(display)
            self.program = subprocess.Popen(
                [PROGRAM], cwd=self.folder, text=True, stdout=subprocess.PIPE,
                stderr=subprocess.PIPE,
                env={**os.environ, "DISPLAY": display.name, "XDG_CONFIG_HOME": str(self.folder)})
            self.wait_until(display.focus_window, "the window")
            self.wait_until(lambda: self.try_screenshot(display), "a picture")
            display.do("key", "Escape")
            out, err = self.program.communicate(timeout=60)
        self.assertEqual(self.program.returncode, 0, err)
        self.assertIn("Two waters in space", out)

    def try_screenshot(self, display):
        display.do("key", "F12")
        return list(self.folder.glob("palpa-*.png"))

    def test_a_scene_is_saved_as_set_and_can_be_run(self):
        scene = Path(shutil.copytree(ROOT / "scenes" / "water", self.folder / "mine"))
        with Display() as display:
            self.start(display, scene=scene)
            display.do("key", "2", "key", "v", "key", "c")
            display.do("key", "ctrl+s")
            saved = scene / "scene-2.toml"
            self.wait_until(saved.exists, "the saved scene")
            display.do("key", "3")
            # A quick undo: both keys between two pictures.
            display.do("key", "ctrl+z")
            self.screenshot(display)
            self.quit(display)  # as saved again: nothing to ask
        self.assertIn('mode = "2"', saved.read_text())
        self.assertIn('representation = "space-filling"', saved.read_text())
        self.assertIn('colouring = "element"', saved.read_text())
        self.assertFalse((scene / "scene-3.toml").exists())
        for options in ((saved, "--check"), (saved, "--headless", "--seconds", "0.1")):
            result = subprocess.run([PROGRAM, "run", *options], capture_output=True, text=True)
            self.assertEqual(result.returncode, 0, result.stderr)
        self.assertIn("mode 2", result.stdout)

    def test_space_keeps_the_cursor_and_gives_it_back(self):
        with Display() as display:
            self.start(display)
            display.do("mousemove", 640, 330, "keydown", "space")
            self.screenshot(display)
            for _ in range(60):
                display.do("mousemove_relative", "--", -20, 0)
            time.sleep(0.3)
            display.do("keyup", "space")
            self.screenshot(display)
            self.assertEqual(display.cursor(), (640, 330))
            summary = self.quit(display)
        self.assertLess(summary["closest_angstrom"], 6.5)

    def test_text_grows_by_keys_and_stays_so(self):
        chosen = self.folder / "palpa" / "preferences.toml"
        with Display() as display:
            self.start(display)
            display.do("key", "ctrl+equal")
            self.wait_until(lambda: "text_scale = 1.1" in chosen.read_text(), "the choice on disk")
            self.screenshot(display)
            display.do("key", "ctrl+0")
            self.wait_until(lambda: "text_scale = 1.0" in chosen.read_text(), "the choice on disk")
            self.quit(display)

    def test_a_window_grows_with_the_text_that_the_display_asks_for(self):
        for options, size in (([], (2560, 1500)), (["--size", "900x600"], (900, 600))):
            with self.subTest(options=options), Display("2560x1500") as display:
                display.set_dots_per_inch(192)  # twice as large: 2560x1600, but for the screen
                for file in self.folder.glob("*.png"):
                    file.unlink()
                self.start(display, *options)
                self.assertEqual(size_of_png(self.folder / "palpa-0001.png"), size)
                self.quit(display)

    def test_escape_closes_what_is_open_before_it_quits(self):
        with Display() as display:
            self.start(display)
            display.do("mousemove", 150, 101, "click", 1)  # the list of modes
            self.screenshot(display)
            display.do("key", "Escape")
            self.screenshot(display)
            display.do("key", "h", "key", "Escape")  # the help
            self.screenshot(display)
            display.do("key", "4")
            display.do("key", "Escape")  # asks
            self.screenshot(display)
            display.do("key", "Escape")  # stays
            self.screenshot(display)
            self.assertIsNone(self.program.poll())
            self.quit(display, changed=True)

    def test_a_drag_from_a_slider_does_not_turn_the_view(self):
        """Pressed and moved away at once, before a picture could see the mouse on the panel."""
        with Display() as display:
            self.start(display, "--size", "900x600", "--set", "stroke=hold", "--set", "grip=none")
            display.do("key", "p")
            self.screenshot(display)
            before = self.middle_of(self.screenshot(display))
            display.do("mousemove", 700, 410, "mousedown", 1, "mousemove", 450, 250, "mousemove",
                       400, 200)
            self.screenshot(display)
            display.do("mousemove", 500, 300, "mouseup", 1)
            self.screenshot(display)
            display.do("key", "ctrl+z")
            self.assertLess(self.share_that_differs(before, display), 0.02)
            # The same way from the picture turns it.
            display.do("mousemove", 450, 250, "mousedown", 1, "mousemove", 400, 200)
            self.screenshot(display)
            display.do("mouseup", 1)
            self.assertGreater(self.share_that_differs(before, display), 0.04)
            self.quit(display)

    def test_home_and_reset_bring_the_first_view_back(self):
        with Display() as display:
            self.start(display, "--size", "480x320", "--set", "stroke=hold")
            display.do("key", "o", "key", "l", "key", "Home")  # no panels: all of it is seen
            first = self.lower_part_of(self.screenshot(display))
            for change in (["v"], ["f"], ["v", "v", "f", "a"]):
                for back in ("Home", "r"):
                    with self.subTest(change=change, back=back):
                        for key in change:
                            display.do("key", key)
                        self.wait_for_view(display, lambda view: difference(view, first) > 4)
                        display.do("key", back)
                        # How long a frame takes decides of its effects, so that it is the same only
                        # nearly.
                        self.wait_for_view(display, lambda view: difference(view, first) < 1)
            self.quit(display)

    def wait_for_view(self, display, is_so):
        self.wait_until(lambda: is_so(self.lower_part_of(self.screenshot(display))), "a view")

    def lower_part_of(self, picture):
        """The pixels below its notes, as the program's PNG files have them: 8-bit RGBA."""
        (width, height), pixels = read_png(picture)
        return pixels[4 * width * (height * 2 // 5):]

    def middle_of(self, picture):
        """Its pixels between the panels, below the notes and above the lesson."""
        (width, height), pixels = read_png(picture)
        self.assertEqual((width, height), (900, 600))
        return b"".join(pixels[4 * (width * y + 300):4 * (width * y + 600)] for y in range(100, 370))

    def share_that_differs(self, before, display):
        """Of the bytes now, by more than a picture that was drawn smaller meanwhile."""
        after = self.middle_of(self.screenshot(display))
        return sum(abs(a - b) > 60 for a, b in zip(before, after)) / len(before)

    def test_a_device_that_is_gone_is_said_and_not_forgotten(self):
        chosen = self.folder / "palpa" / "preferences.toml"
        chosen.parent.mkdir()
        for text, told in (("device = 'omni'\n", "omni, which led last, cannot be used now"),
                           ("device = 'omni\n", "preferences.toml:1:")):
            with self.subTest(text=text), Display() as display:
                chosen.write_text(text)
                for file in self.folder.glob("*.png"):
                    file.unlink()
                os.environ["PALPA_OPENHAPTICS"], stub = "/nowhere", os.environ["PALPA_OPENHAPTICS"]
                try:
                    self.start(display)
                finally:
                    os.environ["PALPA_OPENHAPTICS"] = stub
                display.do("key", "Escape")
                out, err = self.program.communicate(timeout=60)
                self.assertEqual(self.program.returncode, 0, err)
                self.assertEqual(json.loads(out)["device"], "mouse and keys")
                self.assertEqual(len(err.strip().splitlines()), 1, err)
                self.assertIn(told, err)
                if told.startswith("omni"):
                    self.assertIn("device = 'omni'\n", chosen.read_text())
                else:  # whoever wrote it can mend it
                    self.assertEqual(chosen.read_text(), text)

    def test_the_force_is_heard_until_it_is_paused(self):
        with Display() as display:
            self.start(display, "--sound")
            display.do("keydown", "Left")
            self.wait_for_tone(0.05)
            self.screenshot(display)
            self.assertGreater(max(self.last_sound()), 0.05)  # it stays
            display.do("key", "p")
            self.wait_until(lambda: not any(self.last_sound()), "silence")
            display.do("key", "p")
            self.wait_until(lambda: any(self.last_sound()), "the tone again")
            display.do("keyup", "Left")
            self.quit(display)
        played = array("f", self.sound.read_bytes())
        self.assertLessEqual(max(map(abs, played)), 0.25)
        self.assertEqual(played[-1], 0)
        self.assertNotIn("sound", (self.folder / "palpa" / "preferences.toml").read_text())

    def test_sound_is_off_until_it_is_chosen_and_then_remembered(self):
        chosen = self.folder / "palpa" / "preferences.toml"
        with Display() as display:
            self.start(display)
            self.assertFalse(self.sound.exists())
            display.do("key", "s")
            self.wait_until(self.sound.exists, "the sound library")
            self.wait_until(chosen.exists, "the choice on disk")
            self.quit(display)
            self.assertIn("sound = true", chosen.read_text())

            for file in (self.sound, *self.folder.glob("*.png")):
                file.unlink()
            self.start(display)
            self.assertTrue(self.sound.exists())
            display.do("key", "s")
            self.wait_until(lambda: "sound = false" in chosen.read_text(), "the choice on disk")
            self.quit(display)

    def test_sound_stays_off_where_there_is_none(self):
        for driver, file in (("none of that name", ""), ("disk", "/nowhere"), ("disk", "/dev/full")):
            with self.subTest(driver=driver, file=file), Display() as display:
                os.environ.update(SDL_AUDIODRIVER=driver, SDL_DISKAUDIOFILE=file)
                for picture in self.folder.glob("*.png"):
                    picture.unlink()
                self.start(display, "--sound")
                display.do("key", "s")
                self.screenshot(display)
                self.quit(display)

    def test_the_emulated_hand_can_play(self):
        with Display() as display:
            self.start(display, "--play", "--sound", "--set", "stroke_s=0.5")
            self.wait_for_tone(0.15)  # no attraction of two waters is felt so strongly
            summary = self.quit(display)
        self.assertLess(summary["closest_angstrom"], 2.77)

    def test_a_real_device_holds_the_molecule(self):
        """Behind the library that stands in for its maker's, an emulated one that nobody holds."""
        os.environ["PALPA_STUB"] = "free"
        with Display() as display:
            self.start(display, "--device", "omni", "--set", "stroke_s=0.5")
            self.screenshot(display)
            summary = self.quit(display)
        self.assertEqual(summary["device"], "emulated PHANTOM Omni")
        self.assertGreater(summary["steps"], 0)
        self.assertFalse(summary["stopped"])

    def test_a_signal_closes_the_window_in_order(self):
        with Display() as display:
            self.start(display, "--play")
            self.program.send_signal(signal.SIGTERM)
            out, err = self.program.communicate(timeout=60)
        self.assertEqual(self.program.returncode, 128 + signal.SIGTERM, err)
        self.assertEqual(json.loads(out)["device"], "emulated Omni")

    def test_a_pad_that_is_not_there_leaves_the_mouse_and_is_waited_for(self):
        chosen = self.folder / "palpa" / "preferences.toml"
        chosen.parent.mkdir()
        chosen.write_text("device = 'gamepad'\n")
        with Display() as display:
            self.start(display)
            summary = self.quit(display)
        self.assertEqual(summary["device"], "mouse and keys")
        self.assertIn("device = 'gamepad'\n", chosen.read_text())

    def test_no_display_is_one_line(self):
        clean = {key: value for key, value in os.environ.items()
                 if key not in ("DISPLAY", "WAYLAND_DISPLAY")}
        result = subprocess.run([PROGRAM, "run", ROOT / "scenes" / "water"], env=clean,
                                capture_output=True, text=True)
        self.assertEqual(result.returncode, 2)
        self.assertEqual(len(result.stderr.strip().splitlines()), 1, result.stderr)
        self.assertIn("no display", result.stderr)


if __name__ == "__main__":
    unittest.main()
