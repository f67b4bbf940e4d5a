"""Writes the trajectories and names.gro beside it with GROMACS (gmx and gmx_d) and MDAnalysis, and as
text what `gmx dump` says they hold. Then checks with both what this program wrote (written*).

Needs: Debian's gromacs and python3-mdanalysis. Run it in this folder.
"""
import re
import subprocess
import sys
import tempfile
import warnings
from pathlib import Path

warnings.simplefilter("ignore")
import MDAnalysis as mda
import numpy as np

HERE = Path(__file__).resolve().parent
REAL = r"[-+]?\d\.\d+e[-+]\d+"


def run(*command, text=""):
    done = subprocess.run([str(word) for word in command], input=text, capture_output=True, text=True)
    if done.returncode != 0:
        sys.exit(f"{command}\n{done.stderr}")
    return done.stdout


def numbers_of(dump, name):
    """The rows `name[ 3]={ 1.0e+00, ...}` of a dump."""
    rows = re.findall(rf"\b{name}\[ *\d+\]=\{{(.*?)\}}", dump)
    return [[float(word) for word in re.findall(REAL, row)] for row in rows]


def text_of(file, gmx="gmx"):
    """Frames as text: `frame STEP TIME`, `box` and nine numbers, then a line an atom of what there is."""
    text = ""
    for frame in re.split(r"^\S+ frame \d+:\n", run(gmx, "dump", "-f", file), flags=re.M)[1:]:
        step, time = re.search(r"step= *(-?\d+)\s+time=(\S+)", frame).groups()
        box = numbers_of(frame, "box")
        text += f"frame {step} {float(time):.7g}\n"
        text += "box" + "".join(f" {v:g}" for row in box for v in row) + "\n"
        blocks = [numbers_of(frame, name) for name in "xvf"]
        for rows in zip(*[block for block in blocks if block]):
            text += " ".join(f"{v:.6g}" for row in rows for v in row) + "\n"
    return text


def add_text(name, gmx="gmx"):
    (HERE / (name + ".txt")).write_text(text_of(HERE / name, gmx))


def universe_of(atoms, residue):
    """Without bonds: names of atoms of one residue, again and again until there are `atoms`."""
    names, residue_name = residue
    universe = mda.Universe.empty(atoms, n_residues=atoms // len(names), trajectory=True,
                                  atom_resindex=np.arange(atoms) // len(names))
    universe.add_TopologyAttr("name", names * (atoms // len(names)))
    universe.add_TopologyAttr("resname", [residue_name] * (atoms // len(names)))
    universe.add_TopologyAttr("resid", np.arange(atoms // len(names)) + 1)
    return universe


def write_sources(folder):
    """20 waters on a grid, turned at random, three frames, velocities and forces in the first and last."""
    universe = universe_of(60, (["OW", "HW1", "HW2"], "SOL"))
    turns = np.linalg.qr(np.random.default_rng(2).normal(size=(20, 3, 3)))[0]
    water = np.array([[0, 0, 0], [0.957, 0, 0], [-0.240, 0.927, 0]])
    grid = np.array([[3.1 * (i % 3), 3.2 * (i // 3 % 3), 3.3 * (i // 9)] for i in range(20)])
    universe.atoms.positions = (water @ turns + grid[:, None]).reshape(60, 3)
    universe.dimensions = [11, 12, 13, 90, 90, 90]
    universe.atoms.write(str(folder / "waters.gro"))
    universe = mda.Universe(str(folder / "waters.gro"))
    atoms = universe.atoms
    random = np.random.default_rng(11)
    start = atoms.positions.copy()
    with mda.Writer(str(HERE / "waters.trr"), n_atoms=len(atoms)) as trr:
        for frame in range(3):
            shift = np.repeat(random.normal(0, 0.8, (len(atoms) // 3, 3)), 3, axis=0)
            atoms.positions = start + frame * shift
            ts = universe.trajectory.ts
            ts.dimensions = [11, 12, 13, 90, 90, 90] if frame < 2 else [11, 12, 13, 75, 80, 70]
            ts.time = 2.5 * frame
            ts.data["step"] = 1250 * frame
            ts.has_velocities = ts.has_forces = frame != 1
            if frame != 1:
                ts.velocities = random.normal(0, 5, start.shape)
                ts.forces = random.normal(0, 500, start.shape)
            trr.write(atoms)


def convert(source, target, *options, gmx="gmx", groups="0"):
    path = HERE / target
    path.unlink(missing_ok=True)
    run(gmx, "trjconv", "-f", source, "-o", path, *options, text=groups)


def write_far(folder):
    """Waters up to 30 nm apart, which at a precision of 1e6 makes a range above 2^24."""
    universe = mda.Universe(str(folder / "waters.gro"))
    universe.atoms.positions += np.repeat(np.arange(20)[:, None] * [15, -10, 0], 3, axis=0)
    universe.atoms.write(str(folder / "far.gro"))
    convert(folder / "far.gro", "far.xtc", "-ndec", "6", "-s", folder / "far.gro")


def write_chain(folder):
    """A walk of 400 atoms with steps from 0.002 to 2 nm, on both sides of the origin."""
    random = np.random.default_rng(5)
    steps = random.normal(0, 1, (400, 3)) * np.exp(random.uniform(-1.5, 2.3, 40).repeat(10))[:, None]
    universe = universe_of(400, (["C"], "UNK"))
    universe.atoms.positions = np.cumsum(steps, axis=0)
    universe.dimensions = [50, 50, 50, 90, 90, 90]
    universe.atoms.write(str(folder / "chain.gro"))
    convert(folder / "chain.gro", "chain.xtc", "-s", folder / "chain.gro")


def write_dcd():
    universe = mda.Universe(str(HERE / "waters.pdb"), str(HERE / "waters.trr"))
    text = ""
    with mda.Writer(str(HERE / "waters.dcd"), n_atoms=60, dt=2.5, nsavc=1250, istart=1250) as dcd:
        for ts in universe.trajectory:
            dcd.write(universe.atoms)
            text += f"frame {1250 * (ts.frame + 1)} {2.5 * (ts.frame + 1)}\nbox"
            text += "".join(f" {v:.7g}" for v in ts.triclinic_dimensions.ravel()) + "\n"
            text += "".join(" ".join(f"{v:.9g}" for v in p) + "\n" for p in ts.positions)
    (HERE / "waters.dcd.txt").write_text(text)


def write_gro():
    """names.pdb as GROMACS writes it: insertion codes, numbers below 0, a box that is not rectangular."""
    (HERE / "names.gro").unlink(missing_ok=True)
    run("gmx", "editconf", "-f", HERE / "names.pdb", "-o", HERE / "names.gro")


def check_written():
    if not (HERE / "written.xtc").exists():
        return
    for ours, theirs in (("written.xtc", "waters.xtc"), ("written_chain.xtc", "chain.xtc")):
        print(ours, "reads as", theirs, text_of(HERE / ours) == text_of(HERE / theirs))
    ours = mda.Universe(str(HERE / "waters.pdb"), str(HERE / "written.dcd"))
    theirs = mda.Universe(str(HERE / "waters.pdb"), str(HERE / "waters.dcd"))
    for a, b in zip(ours.trajectory, theirs.trajectory, strict=True):
        print("written.dcd, frame", a.frame, "differs by", np.abs(a.positions - b.positions).max(), "Å,",
              np.abs(a.dimensions - b.dimensions).max(), "in its cell,", abs(a.time - b.time), "ps")


with tempfile.TemporaryDirectory() as name:
    folder = Path(name)
    write_sources(folder)
    top = ["-s", folder / "waters.gro"]
    convert(HERE / "waters.trr", "waters.xtc", "-ndec", "3")
    convert(HERE / "waters.trr", "waters_double.trr", "-force", gmx="gmx_d")
    convert(HERE / "waters.trr", "waters.pdb", *top)
    (folder / "four.ndx").write_text("[ four ]\n1 2 3 4\n")
    convert(HERE / "waters.trr", "four_atoms.xtc", "-n", folder / "four.ndx")
    write_far(folder)
    write_chain(folder)
    write_dcd()
    write_gro()
for made in ("waters.trr", "waters.xtc", "four_atoms.xtc", "far.xtc", "chain.xtc"):
    add_text(made)
add_text("waters_double.trr", gmx="gmx_d")
check_written()
for left in HERE.glob(".*_offsets.*"):
    left.unlink()
