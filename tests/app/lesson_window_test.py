"""A lesson done by mouse and keys, a measure by clicks and a picture without panels, in a window under
Xvfb."""
import os
import shutil
import subprocess
import tempfile
import unittest
from pathlib import Path

import window_test
from read_png import read_png
from window_case import WindowCase
from window_test import PROGRAM, ROOT, Display


class LessonWindow(WindowCase):
    find_waters_in, is_red = window_test.Session.find_waters_in, window_test.Session.is_red

    def setUp(self):
        self.folder = Path(tempfile.mkdtemp())
        self.shots = 0

    def start(self, display, scene, *options):
        self.program = subprocess.Popen(
            [PROGRAM, "run", scene, "--size", "1280x800", "--files", self.folder, *map(str, options)],
            env={**os.environ, "DISPLAY": display.name, "XDG_CONFIG_HOME": str(self.folder),
                 "VK_INSTANCE_LAYERS": "VK_LAYER_KHRONOS_validation"},
            text=True, stdout=subprocess.PIPE, stderr=subprocess.PIPE)
        self.wait_until(display.focus_window, "the window")
        self.screenshot(display)

    def screenshot(self, display):
        self.shots += 1
        path = self.folder / f"palpa-{self.shots:04}.png"
        display.do("key", "F12")
        self.wait_until(path.exists, path.name)
        return path

    def title(self, display):
        found = display.find_window()
        return found and subprocess.run(
            ["xdotool", "getwindowname", found[0]], capture_output=True, text=True,
            env={**os.environ, "DISPLAY": display.name}).stdout.strip()

    def lessons_done(self):
        file = self.folder / "palpa" / "preferences.toml"
        return file.exists() and "lessons_done = [ 'water/tour' ]" in file.read_text()

    def test_a_lesson_is_done_by_mouse_and_leads_to_the_next(self):
        with Display() as display:
            self.start(display, ROOT / "scenes" / "water" / "tour.toml")
            display.do("mousemove", 640, 300)

            def try_all():
                """What the steps ask for, again and again: near, mode 5, the right answer."""
                display.do("key", "r")
                self.screenshot(display)
                display.do("keydown", "space")
                for _ in range(16):
                    for _ in range(3):
                        display.do("mousemove_relative", "--", -6, 0)
                    self.screenshot(display)
                for key in ("5", "6", "b", "Return"):
                    display.do("key", key)
                    self.screenshot(display)
                display.do("keyup", "space")
                return self.lessons_done()

            self.wait_until(try_all, "the end of the lesson")

            def go_on():
                display.do("key", "Return")
                return self.title(display) == "Palpa - Two waters"

            # Doing what was asked for is no change that has to be saved: nothing is asked.
            self.wait_until(go_on, "the next lesson")
            self.wait_until(display.focus_window, "the window")
            display.do("key", "ctrl+q")
            out, err = self.program.communicate()
        self.assertEqual(self.program.returncode, 0, err)
        self.assertIn("4 of 4 steps done", out)
        self.assertNotIn("Validation Error", out + err)

    def test_a_distance_is_measured_by_clicks_saved_and_removed(self):
        with Display() as display:
            mine = shutil.copytree(ROOT / "scenes" / "water", self.folder / "mine")
            self.start(display, mine, "--set", "stroke=hold")
            display.do("key", "p", "key", "i")
            for place in self.find_waters_in(read_png(self.screenshot(display))):
                display.do("mousemove", *place)
                self.screenshot(display)
                display.do("click", 1)
                self.screenshot(display)
            display.do("key", "i", "key", "ctrl+s")
            saved = self.folder / "mine" / "scene-2.toml"
            self.wait_until(saved.exists, "the saved scene")
            self.assertRegex(saved.read_text(), r'measure = \["molecule fixed [^";]*OH2; molecule moved [^";]*OH2"\]')
            display.do("key", "ctrl+k")
            self.screenshot(display)
            display.do("type", "Remove all measures")
            self.screenshot(display)
            display.do("key", "Return")
            self.screenshot(display)
            self.screenshot(display)
            display.do("key", "ctrl+q")  # asks, for the measure is in the saved scene
            self.screenshot(display)
            display.do("key", "q")
            _, err = self.program.communicate()
        self.assertEqual(self.program.returncode, 0, err)

    def test_a_picture_has_no_panels_and_what_is_on_screen(self):
        with Display() as display:
            self.start(display, ROOT / "scenes" / "water", "--set", "stroke=hold")
            display.do("key", "p")
            on_screen = self.find_waters_in(read_png(self.screenshot(display)))
            display.do("key", "shift+F12")
            self.screenshot(display)
            display.do("key", "Return")
            path = self.folder / "palpa-picture-0001.png"
            self.wait_until(path.exists, path.name)
            display.do("key", "ctrl+q")
            _, err = self.program.communicate()
        self.assertEqual(self.program.returncode, 0, err)
        (width, height), pixels = read_png(path)
        self.assertEqual((width, height), (1920, 1080))
        ground = pixels[:4]
        self.assertEqual(bytes(ground), b"\xff\xff\xff\xff")  # as palpa render has it
        for x, y in ((5, 500), (1900, 500), (960, 5), (960, 1070), (1900, 1070), (30, 30)):
            at = 4 * (width * y + x)
            self.assertEqual(pixels[at:at + 4], ground)
        in_picture = self.find_waters_in(((width, height), pixels))
        # 1080 pixels show as much as the 520 or so between the panels, in the same shape.
        (left, right), (first, second) = in_picture, on_screen
        scale = (right[0] - left[0]) / (second[0] - first[0])
        self.assertTrue(1.9 < scale < 2.3, scale)
        self.assertLess(abs(right[1] - left[1] - scale * (second[1] - first[1])), 10)


if __name__ == "__main__":
    unittest.main()
