"""tools/scripts/fuzz: what it refuses, and that no fuzzer is forgotten."""
import os
import subprocess
import unittest
from pathlib import Path

ROOT = Path(os.environ["PALPA_ROOT"])


def fuzz(*arguments):
    return subprocess.run([ROOT / "tools" / "scripts" / "fuzz", *arguments], capture_output=True,
                          text=True)


class Fuzz(unittest.TestCase):
    def test_what_is_no_time_or_no_fuzzer_is_refused_before_anything_is_built(self):
        for arguments, said in (([], "expected a number"), (["ten"], "MINUTES is 'ten'"),
                                (["0"], "at least a second"),
                                (["1", "nothing"], "there is no fuzzer 'nothing'")):
            result = fuzz(*arguments)
            self.assertEqual(result.returncode, 2, arguments)
            self.assertIn(said, result.stderr)
        self.assertEqual(fuzz("--help").returncode, 0)

    def test_every_fuzzer_is_built_and_has_seeds(self):
        names = {path.stem.removeprefix("fuzz_") for path in (ROOT / "tests/fuzz").glob("fuzz_*.cpp")}
        cmake = (ROOT / "tests/fuzz/CMakeLists.txt").read_text()
        for name in names:
            self.assertIn(f"palpa_fuzzer({name} ", cmake)
            self.assertTrue(any((ROOT / "tests/fuzz/corpus" / name).iterdir()), name)


if __name__ == "__main__":
    unittest.main()
