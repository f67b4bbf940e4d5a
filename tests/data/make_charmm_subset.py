#!/usr/bin/env python3
"""Takes out of CHARMM's topology and parameter files what one reference case needs.

usage: make_charmm_subset.py CASE.ff.json TOPOLOGY PARAMETERS OUTPUT

Writes OUTPUT.rtf with the residues of the case, the patches that end its chain and their types, and
OUTPUT.prm with all parameters between those types (wildcards included), lines as they are but for
their comments. See README.md beside this file.
"""
import json
import sys
from pathlib import Path

SECTIONS = {"BOND": 2, "ANGL": 3, "DIHE": 4, "IMPR": 4, "CMAP": 8, "NONB": 1, "NBFI": 2}
TERMS_OF_USE = """* part of CHARMM's {}, July 2024 release, without its comments:
* what a tetrapeptide needs. The force field is freely distributed; cite it where you use it:
* J. Huang et al., Nature Methods 14, 71 (2017).
*
"""


def statements(path):
    for line in path.read_text().splitlines():
        words = line.split("!")[0].split()
        if words and not words[0].startswith("*"):
            yield words


def topology(path, types, names):
    kept, keep = [], True
    for words in statements(path):
        key = words[0].upper()[:4]
        if key in ("RESI", "PRES"):
            keep = words[1] in names
        if key == "END":
            keep = True
        if key == "MASS":
            if words[2] in types:
                kept.append(words)
        elif keep and key not in ("DONO", "ACCE"):
            kept.append(words)
    return kept


def parameters(path, types):
    kept, section, whole_map, continued = [], None, False, False
    for words in statements(path):
        key = words[0].upper()[:4]
        if continued:
            continued = words[-1] == "-"
            kept.append(words)
        elif key == "END":
            kept.append(words)
        elif key in ("ATOM", "HBON"):
            section = None
        elif key in SECTIONS and (len(words) == 1 or key in ("NONB", "NBFI")):
            section, continued = key, words[-1] == "-"
            kept.append(words)
        elif section == "CMAP" and len(words) != 9:
            if whole_map:
                kept.append(words)
        elif section:
            whole_map = all(t in types or t == "X" for t in words[:SECTIONS[section]])
            if whole_map:
                kept.append(words)
    return kept


def main():
    case, rtf, prm, output = (Path(name) for name in sys.argv[1:])
    rows = json.loads(case.read_text())["atoms"]["rows"]
    types = {row[3] for row in rows}
    names = {row[1] for row in rows} | {"NTER", "CTER"}
    types |= {words[2] for words in topology(rtf, set(), names) if words[0].upper() == "ATOM"}
    for kept, source, suffix in ((topology(rtf, types, names), rtf, ".rtf"),
                                 (parameters(prm, types), prm, ".prm")):
        text = TERMS_OF_USE.format(source.name) + "\n".join(" ".join(words) for words in kept)
        output.with_suffix(suffix).write_text(text + "\n")


if __name__ == "__main__":
    main()
