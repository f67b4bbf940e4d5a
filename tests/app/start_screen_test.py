"""From the start screen to a structure of one's own and back, in a window under Xvfb."""
import os
import re
import shutil
import subprocess
import tempfile
import time
import types
import unittest
from pathlib import Path

from entry_server import EntryServer, packed, stalled
from read_png import read_png
from window_case import WindowCase
from window_test import PROGRAM, ROOT, Display


class StartScreen(WindowCase):
    def setUp(self):
        self.folder = Path(tempfile.mkdtemp())
        self.shots = 0

    def start(self, display, *arguments):
        self.program = subprocess.Popen(
            [PROGRAM, *map(str, arguments)], cwd=self.folder, text=True, stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            env={**os.environ, "DISPLAY": display.name, "XDG_CONFIG_HOME": str(self.folder),
                 "XDG_DATA_HOME": str(self.folder / "data"),
                 "XDG_DOCUMENTS_DIR": str(self.folder),
                 "VK_INSTANCE_LAYERS": "VK_LAYER_KHRONOS_validation"})

    def find_window(self, display, name):
        return subprocess.run(["xdotool", "search", "--onlyvisible", "--name", f"^{name}$"],
                              capture_output=True, text=True,
                              env={**os.environ, "DISPLAY": display.name}).stdout.split()

    def wait_for(self, display, name):
        """The window with that title, which has the keys."""
        self.wait_until(lambda: self.find_window(display, name), name)
        window = self.find_window(display, name)[0]
        self.wait_until(lambda: subprocess.run(
            ["xdotool", "windowfocus", "--sync", window], stderr=subprocess.DEVNULL,
            env={**os.environ, "DISPLAY": display.name}).returncode == 0, "the focus")
        return window

    def screenshot(self, display):
        self.shots += 1
        path = self.folder / "Palpa" / f"palpa-{self.shots:04}.png"
        display.do("key", "F12")
        self.wait_until(path.exists, path.name)
        return path

    def end(self, display):
        display.do("key", "ctrl+q")
        out, err = self.program.communicate()
        self.assertEqual(self.program.returncode, 0, err)
        self.assertNotIn("Validation Error", out + err)
        return out

    def count_greens(self, picture):
        """Carbons of what is in hand."""
        (width, height), pixels = read_png(picture)
        return sum(pixels[i + 1] > pixels[i] + 40 and pixels[i + 1] > pixels[i + 2] + 20
                   for i in range(0, 4 * width * height, 4))

    def has_chosen_card(self, picture):
        """Its edge is three pixels wide."""
        (width, height), pixels = read_png(picture)
        return sum(pixels[i:i + 3] == b"\x3c\x78\xd2" for i in range(0, 4 * width * height, 4)) > 500

    def test_a_scene_is_chosen_by_keys_and_left_for_the_start_screen(self):
        with Display() as display:
            self.start(display)
            self.wait_for(display, "Palpa")
            # The cards have pictures: ligands in them are green.
            self.assertGreater(self.count_greens(self.screenshot(display)), 100)
            display.do("key", "Return")
            self.wait_for(display, "Palpa - Tour: two minutes")
            self.screenshot(display)
            display.do("key", "ctrl+o")
            self.wait_for(display, "Palpa")
            self.assertIn("water/tour.toml",
                          (self.folder / "palpa" / "preferences.toml").read_text())
            self.screenshot(display)
            out = self.end(display)
        self.assertIn("Tour: two minutes", out)

    def test_a_structure_is_dropped_prepared_felt_recorded_saved_and_opened_again(self):
        structure = self.folder / "hairpin.pdb"
        exported = subprocess.run([PROGRAM, "export", ROOT / "scenes" / "hairpin", "-o", structure],
                                  capture_output=True, text=True)
        self.assertEqual(exported.returncode, 0, exported.stderr)
        prepared = self.folder / "data" / "palpa" / "scenes" / "hairpin"
        recording = self.folder / "Palpa" / "palpa-session-0001"
        with Display() as display:
            self.start(display)
            display.drop(self.wait_for(display, "Palpa"), structure)
            self.wait_until((prepared / "scene.toml").exists, "the prepared scene")
            self.screenshot(display)  # of the report
            display.do("key", "Return")
            self.wait_for(display, "Palpa - hairpin")
            self.screenshot(display)
            display.do("key", "F9")
            self.wait_until((recording / "journal.txt").exists, "the recording")
            display.do("keydown", "Right")
            time.sleep(1)
            display.do("keyup", "Right")
            display.do("key", "Insert")
            self.screenshot(display)
            display.do("key", "Return")  # adds a residue
            self.screenshot(display)
            self.wait_until(lambda: "add = " in (recording / "journal.txt").read_text(), "the edit")
            display.do("key", "ctrl+z")
            self.screenshot(display)
            display.do("key", "F9")
            journal = recording / "journal.txt.gz"
            self.wait_until(lambda: journal.exists() and not (recording / "journal.txt").exists()
                            and not (recording / "trace.csv").exists(), "the compressed recording")
            display.do("key", "ctrl+s")
            self.wait_until((prepared / "scene-2.toml").exists, "the saved scene")
            display.do("key", "ctrl+o")
            display.drop(self.wait_for(display, "Palpa"), prepared / "scene-2.toml")
            self.wait_for(display, "Palpa - hairpin")
            self.screenshot(display)
            # What was recorded is played again in the window, and nobody can change it.
            display.do("key", "ctrl+o")
            display.drop(self.wait_for(display, "Palpa"), journal)
            self.wait_for(display, "Palpa - hairpin")
            display.do("key", "Delete")
            time.sleep(4)
            self.screenshot(display)
            out = self.end(display)
        found = re.search(r"(\d+) of (\d+) rows compared with what was recorded: the same to the "
                          "last digit", out)
        self.assertTrue(found, out)
        self.assertGreater(int(found[1]), 500)
        played = subprocess.run([PROGRAM, "replay", recording, "--verify"], capture_output=True,
                                text=True)
        self.assertEqual(played.returncode, 0, played.stdout + played.stderr)

    def test_what_to_hold_is_chosen_while_the_structure_turns(self):
        structure = self.folder / "bridge.pdb"
        exported = subprocess.run([PROGRAM, "export", ROOT / "scenes" / "salt-bridge" / "vacuum.toml", "-o",
                                   structure], capture_output=True, text=True)
        self.assertEqual(exported.returncode, 0, exported.stderr)
        prepared = self.folder / "data" / "palpa" / "scenes" / "bridge"
        with Display() as display:
            self.start(display)
            display.drop(self.wait_for(display, "Palpa"), structure)
            def is_asked():
                """Something green is in the picture, what the hand would hold, and no card is chosen."""
                picture = self.screenshot(display)
                return not self.has_chosen_card(picture) and self.count_greens(picture) > 300

            self.wait_until(is_asked, "the question")
            first = read_png(self.screenshot(display))
            self.wait_until(lambda: read_png(self.screenshot(display)) != first, "a picture that turns")
            display.do("key", "Down")
            self.screenshot(display)
            display.do("key", "Return")
            self.wait_until((prepared / "scene.toml").exists, "the prepared scene")
            self.screenshot(display)  # of three lines
            display.do("key", "d")
            self.screenshot(display)  # and of the details
            display.do("key", "Return")
            self.wait_for(display, "Palpa - bridge")
            self.screenshot(display)
            self.end(display)
        text = (prepared / "scene.toml").read_text()
        self.assertIn('measured_on = "nowhere"', text)

    def test_structures_dropped_together_become_a_scene_each(self):
        structures = [self.folder / name for name in ("alpha.pdb", "omega.pdb", "broken.pdb")]
        for structure in structures[:2]:
            exported = subprocess.run([PROGRAM, "export", ROOT / "scenes" / "salt-bridge" / "vacuum.toml", "-o",
                                       structure], capture_output=True, text=True)
            self.assertEqual(exported.returncode, 0, exported.stderr)
        structures[2].write_text("ATOM  nothing that can be read\n")
        prepared = self.folder / "data" / "palpa" / "scenes"
        with Display() as display:
            self.start(display)
            display.drop(self.wait_for(display, "Palpa"), *structures)
            for name in ("alpha", "omega"):
                self.wait_until((prepared / name / "scene.toml").exists, name)
            self.wait_until(lambda: self.has_chosen_card(self.screenshot(display)), "the start screen")
            # Enter opens what the search finds, the first scene of one's own.
            display.do("key", "ctrl+f")
            for _ in range(2):  # the field has the keys in the next frame
                self.screenshot(display)
            display.do("type", "omega")
            self.screenshot(display)
            display.do("key", "Return")
            self.wait_for(display, "Palpa - omega")
            self.end(display)
        self.assertFalse((prepared / "broken").exists())

    def test_what_was_added_is_in_the_scene_that_is_saved(self):
        scene = self.folder / "water"
        shutil.copytree(ROOT / "scenes" / "water", scene)
        with Display() as display:
            self.start(display, scene / "scene.toml")
            self.wait_for(display, "Palpa - Two waters")
            self.screenshot(display)
            display.do("key", "Insert")
            self.screenshot(display)
            display.do("key", "Return")
            self.screenshot(display)
            self.screenshot(display)
            display.do("key", "ctrl+s")
            self.wait_until((scene / "scene-2.toml").exists, "the saved scene")
            self.end(display)
        self.assertIn("[molecules.w2]", (scene / "scene-2.toml").read_text())
        self.check_that_it_plays(scene / "scene-2.toml")

        # What is changed then is in the next one.
        self.shots = 0
        for shot in (self.folder / "Palpa").glob("palpa-*.png"):
            shot.unlink()
        with Display() as display:
            self.start(display, scene / "scene-2.toml")
            self.wait_for(display, "Palpa - Two waters")
            self.screenshot(display)
            display.do("key", "Delete")
            self.screenshot(display)
            self.screenshot(display)
            display.do("key", "ctrl+s")
            self.wait_until((scene / "scene-2-2.toml").exists, "the saved scene")
            self.end(display)
        text = (scene / "scene-2-2.toml").read_text()
        self.assertIn("[molecules.w2]", text)
        self.assertNotIn("[molecules.moved]", text)
        self.check_that_it_plays(scene / "scene-2-2.toml")

    def check_that_it_plays(self, scene):
        played = subprocess.run([PROGRAM, "run", scene, "--headless", "--seconds", "0.1"],
                                capture_output=True, text=True)
        self.assertEqual(played.returncode, 0, played.stderr)

    def serve_entries(self):
        """1abc is the hairpin, of 5sta only the beginning comes."""
        structure = self.folder / "1abc.cif"
        exported = subprocess.run([PROGRAM, "export", ROOT / "scenes" / "hairpin", "-o", structure],
                                  capture_output=True, text=True)
        self.assertEqual(exported.returncode, 0, exported.stderr)
        server = EntryServer({"1abc": packed(structure.read_text()), "5sta": stalled(b"\x1f\x8b\x08")})
        self.addCleanup(server.stop)
        structure.unlink()
        (self.folder / "palpa").mkdir()
        (self.folder / "palpa" / "preferences.toml").write_text(
            f'download_from = "{server.base}"\ndownload_stall_seconds = 3600\n')
        return server

    def test_an_entry_is_downloaded_by_its_code_and_from_the_cache_by_its_link(self):
        server = self.serve_entries()
        scenes = self.folder / "data" / "palpa" / "scenes"
        with Display() as display:
            self.start(display)
            self.wait_for(display, "Palpa")
            display.do("key", "p")
            self.screenshot(display)
            display.do("type", "1ABC")
            display.do("key", "Return")
            self.wait_until((scenes / "1abc" / "scene.toml").exists, "the prepared scene")
            self.screenshot(display)  # of the report
            display.do("key", "Return")
            self.wait_for(display, "Palpa - 1abc")
            self.screenshot(display)
            link = types.SimpleNamespace(as_uri=lambda: "https://www.rcsb.org/structure/1ABC")
            display.drop(self.wait_for(display, "Palpa - 1abc"), link)
            self.wait_until((scenes / "1abc-2" / "scene.toml").exists, "the scene of the cache")
            self.screenshot(display)
            display.do("key", "Escape")
            self.wait_for(display, "Palpa")
            self.screenshot(display)
            self.end(display)
        self.assertEqual(server.asked, ["/1abc.cif.gz"])

    def count_reds(self, picture):
        """Of messages about what is wrong."""
        (width, height), pixels = read_png(picture)
        return sum(pixels[i] > 150 and pixels[i + 1] < 60 and pixels[i + 2] < 60
                   for i in range(4 * width * (height // 10), 4 * width * (height // 2), 4)
                   if i % (4 * width) > 3 * width)

    def test_a_download_is_cancelled_and_a_code_that_is_none_is_explained(self):
        server = self.serve_entries()
        with Display() as display:
            self.start(display)
            self.wait_for(display, "Palpa")
            display.do("key", "p")
            self.screenshot(display)
            display.do("type", "5sta")
            display.do("key", "Return")
            self.wait_until(lambda: server.asked == ["/5sta.cif.gz"], "the request")
            display.do("key", "Escape")
            # The cards of the start screen.
            self.wait_until(lambda: self.count_greens(self.screenshot(display)) > 100, "the cards")
            reds = self.count_reds(self.screenshot(display))
            display.do("key", "p")
            self.screenshot(display)
            display.do("type", "water")
            display.do("key", "Return")
            self.wait_until(lambda: self.count_reds(self.screenshot(display)) > reds + 50, "the message")
            self.end(display)
        self.assertEqual(server.asked, ["/5sta.cif.gz"])

    def test_a_file_that_is_none_is_explained_on_the_start_screen(self):
        (self.folder / "broken.toml").write_text("title = 3\n")
        with Display() as display:
            self.start(display, self.folder / "broken.toml")
            self.wait_for(display, "Palpa")
            (width, height), pixels = read_png(self.screenshot(display))
            reds = sum(pixels[i] > 150 and pixels[i + 1] < 60
                       for i in range(4 * width * (height - 80), 4 * width * height, 4))
            self.assertGreater(reds, 50)
            self.end(display)


if __name__ == "__main__":
    unittest.main()
