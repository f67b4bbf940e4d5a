"""Every text that is marked in the sources is translated in engine/ui/locale, with its placeholders."""
import os
import re
import subprocess
import tempfile
import unittest
from collections import Counter
from pathlib import Path

ROOT = Path(os.environ["PALPA_ROOT"])
QUOTED = r'(?:"(?:[^"\\]|\\.)*"\s*)+'
ESCAPES = {"n": "\n", "t": "\t", '"': '"', "\\": "\\"}


def unquoted(text):
    text = "".join(re.findall(r'"((?:[^"\\]|\\.)*)"', text))
    return re.sub(r"\\(.)", lambda escape: ESCAPES[escape[1]], text)


def entries(text):
    """English texts (one form, or two) -> their translations, without the header; fuzzy ones have none."""
    found = {}
    for entry in re.split(r"\n\n+", text):
        entry = "\n".join(line for line in entry.splitlines() if not line.startswith("#~"))
        ids = [unquoted(quoted) for quoted in re.findall(rf"^msgid(?:_plural)? ({QUOTED})", entry, re.M)]
        texts = [unquoted(quoted) for quoted in re.findall(rf"^msgstr(?:\[\d\])? ({QUOTED})", entry, re.M)]
        if ids and ids != [""]:
            found[tuple(ids)] = [] if re.search(r"^#,.*\bfuzzy", entry, re.M) else texts
    return found


def placeholders(text):
    """Those of fmt with the number of their argument, and those of printf in their order."""
    fields, printf = Counter(), re.findall(r"%[-+ #0]*\d*(?:\.\d+)?[a-zA-Z]", re.sub(r"\{[^}]*\}", "", text))
    for number, (index, spec) in enumerate(re.findall(r"\{(\d*)(:[^}]*)?\}", text)):
        fields[index or str(number), spec] += 1
    # "100 % of": a letter after a blank is no placeholder of ours.
    return fields, [each for each in printf if not each.startswith("% ")]


def problems(template, translations):
    """What is wrong with a .po file, a line each."""
    said = []
    for ids in template.keys() - translations.keys():
        said.append(f"not there: {ids[0]!r}")
    for ids, texts in translations.items():
        if ids not in template:
            said.append(f"in no source: {ids[0]!r}")
        if not texts or not all(texts):
            said.append(f"not translated, or fuzzy: {ids[0]!r}")
        for text in texts:
            if text and all(placeholders(text) != placeholders(english) for english in ids):
                said.append(f"other placeholders: {ids[0]!r}: {text!r}")
    return said


class Translations(unittest.TestCase):
    def test_every_marked_text_is_translated_with_the_same_placeholders(self):
        with tempfile.TemporaryDirectory() as folder:
            template = Path(folder) / "palpa.pot"
            result = subprocess.run([ROOT / "tools/scripts/update_translations", "--template", template],
                                    capture_output=True, text=True)
            self.assertEqual(result.returncode, 0, result.stderr)
            wanted = entries(template.read_text())
        self.assertGreater(len(wanted), 400)
        self.assertIn(("water",), wanted)
        for po in (ROOT / "engine/ui/locale").glob("*.po"):
            with self.subTest(po=po.name):
                self.assertEqual(problems(wanted, entries(po.read_text())), [])

    def test_what_is_wrong_is_found(self):
        template = entries('msgid ""\nmsgstr "Header"\n\nmsgid "a {} of {:.3g}"\nmsgstr ""\n\n'
                           'msgid "from %.0f pN"\nmsgstr ""\n')
        self.assertEqual(len(template), 2)

        def wrong(first, second='msgstr "ab %.0f pN"'):
            return problems(template, entries(f'msgid "a {{}} of {{:.3g}}"\n{first}\n\n'
                                              f'msgid "from %.0f pN"\n{second}\n'))

        self.assertEqual(wrong('msgstr "{} von {:.3g}"'), [])
        self.assertEqual(wrong('msgstr ""\n"{1:.3g}"\n": {0}"'), [])
        for first in ('msgstr "{} von {:.2g}"', 'msgstr "{:.3g} von {}"', 'msgstr "{}"', 'msgstr ""'):
            with self.subTest(first=first):
                self.assertEqual(len(wrong(first)), 1)
        self.assertEqual(len(wrong('msgstr "{} von {:.3g}"', 'msgstr "ab %d pN"')), 1)
        self.assertEqual(len(problems(template, {})), 2)
        self.assertEqual(len(problems({}, entries('#, fuzzy\nmsgid "a"\nmsgstr "b"\n'))), 2)


if __name__ == "__main__":
    unittest.main()
