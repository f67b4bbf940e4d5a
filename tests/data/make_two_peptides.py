#!/usr/bin/env python3
"""Writes two_peptides/both.crd, the tetrapeptide AERA twice, 11 Å apart; `palpa prepare` types it."""
import json
import subprocess
import sys
import tempfile
from pathlib import Path

DATA = Path(__file__).parent


def write_peptides(path):
    atoms = json.loads((DATA / "tetra_aera_c36m.ff.json").read_text())["atoms"]["rows"]
    frame = json.loads((DATA / "tetra_aera_c36m.frames.json").read_text())["frames"][0]["x"]
    lines = ["* two peptides", "*", f"{2 * len(atoms):10d}  EXT"]
    for copy, segment in enumerate(("PEPA", "PEPB")):
        for row, place in zip(atoms, frame):
            x, y, z = (10 * value + copy * by for value, by in zip(place, (11, 2, 1)))
            lines.append(f"{len(lines) - 2:10d}{4 * copy + row[2]:10d}  {row[1]:<8s}  {row[0]:<8s}"
                         f"{x:20.10f}{y:20.10f}{z:20.10f}  {segment:<8s}  {row[2]:<8d}{0:20.10f}")
    path.write_text("\n".join(lines) + "\n")


def main():
    if len(sys.argv) != 2:
        sys.exit("usage: make_two_peptides.py PALPA")
    folder = DATA / "two_peptides"
    write_peptides(folder / "both.crd")
    with tempfile.TemporaryDirectory() as prepared:
        subprocess.run([sys.argv[1], "prepare", folder / "both.crd", "--only-toppar", "--toppar",
                        folder / "aera_c36m.rtf", folder / "aera_c36m.prm", "--no-relax",
                        "--solvent", "none", "-o", prepared], check=True)
        (folder / "both.psf").write_bytes((Path(prepared) / "system.psf").read_bytes())


if __name__ == "__main__":
    main()
