#!/usr/bin/env python3
"""Takes two small cases out of the reference set, with a few of their frames.

usage: make_reference_subset.py REFERENCE_FOLDER OUTPUT_FOLDER

Writes CASE.ff.json as it is and CASE.frames.json with the frames named below, of the dipeptide with
the forces of every term; see README.md beside this file.
"""
import json
import sys
from pathlib import Path

FRAMES = {
    "ala_dipeptide": ["phi-80_psi80_noise0.005nm", "phi180_psi0"],
    "tetra_aera_c36m": ["input_noise0.005nm_1"],
}


def write(path, content):
    path.write_text(json.dumps(content, separators=(",", ":")) + "\n")


def main():
    source, target = Path(sys.argv[1]), Path(sys.argv[2])
    for case, names in FRAMES.items():
        write(target / f"{case}.ff.json", json.loads((source / f"{case}.ff.json").read_text()))
        frames = json.loads((source / f"{case}.frames.json").read_text())
        frames["frames"] = [frame for frame in frames["frames"] if frame["name"] in names]
        if case != "ala_dipeptide":
            for frame in frames["frames"]:
                del frame["f_terms"]
        write(target / f"{case}.frames.json", frames)


if __name__ == "__main__":
    main()
