#!/usr/bin/env python3
"""Holds every #include against the arrows that the CMakeLists.txt files declare.

usage: check_layers.py [ROOT]

An arrow is written in one place only, the DEPENDS of a palpa_module(...). A file may include what
its own module reaches along the arrows. Fails, with file and line, on an include that no arrow
allows, on an include of a folder that is no module, on an arrow to a module that does not exist,
on a source that no palpa_module lists, on a cycle of arrows, on a header of POSIX or Windows
outside of the module `platform`, on functions of the standard library and Eigen that round otherwise
on other systems where core/repeatable.h has them, and where the table of modules in engine/README.md
says anything else.
"""
import re
import sys
from pathlib import Path

INCLUDE = re.compile(r'^\s*#\s*include\s*(["<])([^">]+)[">]')
MAP_ROW = re.compile(r"\| (\w+) \| [^|]+ \|([\w ]*)\|$")
COMMENT = re.compile(r"/\*.*?\*/", re.DOTALL)
SOURCES = ("SOURCES", "POSIX", "WINDOWS")
SYSTEM = re.compile(r"(sys|linux|arpa|net|netinet)/|(aio|dirent|dlfcn|fcntl|glob|grp|io|langinfo|poll|pthread"
                    r"|pwd|sched|semaphore|signal|spawn|strings|syslog|termios|unistd|utime|windows|winsock2?)\.h$")
# Modules that decide where molecules and hands go.
REPEATABLE = {"assembly", "charmm", "core", "devices", "field", "forces", "haptics", "math", "loading", "simulation", "statics"}
ROUNDED = re.compile(r"std::(?:a?(?:sin|cos|tan)h?|atan2|exp2?|expm1|log(?:2|10|1p)?|pow|cbrt|hypot|erfc?)\(|AngleAxis\w*[ ({]|slerp\(|angularDistance\(|computeDirect\(")
KEYWORDS = {*SOURCES, "DEPENDS", "LIBRARIES"}
FOLDERS = ("engine", "devices", "tools", "tests")
SUFFIXES = {".h", ".cpp"}


def read_modules(root):
    """Module name -> {folder, sources, depends}, from every palpa_module(...) under root."""
    modules = {}
    for folder in FOLDERS:
        for cmake in sorted((root / folder).rglob("CMakeLists.txt")):
            text = re.sub(r"#[^\n]*", "", cmake.read_text())
            for call in re.finditer(r"palpa_module\(([^)]*)\)", text):
                words = call.group(1).split()
                module = {"folder": cmake.parent, **{keyword: [] for keyword in KEYWORDS}}
                part = None
                for word in words[1:]:
                    if word in KEYWORDS:
                        part = word
                    elif part:
                        module[part].append(word)
                modules[words[0]] = module
    return modules


def find_cycle(modules):
    """A list of modules that depend on each other in a circle, or None."""
    done = set()

    def visit(name, path):
        if name in path:
            return path[path.index(name):] + [name]
        if name in done or name not in modules:
            return None
        for other in modules[name]["DEPENDS"]:
            cycle = visit(other, path + [name])
            if cycle:
                return cycle
        done.add(name)
        return None

    for name in modules:
        cycle = visit(name, [])
        if cycle:
            return cycle
    return None


def reachable(modules, name):
    """The module itself and all that its arrows lead to."""
    found, left = set(), [name]
    while left:
        at = left.pop()
        if at not in found:
            found.add(at)
            left += modules[at]["DEPENDS"] if at in modules else []
    return found


def check(root):
    """All problems as lines of text."""
    modules = read_modules(root)
    if not modules:
        return [f"{root}: no palpa_module(...) found under {', '.join(FOLDERS)}"]
    problems = []
    for name, module in modules.items():
        for other in module["DEPENDS"]:
            if other not in modules:
                problems.append(f"{name}: depends on '{other}', which is no module")
    cycle = find_cycle(modules)
    if cycle:
        return problems + ["cycle of arrows: " + " -> ".join(cycle)]

    folders = {module["folder"]: name for name, module in modules.items()}
    for folder in FOLDERS:
        for path in sorted((root / folder).rglob("*")):
            if path.suffix in SUFFIXES and path.is_file():
                problems += check_file(root, path, folders, modules)
    return problems + check_map(root, modules)


def check_map(root, modules):
    """The table of modules in engine/README.md has the engine's modules and their arrows, no others."""
    readme = root / "engine" / "README.md"
    if not readme.is_file():
        return []
    problems, rows = [], {}
    for number, line in enumerate(readme.read_text().splitlines(), 1):
        row = MAP_ROW.match(line)
        if row and row.group(1) != "module":
            rows[row.group(1)] = (number, row.group(2).split())
    of_engine = {name for name, module in modules.items() if root / "engine" in module["folder"].parents}
    for name in sorted(of_engine - rows.keys()):
        problems.append(f"engine/README.md: has no row of the module '{name}'")
    for name, (number, uses) in rows.items():
        place = f"engine/README.md:{number}"
        if name not in of_engine:
            problems.append(f"{place}: '{name}' is no module of the engine")
        elif sorted(uses) != sorted(modules[name]["DEPENDS"]):
            problems.append(f"{place}: '{name}' uses {' '.join(uses) or 'nothing'}; its CMakeLists.txt has "
                            f"{' '.join(modules[name]['DEPENDS']) or 'nothing'}")
    return problems


def check_file(root, path, folders, modules):
    owner = next((folders[parent] for parent in path.parents if parent in folders), None)
    if owner is None:
        top = path.relative_to(root).parts
        if top[:1] == ("engine",) and len(top) > 2:
            return [f"{path.relative_to(root)}: its folder has no palpa_module(...)"]
        owner = top[0] if top[0] in ("tests",) else None
    problems = []
    sources = [file for kind in SOURCES for file in modules[owner][kind]] if owner in modules else []
    if owner in modules and owner not in ("tools", "lab", "tests") and path.suffix == ".cpp":
        if path.relative_to(modules[owner]["folder"]).as_posix() not in sources:
            problems.append(f"{path.relative_to(root)}: not among the SOURCES of '{owner}'")
    allowed = reachable(modules, owner) if owner in modules else None
    # Comments may stand inside a line; their line ends are kept for the numbers.
    text = COMMENT.sub(lambda comment: "\n" * comment.group().count("\n"), path.read_text())
    for number, line in enumerate(text.splitlines(), 1):
        if owner in REPEATABLE and (rounded := ROUNDED.search(line.partition("//")[0])):
            problems.append(f"{path.relative_to(root)}:{number}: {rounded.group().rstrip('(')} rounds otherwise on other "
                            "systems; expected a function of core/repeatable.h or math/vec.h")
        match = INCLUDE.match(line)
        if not match:
            continue
        place = f"{path.relative_to(root)}:{number}"
        # tools/windows has a program of that system alone.
        is_of_system = owner in ("platform", "tests", None) or path.parent == root / "tools" / "windows"
        if SYSTEM.match(match.group(2).lower()) and not is_of_system:
            problems.append(f"{place}: <{match.group(2)}> is the operating system's; only 'platform' calls it")
        target = "lab" if match.group(2).startswith("tools/lab/") else match.group(2).split("/")[0]
        if match.group(1) == "<" and ("/" not in match.group(2) or target not in modules):
            continue  # a library's
        if "/" not in match.group(2):
            problems.append(f'{place}: "{match.group(2)}" names no module; expected "module/file.h"')
        elif target == "tests" and owner in ("tests", None):
            continue
        elif target == "shaders" and owner == "render":
            continue  # made from shaders/ while building
        elif target not in modules:
            problems.append(f"{place}: includes '{target}/', which is no module")
        elif allowed is not None and target not in allowed:
            problems.append(f"{place}: '{owner}' may not include '{target}'; it reaches "
                            + ", ".join(sorted(allowed - {owner})))
    return problems


def main():
    root = Path(sys.argv[1] if len(sys.argv) > 1 else Path(__file__).parent.parent).resolve()
    problems = check(root)
    for problem in problems:
        print(problem)
    if not problems:
        modules = read_modules(root)
        print(f"{len(modules)} modules, {sum(len(m['DEPENDS']) for m in modules.values())} arrows, "
              "all pointing down")
    return 1 if problems else 0


if __name__ == "__main__":
    sys.exit(main())
