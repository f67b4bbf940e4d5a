#!/usr/bin/env python3
"""Packs the reference frames of the water dimer into one CSV each.

usage: make_water_frames.py REFERENCE_FOLDER OUTPUT_FOLDER

Reads water_dimer_{charmm,standard}.frames.json; see README.md beside this file.
"""
import json
import sys
from pathlib import Path


def main():
    source, target = Path(sys.argv[1]), Path(sys.argv[2])
    for variant in ("charmm", "standard"):
        frames = json.loads((source / f"water_dimer_{variant}.frames.json").read_text())["frames"]
        rows = ["name,lj_kJ_per_mol,coulomb_kJ_per_mol"
                + "".join(f",{axis}{atom}_nm" for atom in range(6) for axis in "xyz")
                + "".join(f",f{axis}{atom}_kJ_per_mol_nm" for atom in range(6) for axis in "xyz")]
        for frame in frames:
            values = [frame["energy"]["lj"], frame["energy"]["coulomb"]]
            values += [value for key in ("x", "f") for atom in frame[key] for value in atom]
            rows.append(",".join([frame["name"]] + [repr(value) for value in values]))
        (target / f"water_dimer_{variant}.csv").write_text("\n".join(rows) + "\n")


if __name__ == "__main__":
    main()
