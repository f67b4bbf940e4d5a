"""Small pictures of the bundled scenes against those in tests/data/pictures, with a tolerance.

Their bytes differ between classes of processors and drivers, at silhouettes most of all. To make them
anew after a change that is meant, from the repository's root, and look at each before it is kept:
    PALPA_PROGRAM=build/release/bin/palpa PALPA_ROOT=. python3 tests/tools/pictures_test.py --remake
"""
import os
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

PROGRAM = os.environ["PALPA_PROGRAM"]
ROOT = Path(os.environ["PALPA_ROOT"])
sys.path.append(str(ROOT / "tests" / "support"))
from read_png import MOST_DIFFERENT, MOST_MEAN, difference, read_png  # noqa: E402

PICTURES = ROOT / "tests" / "data" / "pictures"
CAMERAS = {"water": "30,15", "hiv": "90,15"}
LOOKS = ("ball-and-stick", "space-filling", "licorice", "in-hand", "pocket", "lines", "cartoon",
         "surface")
# Of the protease, as a cartoon with a surface of its pocket.
COLOURS = ("element", "chain", "residue", "structure", "charge", "b-factor", "force",
           "potential", "hydrophobicity")
# Of the protease whose joints answer the hand.
ANSWERS = ("activity", "error")
# Contacts and forces of residues of the inhibitor, and from one flap to the other over its centre.
MARKS = ("--contacts", "in-hand", "--forces", "residues", "--hydrogen-bonds", "none", "--look-at", "inhibitor",
         "--measure", "chain A and resid 50 and name CA; ligand; chain B and resid 50 and name CA")



def draw(scene, image, *options):
    subprocess.run([PROGRAM, "render", ROOT / "scenes" / scene, "-o", image, "--size", "192x128",
                    "--samples", "4", "--no-words", *options], check=True, stdout=subprocess.DEVNULL)


def pictures():
    """Name, scene and options of each."""
    for scene, camera in CAMERAS.items():
        for look in LOOKS:
            yield f"{scene}-{look}.png", scene, ("--as", look, "--camera", camera)
    yield "hiv-marks.png", "hiv", MARKS
    yield "water-past.png", "water", ("--time", "2", "--set", "hand.stroke=in-out", "--ghost", "--trail", "2",
                                      "--camera", "30,15")
    for colour in COLOURS:
        yield (f"hiv-coloured-{colour}.png", "hiv",
               ("--representation", "cartoon", "--colour", colour, "--representation", "surface",
                "--of", "protein and within 8 of ligand", "--colour", colour, "--opacity", "0.5"))
    for colour in ANSWERS:
        yield (f"hiv-coloured-{colour}.png", "hiv/flexible.toml",
               ("--representation", "cartoon", "--colour", colour, "--time", "3", "--camera", "90,15"))


class Pictures(unittest.TestCase):
    def test_scenes_look_as_they_did(self):
        with tempfile.TemporaryDirectory() as folder:
            for name, scene, options in pictures():
                with self.subTest(picture=name):
                    image = Path(folder) / name
                    draw(scene, image, *options)
                    self.assert_alike(image, PICTURES / name)

    def assert_alike(self, image, golden):
        size, new = read_png(image)
        golden_size, old = read_png(golden)
        self.assertEqual(size, golden_size)
        different, mean = difference(new, old)
        self.assertLess(different, MOST_DIFFERENT, "share of pixels that differ")
        self.assertLess(mean, MOST_MEAN, "mean difference")

    def test_another_picture_is_told_apart(self):
        with self.assertRaises(AssertionError):
            self.assert_alike(PICTURES / "water-licorice.png",
                              PICTURES / "water-ball-and-stick.png")


if __name__ == "__main__":
    if sys.argv[1:] == ["--remake"]:
        for made_name, made_scene, made_options in pictures():
            (PICTURES / made_name).unlink(missing_ok=True)
            draw(made_scene, PICTURES / made_name, *made_options)
    else:
        unittest.main()
