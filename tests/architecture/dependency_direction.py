"""Checks who includes whom: kernels <- framework/* <- framework/cli, and one part per heavy library."""
import re
import sys
from pathlib import Path

# What each room may include besides itself. Whoever includes a room gets what that room includes.
ALLOWED = {
    "linalg": set(),
    "operations": set(),
    "kernels": set(),
    "base": set(),
    "experiment": {"base"},
    "robots": {"base", "experiment"},
    "simulation": {"base", "experiment"},
    "models/mechanism": {"base", "experiment", "kernels", "simulation"},
    "models/fmu": {"base", "experiment", "simulation"},
    "models/external": {"base", "experiment", "simulation"},
    "models": {"experiment", "simulation", "models/mechanism", "models/fmu", "models/external"},
    "data": {"base", "experiment", "simulation"},
    "view": {"base", "experiment", "simulation", "models", "models/mechanism"},
    "estimation": {"base", "experiment", "simulation", "data", "kernels"},
    "analysis": {"base", "experiment", "simulation", "data", "estimation", "kernels"},
    "store": {"base", "experiment", "simulation", "data", "estimation", "kernels"},
    "inference": {"base", "experiment", "simulation", "models", "data", "estimation", "analysis", "store"},
    "diagnosis": {"base", "experiment", "simulation", "models", "data", "estimation", "inference", "kernels"},
    "tracking": {
        "base",
        "experiment",
        "simulation",
        "models",
        "data",
        "estimation",
        "store",
        "inference",
        "diagnosis",
        "kernels",
    },
    "results": {"base", "experiment", "simulation", "data", "estimation", "analysis", "store"},
    "report": {"base", "experiment", "simulation", "view", "analysis", "store", "results"},
    "study": {
        "base",
        "experiment",
        "simulation",
        "models",
        "data",
        "estimation",
        "analysis",
        "store",
        "inference",
        "diagnosis",
        "tracking",
        "results",
        "report",
    },
    "optimal_design": {
        "base",
        "experiment",
        "simulation",
        "models",
        "data",
        "analysis",
        "results",
        "report",
        "study",
        "kernels",
    },
    "serve": {
        "base",
        "experiment",
        "simulation",
        "models",
        "data",
        "estimation",
        "store",
        "inference",
        "report",
        "tracking",
    },
    "c_api": {"base", "data", "diagnosis", "estimation", "inference"},
    "export": {
        "base",
        "experiment",
        "simulation",
        "models/fmu",
        "data",
        "estimation",
        "store",
        "inference",
        "tracking",
        "kernels",
    },
    "cli": {
        "base",
        "experiment",
        "simulation",
        "models",
        "models/fmu",
        "data",
        "store",
        "results",
        "report",
        "study",
        "inference",
        "diagnosis",
        "tracking",
        "serve",
        "optimal_design",
        "export",
        "robots",
        "view",
    },
    "python": {
        "base",
        "experiment",
        "robots",
        "simulation",
        "models",
        "models/fmu",
        "view",
        "data",
        "study",
        "inference",
        "diagnosis",
        "tracking",
    },
}

# The folders of a room, those that others of it build on first; a room that is not here has no order within.
ORDER_WITHIN = {
    "data": ["features", "measurement", "noise", "reduction", "sensitivity"],
    "estimation": ["gp", "surrogate", "network", "refined", "posterior", "trained"],
    "study": ["samples", "pipeline", "verification", "replay", "diagnosis", "sweep", "shards"],
}

# Dense linear algebra, and the operations that expressions and recorded programs share, which every room may include.
COMMON = {"linalg", "operations"}
OPERATIONS = re.compile(r"kernels/lanes/program/(operation_list|operation|real)\.hpp")

# Libraries that stay behind one room. Eigen's decompositions take 3 to 15 s in each translation unit that has one.
LIBRARIES = {
    r"Eigen/(Cholesky|Dense|Eigen|Eigenvalues|Geometry|Householder|Jacobi|LU|QR|SVD)|unsupported/Eigen/.*": {"linalg"},
    r"(Simbody|SimTK\w*|simbody/.*|simmath/.*)(\.h)?": {"models/mechanism"},
    r"yaml-cpp/.*": {"experiment"},
    r"udunits2.*": {"experiment"},
    r"hdf5.*": {"base", "store"},
    r"matio.*": {"data"},
    r"zip\.h": {"models/fmu"},
    r"pugixml\.hpp": {"models/fmu", "robots", "view"},
    r"(dlfcn|link)\.h": {"models/fmu", "models/mechanism", "base"},
    r"nanobind/.*": {"python"},
    r"xxhash.*": {"base", "store"},
    r"nlohmann/.*": {"base"},
    r"CLI/.*": {"cli"},
    r"nlopt.*": {"kernels"},
    r"spdlog/.*": {"base"},
    r"boost/(asio|beast)(/.*|\.hpp)": {"serve"},
    r"mosquitto\.h": {"serve"},
    r"filesystem": {
        "base",
        "models/fmu",
        "models/mechanism",
        "experiment",
        "robots",
        "data",
        "inference",
        "export",
        "store",
        "results",
        "report",
        "study",
        "tracking",
        "optimal_design",
        "c_api",
        "serve",
        "python",
        "cli",
    },
    r"(omp\.h|fstream|chrono)": {
        "models/fmu/fstream",
        "base",
        "experiment",
        "data/fstream",
        "simulation",
        "models/mechanism",
        "analysis/chrono",
        "store",
        "results",
        "view/fstream",
        "study",
        "serve/chrono",
        "python/chrono",
        "cli",
        "kernels/omp.h",
        "kernels/chrono",
        "linalg/omp.h",
    },
}

INCLUDE = re.compile(r'^\s*#\s*include\s*([<"])([^>"]+)[>"]', re.MULTILINE)


def part_of(path):
    """'linalg', 'operations', 'kernels' for the rest of kernels/, or a room of framework."""
    if OPERATIONS.fullmatch(path.as_posix()):
        return "operations"
    if path.parts[0] == "kernels":
        return "linalg" if path.parts[1] == "linalg" else "kernels"
    inner = "/".join(path.parts[1:3])
    return inner if inner in ALLOWED else path.parts[1]


def breaks_order(part, path, target):
    """Whether a folder includes one of its room that comes after it, or the room's own files one of its folders."""
    order = ORDER_WITHIN.get(part, [])
    inner = [order.index(p.parts[2]) if len(p.parts) > 3 and p.parts[2] in order else -1 for p in (path, target)]
    return inner[0] < inner[1]


def check(root, file):
    path = file.relative_to(root)
    part = part_of(path)
    for _, included in INCLUDE.findall(file.read_text()):
        target = Path(included)
        if target.parts[0] in ("kernels", "framework"):
            other = part_of(target)
            if not (root / target).exists():
                yield f"{path}: includes {included}, which does not exist"
            if other != part and other not in COMMON and other not in ALLOWED[part]:
                yield f"{path}: {part} may not include {other} ({included})"
            if other == part and breaks_order(part, path, target):
                yield f"{path}: includes {included}, which builds on it"
        for pattern, parts in LIBRARIES.items():
            if re.fullmatch(pattern, included) and part not in parts and f"{part}/{included}" not in parts:
                yield f"{path}: only {', '.join(sorted(parts))} may include <{included}>"


def main():
    root = Path(sys.argv[1]).resolve()
    files = [f for top in ("kernels", "framework") for f in (root / top).rglob("*") if f.suffix in (".hpp", ".cpp")]
    errors = [error for file in sorted(files) for error in check(root, file)]
    print("\n".join(errors) or f"{len(files)} files keep the direction of dependencies.")
    sys.exit(bool(errors) or len(files) < 10)


if __name__ == "__main__":
    main()
