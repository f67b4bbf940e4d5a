"""palpa render --film from outside: a film by ffmpeg, or its pictures where that is not installed."""
import json
import os
import shutil
import struct
import subprocess
import tempfile
import unittest
from pathlib import Path

PROGRAM = os.environ["PALPA_PROGRAM"]
WATER = Path(os.environ["PALPA_ROOT"]) / "scenes" / "water"


class Film(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)
        self.tmp = Path(self.folder.name)
        self.film, self.frames = self.tmp / "water.mp4", self.tmp / "water.mp4-frames"

    def render(self, *arguments, code=0, **environment):
        clean = {key: value for key, value in os.environ.items() if key not in ("DISPLAY", "WAYLAND_DISPLAY")}
        size = () if "--size" in arguments else ("--size", "64x48")
        result = subprocess.run([PROGRAM, "render", WATER, *size, *map(str, arguments)],
                                capture_output=True, text=True, env={**clean, **environment})
        self.assertEqual(result.returncode, code, result.stderr + result.stdout)
        return result

    def test_a_film_of_a_second_has_its_frames_and_its_size(self):
        if not shutil.which("ffmpeg"):
            return
        self.render("--film", self.film, "--seconds", 1, "--fps", 10)
        self.assertFalse(self.frames.exists())
        if not shutil.which("ffprobe"):
            return
        probed = subprocess.run(["ffprobe", "-v", "error", "-count_frames", "-show_streams", "-of", "json", self.film],
                                capture_output=True, text=True)
        stream, = json.loads(probed.stdout)["streams"]
        self.assertEqual([stream["nb_read_frames"], stream["width"], stream["height"], stream["r_frame_rate"]],
                         ["10", 64, 48, "10/1"])

    def test_without_ffmpeg_there_are_pictures(self):
        result = self.render("--film", self.film, "--seconds", 0.5, "--fps", 10, PATH=str(self.tmp), code=1)
        self.assertIn("ffmpeg is not installed", result.stdout)
        names = sorted(path.name for path in self.frames.iterdir())
        self.assertEqual(names, [f"{i:05}.png" for i in range(5)])
        sizes = [struct.unpack(">II", (self.frames / name).read_bytes()[16:24]) for name in names]
        self.assertEqual(set(sizes), {(64, 48)})
        self.assertFalse(self.film.exists())
        self.render("--film", self.film, "--seconds", 0.5, "--fps", 10, PATH=str(self.tmp), code=2)
        self.render("--film", self.film, "--seconds", 0.2, "--fps", 10, "--overwrite", PATH=str(self.tmp),
                    code=1)
        self.assertEqual(len(list(self.frames.iterdir())), 2)

    def test_a_name_without_an_ending_is_a_folder_of_pictures(self):
        folder = self.tmp / "water"
        result = self.render("--film", folder, "--seconds", 0.5, "--fps", 10, PATH=str(self.tmp))
        self.assertIn(f"{folder}: 5 pictures of 64x48\n", result.stdout)
        self.assertEqual(sorted(path.name for path in folder.iterdir()), [f"{i:05}.png" for i in range(5)])
        self.render("--film", folder, "--seconds", 0.5, "--fps", 10, code=2)
        self.render("--film", folder, "--seconds", 0.2, "--fps", 10, "--overwrite")
        self.assertEqual(len(list(folder.iterdir())), 2)
        (folder / "notes.txt").write_text("somebody's")
        self.render("--film", folder, "--seconds", 0.2, "--fps", 10, "--overwrite", code=2)

    def test_a_film_that_fails_is_a_failure(self):
        broken = self.tmp / "ffmpeg"
        broken.write_text("#!/bin/sh\necho no encoder >&2\nexit 1\n")
        broken.chmod(0o755)
        path = f"{self.tmp}{os.pathsep}{os.environ['PATH']}"
        result = self.render("--film", self.film, "--seconds", 0.2, "--fps", 10, PATH=path, code=1)
        self.assertIn("no encoder", result.stdout)

    def test_a_film_begins_after_time_and_is_what_pictures_show(self):
        self.render("--film", self.film, "--seconds", 0.1, "--fps", 10, "--time", 1, PATH=str(self.tmp),
                    code=1)
        self.render("-o", self.tmp / "start.png")
        first, = self.frames.iterdir()
        self.assertNotEqual(first.read_bytes(), (self.tmp / "start.png").read_bytes())

    def test_the_pictures_of_a_film_have_words(self):
        def frames(*more, **environment):
            result = self.render("--film", self.film, "--seconds", 0.2, "--fps", 10, "--size", "160x120", "--overwrite",
                                 *more, PATH=str(self.tmp), code=1, **environment)
            return [path.read_bytes() for path in sorted(self.frames.iterdir())], result.stderr

        worded, said = frames()
        bare, _ = frames("--no-words")
        self.assertEqual(said, "")
        self.assertEqual([a == b for a, b in zip(worded, bare)], [False, False])
        unfonted, said = frames(PALPA_FONT="/nowhere/font.ttf")
        self.assertEqual(unfonted, bare)
        self.assertEqual(said.count("without words"), 1, said)
        self.assertEqual(len(said.splitlines()), 1, said)

    def test_nothing_is_overwritten_unless_asked_and_ours(self):
        self.film.write_bytes(b"somebody's")
        for more in ((), ("--overwrite",)):
            self.render("--film", self.film, "--seconds", 0.1, *more, code=2)
        self.assertEqual(self.film.read_bytes(), b"somebody's")
        self.film.unlink()
        if not shutil.which("ffmpeg"):
            return
        for more, code in (((), 0), ((), 2), (("--overwrite",), 0)):
            self.render("--film", self.film, "--seconds", 0.2, "--fps", 10, *more, code=code)

    def test_what_does_not_go_together_is_refused(self):
        for arguments, expected in ((("--film", self.tmp / "water.gif"), ".mp4"),
                                    (("--film", self.film, "-o", self.tmp / "a.png"), "one output"),
                                    ((), "-o FILE.png"), (("-o", self.tmp / "a.png", "--seconds", 1), "--film")):
            result = self.render(*arguments, code=2)
            self.assertIn(expected, result.stderr)


if __name__ == "__main__":
    unittest.main()
