"""palpa render from outside: a picture without a display, and one clear line where there is none."""
import os
import shutil
import struct
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

sys.path.append(str(Path(__file__).resolve().parents[1] / "support"))
from read_png import read_png  # noqa: E402

PROGRAM = os.environ["PALPA_PROGRAM"]
WATER = Path(os.environ["PALPA_ROOT"]) / "scenes" / "water"


class Render(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.image = Path(self.folder.name) / "water.png"

    def tearDown(self):
        self.folder.cleanup()

    def render(self, *arguments, scene=WATER, **environment):
        clean = {key: value for key, value in os.environ.items()
                 if key not in ("DISPLAY", "WAYLAND_DISPLAY")}
        return subprocess.run([PROGRAM, "render", scene, "--overwrite", *map(str, arguments)], capture_output=True,
                              text=True, env={**clean, **environment})

    def size_of_image(self):
        data = self.image.read_bytes()
        self.assertEqual(data[:8], b"\x89PNG\r\n\x1a\n")
        return struct.unpack(">II", data[16:24])

    def assert_bad_input(self, result, expected):
        self.assertEqual(result.returncode, 2, result.stderr)
        self.assertEqual(len(result.stderr.strip().splitlines()), 1, result.stderr)
        self.assertIn(expected, result.stderr)
        self.assertFalse(self.image.exists())

    def test_a_picture_needs_no_display(self):
        for look in ("ball-and-stick", "space-filling", "licorice", "in-hand", "pocket"):
            with self.subTest(look=look):
                result = self.render("-o", self.image, "--size", "64x48", "--as", look)
                self.assertEqual(result.returncode, 0, result.stderr)
                self.assertEqual(self.size_of_image(), (64, 48))

    def test_time_moves_the_molecule(self):
        pictures = []
        for time in (0, 3):
            self.assertEqual(self.render("-o", self.image, "--size", "64x48", "--time",
                                         time).returncode, 0)
            pictures.append(self.image.read_bytes())
        self.assertNotEqual(*pictures)

    def test_the_atoms_are_written_too_where_the_picture_has_them(self):
        places = Path(self.folder.name) / "water.crd"
        oxygens = []
        for time in (0, 3):
            result = self.render("-o", self.image, "--size", "64x48", "--time", time, "--coordinates", places)
            self.assertEqual(result.returncode, 0, result.stderr)
            rows = [line.split() for line in places.read_text().splitlines() if not line.startswith("*")]
            oxygens.append([list(map(float, row[4:7])) for row in rows[1:] if row[3].startswith("O")])
        # At first both stand as in their file; then one is 3 Å and less from the other, and bonded to it.
        apart = [sum((a - b) ** 2 for a, b in zip(*pair)) ** 0.5 for pair in oxygens]
        self.assertNotAlmostEqual(*apart, places=2)
        self.assertLess(apart[1], 3)
        self.assertIn("6 atoms, hydrogen bonds in all: 1", result.stdout)
        kept = places.read_text()
        result = subprocess.run([PROGRAM, "render", WATER, "-o", self.image.with_name("other.png"),
                                 "--coordinates", places], capture_output=True, text=True)
        self.assertEqual(result.returncode, 2)
        self.assertIn("water.crd", result.stderr)
        self.assertEqual(places.read_text(), kept)

    def test_a_saved_view_is_seen_as_its_camera_says(self):
        scene = Path(shutil.copytree(WATER, Path(self.folder.name) / "views")) / "scene.toml"
        with scene.open("a") as file:
            file.write('\n[[view.saved]]\nname = "from above"\ncamera = [0.0, 80.0, 1.0]\n'
                       'representation = "space-filling"\n'
                       '[[view.saved]]\nname = "the other"\nlook_at = "molecule moved"\n'
                       '[[view.saved.layers]]\nrepresentation = "space-filling"\n'
                       'of = "molecule moved"\n')
        pictures = []
        for choice in ((), ("--view", "from above"), ("--view", "the other")):
            result = self.render("-o", self.image, "--size", "64x48", *choice, scene=scene)
            self.assertEqual(result.returncode, 0, result.stderr)
            pictures.append(self.image.read_bytes())
            if "from above" in choice:
                above = shutil.copy(self.image, Path(self.folder.name) / "above.png")
        self.assertEqual(len(set(pictures)), 3)
        # All atoms are framed in both ways, so that the same camera sees the same picture.
        self.render("-o", self.image, "--size", "64x48", "--camera", "0,80", "--as",
                    "space-filling", scene=scene)
        (_, one), (_, other) = read_png(above), read_png(self.image)
        self.assertLess(sum(abs(a - b) for a, b in zip(one, other)) / len(one), 20)
        self.image.unlink()
        self.assert_bad_input(
            self.render("-o", self.image, "--view", "from abuve", scene=scene),
            "did you mean 'from above'?")
        self.assert_bad_input(self.render("-o", self.image, "--view", "x"), "[[view.saved]]")
        self.assertNotEqual(self.render("-o", self.image, "--view", "from above",
                                        "--camera", "0,0", scene=scene).returncode, 0)

    def test_the_same_picture_twice_is_the_same_to_the_byte(self):
        pictures = []
        for _ in range(2):
            self.render("-o", self.image, "--size", "160x90")
            pictures.append(self.image.read_bytes())
        self.assertEqual(*pictures)

    def test_the_camera_turns_comes_nearer_and_looks_at_a_molecule(self):
        pictures = []
        for choice in ((), ("--camera", "40,20"), ("--camera", "40,20,2"),
                       ("--look-at", "moved"), ("--samples", "4")):
            result = self.render("-o", self.image, "--size", "64x48", *choice)
            self.assertEqual(result.returncode, 0, result.stderr)
            self.assertEqual(self.size_of_image(), (64, 48))
            pictures.append(self.image.read_bytes())
        self.assertEqual(len(set(pictures)), len(pictures))
        self.image.unlink()
        for camera in ("40", "a,b", "1,2,0", "1,91", "1,2,3,4"):
            self.assert_bad_input(self.render("-o", self.image, f"--camera={camera}"),
                                  "expected AZIMUTH,ELEVATION[,ZOOM]")
        self.assert_bad_input(self.render("-o", self.image, "--look-at", "fixd"),
                              "did you mean 'fixed'?")
        self.assert_bad_input(self.render("-o", self.image, "--colour", "chan"),
                              "did you mean 'chain'?")
        self.assert_bad_input(self.render("-o", self.image, "--samples", "5"), "--samples")

    def draw(self, *arguments):
        result = self.render("-o", self.image, "--size", "160x90", *arguments)
        self.assertEqual(result.returncode, 0, result.stderr)
        return self.image.read_bytes()

    def test_the_scene_says_how_it_is_seen_and_options_say_it_again(self):
        plain = self.draw()
        for key, value, *option in (("representation", "licorice", "--representation", "licorice"),
                                    ("representation", "space-filling", "--as", "space-filling"),
                                    ("colour", "element", "--colour", "element"),
                                    ("camera", "[-50, 30, 1.5]", "--camera=-50,30,1.5"),
                                    ("look_at", "fixed", "--look-at", "fixed")):
            with self.subTest(key=key):
                said = self.draw("--set", f"view.{key}={value}")
                self.assertEqual(said, self.draw(*option))
                # Two waters have no carbon, so their colours are those of the elements either way.
                self.assertEqual(said == plain, key == "colour")
                self.assertEqual(said, self.draw("--set", f"view.{key}={value}", *option))

    WORDS = ("--hydrogen-bonds", "none", "--no-arrow", "--colour", "element", "--camera", "0,0")

    def pixels(self, *arguments, size="320x240", **environment):
        result = self.render("-o", self.image, "--size", size, *self.WORDS, *arguments, **environment)
        self.assertEqual(result.returncode, 0, result.stderr)
        (self.width, _), data = read_png(self.image)
        return data, result.stderr

    def differing(self, one, other):
        """Pixels, as (x, y), that two pictures of the same size have otherwise."""
        return [(i // 4 % self.width, i // 4 // self.width)
                for i in range(0, len(one), 4) if one[i:i + 4] != other[i:i + 4]]

    def test_hydrogens_shadows_crevices_and_outlines_are_chosen(self):
        def pixels(*options):
            result = self.render("-o", self.image, "--size", "200x120", "--no-words", "--no-arrow",
                                 "--hydrogen-bonds", "none", *options)
            self.assertEqual(result.returncode, 0, result.stderr)
            size, picture = read_png(self.image)
            return [tuple(picture[4 * i:4 * i + 3]) for i in range(size[0] * size[1])]

        def dark(picture):
            return sum(max(pixel) < 60 for pixel in picture)

        plain = pixels("--camera", "30,15")
        oxygens = pixels("--camera", "30,15", "--hydrogens", "none")
        self.assertEqual(plain, pixels("--camera", "30,15", "--hydrogens", "polar"))
        self.assertEqual(plain, pixels("--camera", "30,15", "--set", "view.hydrogens=polar"))
        self.assertNotEqual(plain, oxygens)
        filled = ("--as", "space-filling", "--camera", "30,15")
        self.assertEqual(pixels(*filled), pixels(*filled, "--shadows", "none"))
        light = sum(map(sum, pixels(*filled)))
        self.assertLess(sum(map(sum, pixels(*filled, "--shadows", "soft"))), light)
        self.assertLess(light, sum(map(sum, pixels(*filled, "--no-occlusion"))))
        widths = [dark(pixels(*filled, "--outline", width)) for width in (0, 1, 3)]
        self.assertLess(widths[0], widths[1])
        self.assertLess(2 * widths[1] - widths[0], widths[2])
        self.image.unlink()
        self.assert_bad_input(self.render("-o", self.image, "--hydrogens", "some"), "polar")
        self.assert_bad_input(self.render("-o", self.image, "--shadows", "hard"), "soft")

    def test_a_label_stands_beside_what_it_names(self):
        named = ("--label", "name OH2 and segment FIX")
        result = subprocess.run([PROGRAM, "select", WATER, named[1]], capture_output=True, text=True)
        self.assertEqual(result.returncode, 0, result.stderr)
        plain, _ = self.pixels()
        worded, said = self.pixels(*named)
        self.assertEqual(said, "")
        written = self.differing(plain, worded)
        self.assertGreater(len(written), 200)
        xs, ys = zip(*written)
        # Of 12 pixels a letter: some ten letters in one line, with the halo.
        self.assertLess(max(ys) - min(ys), 24)
        self.assertLess(max(xs) - min(xs), 140)
        self.assertGreater(max(xs) - min(xs), 40)
        dark = sum(max(worded[4 * (y * self.width + x):][:3]) < 64 for x, y in written)
        light = sum(min(worded[4 * (y * self.width + x):][:3]) > 192 for x, y in written)
        self.assertGreater(dark, 50)
        self.assertGreater(light + dark, len(written) / 3)
        # Without words the label is none, and with twice the pixels it is twice as large.
        self.assertEqual(self.pixels(*named, "--no-words")[0], plain)
        large_plain, _ = self.pixels(size="1440x1080")
        large = self.differing(large_plain, self.pixels(*named, size="1440x1080")[0])
        large_height = max(y for _, y in large) - min(y for _, y in large)
        self.assertAlmostEqual(large_height / (max(ys) - min(ys)), 2, delta=0.35)

    def test_words_are_drawn_after_samples_are_averaged(self):
        named = ("--label", "name OH2 and segment FIX")
        bare, worded, bare_16, worded_16 = (
            self.pixels(*more)[0] for more in ((), named, ("--samples", 16), (*named, "--samples", 16)))
        white = b"\xff" * 4
        on_white = [i for i in range(0, len(bare), 4) if bare[i:i + 4] == white == bare_16[i:i + 4]]
        written = [i for i in on_white if worded[i:i + 4] != white]
        self.assertGreater(len(written), 40)
        self.assertTrue(all(worded[i:i + 4] == worded_16[i:i + 4] for i in on_white))

    def test_colours_that_need_it_have_a_legend_in_the_corner(self):
        plain, _ = self.pixels("--colour", "charge", "--no-words")
        legend = self.differing(plain, self.pixels("--colour", "charge")[0])
        self.assertGreater(len(legend), 300)
        self.assertLess(max(x for x, _ in legend), 200)
        self.assertGreater(min(y for _, y in legend), 120)
        # Of its colour at -1 e, 0 and 1 e only the middle is white.
        self.assertEqual(self.pixels("--no-words"), self.pixels())  # elements are known without

    def test_without_a_font_there_is_a_warning_and_a_picture(self):
        named = ("--label", "name OH2")
        plain, _ = self.pixels("--no-words", *named)
        for font in ("/nowhere/font.ttf", str(WATER / "scene.toml")):
            with self.subTest(font=font):
                bare, said = self.pixels(*named, PALPA_FONT=font)
                self.assertEqual(bare, plain)
                self.assertEqual(said.count("without words"), 1, said)
                self.assertEqual(len(said.strip().splitlines()), 1, said)
                self.assertEqual(self.pixels(*named, "--no-words", PALPA_FONT=font), (plain, ""))

    def test_labels_without_room_are_counted(self):
        _, said = self.pixels("--label", "name OH2", size="48x12")  # a line is higher than that
        self.assertRegex(said, r"^note: \d+ of \d+ labels found no room")

    def test_marks_are_drawn_on_request_by_options_as_by_the_scene(self):
        apart = ("--set", "hand.start_angstrom=4.5")
        for size, *option, key in (
                (1500, "--measure", "segment FIX and name OH2; segment MOV and name OH2",
                 'measure=["segment FIX and name OH2; segment MOV and name OH2"]'),
                (300, "--measure", "name H1 and segment MOV; name OH2 and segment MOV; name H2 and segment MOV",
                 'measure=["name H1 and segment MOV; name OH2 and segment MOV; name H2 and segment MOV"]'),
                (100, "--forces", "residues", "forces=residues"),
                (100, "--ghost", "ghost=true")):
            with self.subTest(option=option):
                marked, said = self.pixels(*apart, *option)
                self.assertEqual(said, "")
                self.assertEqual(marked, self.pixels(*apart, "--set", f"view.{key}")[0])
                self.assertGreater(len(self.differing(self.pixels(*apart)[0], marked)), size // 5)
        # Oxygens 2.3 Å apart clash, as the hand's hydrogens point away; a film of 4 s has a trail at its end.
        near = ("--set", "hand.start_angstrom=2.3")
        clash, _ = self.pixels(*near, "--contacts", "in-hand")
        self.assertEqual(clash, self.pixels(*near, "--contacts")[0])
        self.assertNotEqual(clash, self.pixels(*near, "--contacts", "none")[0])
        self.assertEqual(self.pixels(*near, "--contacts", "none"), self.pixels(*near))

    def test_ghost_and_trail_are_of_the_time_before_the_picture(self):
        played = ("--time", "2", "--set", "hand.stroke=in-out")
        plain, _ = self.pixels(*played)
        for option in (("--ghost",), ("--trail", "2")):
            with self.subTest(option=option):
                marked = self.differing(plain, self.pixels(*played, *option)[0])
                self.assertGreater(len(marked), 50)
        short = self.differing(plain, self.pixels(*played, "--trail", "0.2")[0])
        self.assertLess(len(short), len(self.differing(plain, self.pixels(*played, "--trail", "2")[0])))

    def test_a_measure_that_is_none_is_refused(self):
        for measure, expected in (("name OH2", "--measure: 'name OH2' has 1 selection; expected two for a distance, three"),
                                  ("all; nme OH2", "--measure, column 6")):
            with self.subTest(measure=measure):
                self.assert_bad_input(self.render("-o", self.image, "--measure", measure), expected)
        _, said = self.pixels("--measure", "name OH2; name XX")
        self.assertIn("no atom matches 2nd of view.measure = 'name OH2; name XX'", said)

    def test_clip_leaves_out_what_is_in_front(self):
        # From the left the fixed water stands before the moved one.
        view = ("--camera=-90,0", "--as", "space-filling", "--set", "hand.start_angstrom=3")
        whole, clipped = self.draw(*view), self.draw(*view, "--clip")
        self.assertNotEqual(whole, clipped)
        self.assertEqual(clipped, self.draw(*view, "--set", "view.clip=true"))
        self.assertEqual(whole, self.draw(*view, "--set", "view.clip=true", "--no-clip"))

    def run_recorded(self, *arguments, **environment):
        clean = {key: value for key, value in os.environ.items()
                 if key not in ("DISPLAY", "WAYLAND_DISPLAY")}
        recording = Path(self.folder.name) / "recording"
        result = subprocess.run([PROGRAM, "run", WATER, "--headless", "--overwrite", "--seconds", "2", "--record",
                                 recording, *arguments], capture_output=True, text=True,
                                env={**clean, **environment})
        return result, recording

    def test_a_recording_has_frames_on_the_virtual_clock(self):
        result, recording = self.run_recorded("--fps", "4", "--frame-size", "64x48")
        self.assertEqual(result.returncode, 0, result.stderr)
        frames = sorted(path.name for path in (recording / "frames").iterdir())
        self.assertEqual(frames, [f"{i:04}.png" for i in range(8)])
        first, last = ((recording / "frames" / frames[i]).read_bytes() for i in (0, -1))
        self.assertNotEqual(first, last)

        again, _ = self.run_recorded("--fps", "1", "--frame-size", "64x48")
        self.assertEqual(again.returncode, 0, again.stderr)
        self.assertEqual(len(list((recording / "frames").iterdir())), 2)
        self.assertEqual((recording / "frames" / "0000.png").read_bytes(), first)

    def test_frames_of_a_recording_have_words(self):
        frames = []
        for font in ({}, {"PALPA_FONT": "/nowhere/font.ttf"}):
            result, recording = self.run_recorded("--fps", "1", "--frame-size", "160x120", **font)
            self.assertEqual(result.returncode, 0, result.stderr)
            self.assertEqual(result.stderr.count("without words"), len(font), result.stderr)
            frames.append((recording / "frames" / "0000.png").read_bytes())
        self.assertNotEqual(*frames)

    def test_without_vulkan_the_trace_is_still_written(self):
        self.run_recorded("--fps", "1", "--frame-size", "64x48")
        result, recording = self.run_recorded("--fps", "4", VK_DRIVER_FILES="/nowhere",
                                              VK_ICD_FILENAMES="/nowhere")
        self.assertEqual(result.returncode, 0, result.stderr)
        said = [line for line in result.stderr.splitlines() if "frames cannot be drawn" in line]
        self.assertEqual(len(said), 1, result.stderr)
        self.assertEqual(len((recording / "trace.csv").read_text().splitlines()), 2001)
        self.assertFalse((recording / "frames").exists())

    def test_sizes_that_are_none(self):
        for size in ("0x10", "10x0", "10", "axb", "-1x5", "1e3x5"):
            with self.subTest(size=size):
                self.assert_bad_input(self.render("-o", self.image, "--size", size), "is not a size")
        self.assert_bad_input(self.render("-o", self.image, "--size", "99999x99999"),
                              "has more than")

    def test_what_cannot_be_drawn_or_written(self):
        self.assert_bad_input(self.render("-o", self.image, "--as", "liquorice"),
                              "did you mean 'licorice'?")
        self.assert_bad_input(self.render("-o", Path(self.folder.name) / "no" / "a.png"),
                              "is in a folder that does not exist")
        self.assert_bad_input(self.render("-o", self.image, VK_DRIVER_FILES="/nowhere",
                                          VK_ICD_FILENAMES="/nowhere"), "Vulkan")


if __name__ == "__main__":
    unittest.main()
