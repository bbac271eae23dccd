"""Checks who includes whom: kernels <- framework/* <- framework/cli, and one part per heavy library."""
import re
import sys
from pathlib import Path

# What each part may include besides itself. Whoever includes a part gets what that part includes.
ALLOWED = {
    "kernels": set(),
    "spec": set(),
    "hdf5": set(),
    "measurement": {"spec", "hdf5"},
    "design": {"spec"},
    "simulation": {"spec"},
    "multibody": {"spec", "simulation"},
    "features": {"spec", "design"},
    "sensitivity": {"spec", "simulation", "features", "design"},
    "inverse_map": {"spec", "design", "simulation", "features", "sensitivity", "kernels"},
    "online": {"spec", "design", "features", "inverse_map", "kernels"},
    "evaluation": {"spec", "design", "simulation", "features", "sensitivity", "inverse_map"},
    "store": {"spec", "hdf5", "simulation", "inverse_map", "online", "features", "kernels"},
    "report": {"spec", "features", "evaluation", "inverse_map", "store"},
    "comparison": {"spec", "features", "evaluation", "inverse_map", "store", "report"},
    "flow": {"spec", "design", "simulation", "multibody", "features", "sensitivity", "evaluation", "inverse_map", "online", "store",
             "report"},
    "inference": {"flow", "spec", "design", "simulation", "multibody", "features", "sensitivity", "inverse_map", "online", "measurement", "store", "report"},
    "verification": {"flow", "spec", "design", "simulation", "multibody", "features", "sensitivity", "evaluation",
                     "inverse_map", "store", "report"},
    "sweep": {"flow", "spec", "measurement", "design", "multibody", "simulation", "features", "sensitivity", "inverse_map", "report", "store"},
    "cli": {"flow", "sweep", "comparison", "verification", "inference", "spec", "measurement", "design", "multibody", "simulation", "features", "report", "store"},
}

# Libraries that stay behind one part.
LIBRARIES = {
    r"(Simbody|SimTK\w*|simbody/.*|simmath/.*)(\.h)?": {"multibody"},
    r"yaml-cpp/.*": {"spec"},
    r"muParser.*": {"spec"},
    r"udunits2.*": {"spec"},
    r"hdf5.*": {"hdf5", "store"},
    r"matio.*": {"measurement"},
    r"xxhash.*": {"store"},
    r"nlohmann/.*": {"spec", "measurement", "store", "report", "comparison", "inference"},
    r"CLI/.*": {"cli"},
    r"nlopt.*": {"kernels"},
    r"spdlog/.*": {"flow", "sweep", "cli"},
    r"filesystem": {"spec", "inference", "hdf5", "measurement", "store", "report", "comparison", "flow", "sweep", "verification", "cli"},
    r"(omp\.h|fstream|chrono)": {"spec", "measurement/fstream", "simulation", "multibody", "evaluation/chrono", "store", "comparison", "flow", "sweep", "verification", "cli", "kernels/omp.h"},
}

INCLUDE = re.compile(r'^\s*#\s*include\s*([<"])([^>"]+)[>"]', re.MULTILINE)


def part_of(path):
    """'kernels', a folder of framework, or 'flow' for the files in framework itself."""
    if path.parts[0] == "kernels":
        return "kernels"
    return path.parts[1] if len(path.parts) > 2 else "flow"


def check(root, file):
    path = file.relative_to(root)
    part = part_of(path)
    for _, included in INCLUDE.findall(file.read_text()):
        target = Path(included)
        if target.parts[0] in ("kernels", "framework"):
            other = part_of(target)
            if not (root / target).exists():
                yield f"{path}: includes {included}, which does not exist"
            if other != part and other not in ALLOWED[part]:
                yield f"{path}: {part} may not include {other} ({included})"
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
