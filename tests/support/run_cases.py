"""Runs a file of unittest cases: run_cases.py FILE [-v]. Where one was skipped and none failed the exit
code is 77, which ctest counts as skipped; unittest's own is 0. Cases see nobody's preferences: the
folders for settings, data and caches are empty ones."""
import importlib.util
import os
import sys
import tempfile
import unittest
from pathlib import Path

SKIPPED = 77  # SKIP_RETURN_CODE in tests/CMakeLists.txt


def run_file():
    path = Path(sys.argv[1])
    sys.path.insert(0, str(path.parent))  # as if FILE itself had been started
    spec = importlib.util.spec_from_file_location(path.stem, path)
    module = sys.modules[path.stem] = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    result = unittest.main(module, argv=[str(path), *sys.argv[2:]], exit=False).result
    if not result.wasSuccessful():
        return 1
    for case, why in result.skipped:
        print(f"SKIPPED: {why} ({case.id()})")
    return SKIPPED if result.skipped else 0


def main():
    with tempfile.TemporaryDirectory() as home:
        for kind in ("CONFIG", "DATA", "CACHE"):
            os.environ[f"XDG_{kind}_HOME"] = str(Path(home) / kind.lower())
        return run_file()


if __name__ == "__main__":
    sys.exit(main())
