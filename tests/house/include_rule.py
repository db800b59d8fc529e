#!/usr/bin/env python3
"""Keeps the include rule: a folder of src/lamella includes only the folders and libraries that the table allows it.

usage: include_rule.py SOURCE_TREE    checks the tree; one line per fault, exit code 1 if there are any
       include_rule.py --self-test    makes a tree with every kind of fault and checks that each is found

docs/architecture.md explains the table. A new folder or a new library is a new line here, and a reason in the commit.
"""
import re
import sys
import tempfile
from pathlib import Path

SOLVERS = ["bubble", "equilibrium", "melp", "vortex_particle", "vortex_sheet"]

# Folder -> the folders it may include, beside itself.
BELOW_SOLVERS = ["core", "geometry", "linalg", "optics", "spatial", "dist", "mesh", "particles", "film",
                 "sim"]
FOLDERS = {
    "core": [],
    "geometry": ["core"],
    "linalg": ["core"],
    "optics": ["core"],
    "spatial": ["core", "geometry"],
    "dist": ["core", "spatial"],
    "mesh": ["core", "geometry", "linalg", "spatial"],
    "particles": ["core", "geometry", "linalg", "spatial"],
    "film": ["core", "geometry", "linalg", "spatial", "mesh"],
    "sim": ["core", "dist", "mesh", "film"],
    "io": ["core", "geometry", "sim", "mesh", "particles"],
    "measure": ["core", "geometry", "optics", "spatial", "dist", "mesh", "sim", "io"],
    "render": ["core", "geometry", "optics", "spatial", "mesh", "sim", "io"],
}
FOLDERS |= {f"solvers/{name}": BELOW_SOLVERS for name in SOLVERS}
FOLDERS["scene"] = list(FOLDERS)
FOLDERS["run"] = list(FOLDERS)
FOLDERS["sweep"] = list(FOLDERS)

# Library (how its headers begin) -> the folders whose sources may include it. Public headers include none.
LIBRARIES = {
    r"tbb/|oneapi/tbb/": ["core"],
    r"Random123/": ["core"],
    r"cub/": ["core"],
    r"Eigen/|unsupported/Eigen/": ["linalg"],
    r"HYPRE": ["linalg"],
    r"mpi\.h": ["dist", "linalg"],
    r"hdf5": ["io"],
    r"H5[A-Za-z]*(public|develop)\.h": ["io"],
    r"zlib\.h": ["io"],
    r"png\.h": ["io"],
    r"Imf[A-Za-z]*\.h|OpenEXR/": ["io"],
    r"embree3/": ["render"],
    r"toml\+\+/": ["scene"],
    r"nlohmann/": ["scene", "measure", "run"],
    r"spdlog/": ["run"],
    r"fmt/": list(FOLDERS),
    r"CLI/": [],  # the program only
    r"gtest/|gmock/|rapidcheck|benchmark/": [],
}

# Standard C++ headers have no dot, and but one a slash; the C and POSIX ones that the library may use are named.
SYSTEM = re.compile(r"^(\w+|experimental/simd|(sys|sanitizer)/\w+\.h|(fcntl|unistd|dirent|sched|signal|spawn|cuda_runtime|immintrin)\.h)$")

# The library never prints, exits or aborts: the caller owns stdout, stderr and the process. (A failed assertion does.)
PROCESS = re.compile(r"\bstd::(cout|cerr|clog|exit|abort|quick_exit|print|printf|puts)\b|\bfmt::print\b|\bspdlog::")
PROCESS_ALLOWED = {"core/error.cpp": "std::abort|fmt::print", "run": "spdlog::"}

INCLUDE = re.compile(r'^\s*#\s*include\s*(?:"([^"]+)"|<([^>]+)>)')


def folder_of(path):
    """The folder of a path relative to src/lamella: "core", "solvers/bubble"; "" for what lies beside the folders."""
    parts = path.split("/")[:-1]
    return "/".join(parts[:2] if parts[:1] == ["solvers"] else parts[:1])


def include_faults(path, folder, quoted, angled):
    is_public_header = path.endswith((".h", ".cuh")) and "/detail/" not in path
    if quoted:
        if not quoted.startswith("lamella/"):
            return f'"{quoted}": write the path from src/, "lamella/..."'
        target = quoted.removeprefix("lamella/")
        target_folder = folder_of(target)
        if target_folder != folder:
            if target_folder not in FOLDERS[folder]:
                return f'"{quoted}": {folder} may not include {target_folder or "that"}'
            if "/detail/" in target:
                return f'"{quoted}": detail/ belongs to {target_folder} alone'
        elif is_public_header and "/detail/" in target:
            return f'"{quoted}": a public header may not include detail/, which is not installed'
        return None
    if angled.startswith("lamella/"):
        return f"<{angled}>: write our own headers in quotes"
    for pattern, users in LIBRARIES.items():
        if re.match(pattern, angled):
            if folder not in users:
                return f"<{angled}>: {folder} may not use this library" + (f", only {', '.join(users)}" if users else "")
            if is_public_header:
                return f"<{angled}>: a public header includes no library; keep it in the .cpp"
            return None
    if not SYSTEM.match(angled):
        return f"<{angled}>: unknown library; name it in tests/house/include_rule.py"
    return None


def without_comments(text):
    """The same lines with comments and string literals blanked."""
    pattern = re.compile(r'//[^\n]*|/\*.*?\*/|"(?:\\.|[^"\\\n])*"', re.S)
    return pattern.sub(lambda m: re.sub(r"[^\n]", " ", m.group()), text)


def file_faults(path, text):
    folder = folder_of(path)
    if folder not in FOLDERS:
        yield 1, f'folder "{folder}" is not in the table'
        return
    if path.endswith(".h") and "#pragma once" not in text.splitlines():
        yield 1, "a header starts with #pragma once"
    for number, line in enumerate(text.splitlines(), 1):
        match = INCLUDE.match(line)
        fault = match and include_faults(path, folder, *match.groups())
        if fault:
            yield number, fault
    allowed = PROCESS_ALLOWED.get(path) or PROCESS_ALLOWED.get(folder)
    for number, line in enumerate(without_comments(text).splitlines(), 1):
        for match in PROCESS.finditer(line):
            if not (allowed and re.match(allowed, match.group())):
                yield number, f"{match.group()}: the library never prints, exits or aborts"


def tree_faults(tree):
    root = tree / "src" / "lamella"
    files = sorted(p for p in root.rglob("*") if p.suffix in {".h", ".cpp", ".cu", ".cuh", ".in"})
    if not files:
        yield f"{root}: no sources found"
    for file in files:
        path = file.relative_to(root).as_posix()
        for number, fault in file_faults(path.removesuffix(".in"), file.read_text(encoding="utf-8")):
            yield f"src/lamella/{path}:{number}: {fault}"


def self_test():
    order = list(FOLDERS)
    table_points_down = all(order.index(below) < order.index(folder) for folder in order for below in FOLDERS[folder])
    good = {
        "core/vec.h": "#pragma once\n#include <cmath>\n",
        "core/parallel.cpp": '#include "lamella/core/vec.h"\n#include <tbb/parallel_for.h>\n',
        "core/error.cpp": "void f() { fmt::print(stderr, \"x\"); std::abort(); }\n",
        "io/file.cpp": '#include "lamella/io/detail/x.h"\n#include "lamella/sim/frame.h"\n#include <hdf5.h>\n#include <fcntl.h>\n',
        "solvers/bubble/step.cpp": '#include "lamella/spatial/cells.h"\n#include "lamella/solvers/bubble/options.h"\n',
        "run/loop.cpp": '#include "lamella/scene/scene.h"\n#include "lamella/measure/x.h"\n// std::cout in a comment\n',
    }
    bad = {
        "core/up.h": '#pragma once\n#include "lamella/sim/frame.h"\n',
        "core/library.h": "#pragma once\n#include <tbb/tbb.h>\n",
        "core/no_guard.h": "#include <cmath>\n",
        "core/prints.cpp": "void f() { std::cout << 1; }\n",
        "sim/io.cpp": '#include "lamella/io/csv.h"\n',
        "sim/threads.cpp": "#include <tbb/parallel_for.h>\n",
        "io/toml.cpp": "#include <toml++/toml.h>\n",
        "scene/checkpoint.cpp": "#include <hdf5.h>\n",
        "scene/borrows.cpp": '#include "lamella/io/detail/x.h"\n',
        "io/leaks.h": '#pragma once\n#include "lamella/io/detail/x.h"\n',
        "solvers/bubble/other.cpp": '#include "lamella/solvers/melp/step.h"\n',
        "solvers/bubble/file.cpp": '#include "lamella/io/csv.h"\n',
        "scene/up.cpp": '#include "lamella/run/loop.h"\n',
        "measure/solver.cpp": '#include "lamella/solvers/bubble/options.h"\n',
        "run/cli.cpp": "#include <CLI/CLI.hpp>\n",
        "run/unknown.cpp": "#include <boost/any.hpp>\n",
        "run/relative.cpp": '#include "loop.h"\n',
        "run/angled.cpp": "#include <lamella/core/vec.h>\n",
        "run/exits.cpp": "void f() { std::exit(1); }\n",
        "misc/thing.h": "#pragma once\n",
        "top.h": "#pragma once\n",
    }
    with tempfile.TemporaryDirectory() as folder:
        tree = Path(folder)
        for path, text in (good | bad).items():
            file = tree / "src" / "lamella" / path
            file.parent.mkdir(parents=True, exist_ok=True)
            file.write_text(text, encoding="utf-8")
        found = {line.split(":")[0].removeprefix("src/lamella/") for line in tree_faults(tree)}
    wrong = [f"not found: {path}" for path in bad if path not in found]
    wrong += [f"found where there is none: {path}" for path in good if path in found]
    wrong += [] if table_points_down else ["the table has an arrow that points up"]
    return wrong


def main():
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    faults = self_test() if sys.argv[1] == "--self-test" else list(tree_faults(Path(sys.argv[1])))
    for fault in faults:
        print(fault)
    sys.exit(1 if faults else 0)


if __name__ == "__main__":
    main()
