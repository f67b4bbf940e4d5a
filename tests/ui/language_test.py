"""Which language the environment asks for, as gettext reads it."""
import os
import subprocess
import unittest
from pathlib import Path

BIN = Path(os.environ["PALPA_PROGRAM"]).parent
CATALOGUE = BIN.parent / "locale/de/LC_MESSAGES/palpa.mo"
VARIABLES = ("LANGUAGE", "LC_ALL", "LC_MESSAGES", "LANG")


def language(**variables):
    kept = {name: value for name, value in os.environ.items() if name not in VARIABLES}
    result = subprocess.run([BIN / "ui_tests", "the environment chooses the language"],
                            env={**kept, **variables}, capture_output=True, text=True)
    line, = (line for line in result.stdout.splitlines() if line.startswith("in use: "))
    return line.removeprefix("in use: ")


@unittest.skipUnless(CATALOGUE.exists(), "no German catalogue: msgfmt was missing")
class Environment(unittest.TestCase):
    def test_german_where_it_is_wanted_first(self):
        self.assertEqual(language(LANGUAGE="de", LC_ALL="C.UTF-8"), "de, Wasser")
        self.assertEqual(language(LANGUAGE="fr:de_AT:en", LANG="C.UTF-8"), "de, Wasser")

    def test_english_otherwise(self):
        for variables in ({}, {"LANG": "C.UTF-8"}, {"LANGUAGE": "fr", "LANG": "C.UTF-8"},
                          {"LANGUAGE": "en_GB:en:de", "LANG": "C.UTF-8"},
                          # As gettext has it, the plain locale is never translated.
                          {"LANGUAGE": "de", "LC_ALL": "C"}):
            with self.subTest(variables=variables):
                self.assertEqual(language(**variables), "en, water")


if __name__ == "__main__":
    unittest.main()
