"""tools/scripts/make_tour_film: its parts name scenes and views that are there; a few pictures of one part are drawn."""
import importlib.machinery
import importlib.util
import os
import struct
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

PROGRAM = os.environ["PALPA_PROGRAM"]
ROOT = Path(os.environ["PALPA_ROOT"])
SCRIPT = ROOT / "tools" / "scripts" / "make_tour_film"


def read_script():
    loader = importlib.machinery.SourceFileLoader("make_tour_film", str(SCRIPT))
    module = importlib.util.module_from_spec(importlib.util.spec_from_loader(loader.name, loader))
    sys.modules[loader.name] = module  # where dataclasses look for it
    sys.dont_write_bytecode = True
    loader.exec_module(module)
    return module


class TourFilm(unittest.TestCase):
    def setUp(self):
        temporary = tempfile.TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        self.tmp = Path(temporary.name)

    def make(self, *arguments, **environment):
        return subprocess.run([sys.executable, SCRIPT, *map(str, arguments)], capture_output=True, text=True, cwd=self.tmp,
                              env={**os.environ, **environment})

    def test_parts_name_scenes_that_are_there_and_last_ninety_seconds(self):
        parts = read_script().PARTS
        self.assertEqual((parts[0].name, parts[-1].name), ("title", "end"))
        self.assertEqual(len({part.name for part in parts}), len(parts))
        self.assertAlmostEqual(sum(part.film_s for part in parts), 90, delta=5)
        for part in parts[1:-1]:
            with self.subTest(part=part.name):
                scene = ROOT / "scenes" / part.scene
                self.assertTrue((scene / "scene.toml").exists() or scene.with_suffix(".toml").exists())
                self.assertLessEqual(len(part.heading), 60)  # it fits into a line
                self.assertLessEqual(len(part.text), 110)

    def test_two_pictures_of_a_part_are_drawn_in_the_size_of_the_film(self):
        result = self.make("film.mp4", "--pictures", "pictures", "--part", "water", "--frames", 2)
        self.assertEqual(result.returncode, 0, result.stderr)
        pictures = sorted((self.tmp / "pictures" / "water").iterdir())
        self.assertEqual([path.name for path in pictures], ["00000.png", "00001.png"])
        for picture in pictures:
            self.assertEqual(struct.unpack(">II", picture.read_bytes()[16:24]), (1280, 610))
        self.assertFalse((self.tmp / "film.mp4").exists())

    def test_a_film_that_is_there_is_not_replaced(self):
        (self.tmp / "film.mp4").write_text("mine")
        result = self.make("film.mp4", "--part", "title")
        self.assertEqual(result.returncode, 1)
        self.assertIn("is there already", result.stderr)
        self.assertEqual((self.tmp / "film.mp4").read_text(), "mine")

    def test_without_ffmpeg_it_says_how_to_install_it(self):
        result = self.make("film.mp4", "--part", "title", PATH=str(self.tmp))
        self.assertEqual(result.returncode, 1)
        self.assertIn("apt install ffmpeg", result.stderr)

    def test_the_film_in_the_repository_is_small(self):
        film = (ROOT / "scenes" / "tour.mp4").read_bytes()
        self.assertLess(len(film), 5_000_000)
        self.assertEqual(film[4:8], b"ftyp")
        self.assertIn(b"moov", film[:200_000])  # before the pictures, so that it plays while it loads


if __name__ == "__main__":
    unittest.main()
