"""Checks who includes whom: kernels <- framework/* <- framework/cli, and one part per heavy library."""
import re
import sys
from pathlib import Path

# What each part may include besides itself. Whoever includes a part gets what that part includes.
ALLOWED = {
    "linalg": set(),
    "kernels": set(),
    "autocorrelation": set(),
    "response": set(),
    "spec": {"autocorrelation"},
    "hdf5": set(),
    "monitoring": set(),
    "measurement": {"response", "spec", "hdf5"},
    "design": {"spec"},
    "simulation": {"response", "spec"},
    "multibody": {"response", "spec", "simulation", "kernels"},
    "process": set(),
    "fmi": {"spec", "response", "simulation", "process"},
    "program": {"spec", "response", "simulation", "process"},
    "model_source": {"spec", "response", "simulation", "multibody", "fmi", "program"},
    "features": {"autocorrelation", "response", "spec", "design"},
    "sensitivity": {"spec", "simulation", "features", "design"},
    "refinement": {"spec", "simulation", "features", "sensitivity", "design"},
    "inverse_map": {"spec", "design", "simulation", "features", "sensitivity", "kernels"},
    "surrogate": {"spec", "design", "features", "inverse_map", "kernels"},
    "network_map": {"spec", "design", "features", "inverse_map", "surrogate", "kernels"},
    "online": {"spec", "design", "features", "inverse_map", "surrogate", "network_map", "kernels"},
    "evaluation": {"spec", "design", "simulation", "features", "sensitivity", "inverse_map", "kernels"},
    "store": {"spec", "hdf5", "simulation", "inverse_map", "surrogate", "network_map", "online", "features", "kernels"},
    "sampling": {"response", "spec", "monitoring", "design", "simulation", "features", "sensitivity", "store"},
    "results": {"response", "spec", "monitoring", "features", "refinement", "evaluation", "inverse_map", "store"},
    "report": {"spec", "features", "evaluation", "inverse_map", "store", "results"},
    "comparison": {"spec", "features", "evaluation", "inverse_map", "store", "results"},
    "experiment": {"spec", "monitoring", "design", "simulation", "multibody", "model_source", "features", "sensitivity", "refinement",
                   "evaluation", "inverse_map", "surrogate", "network_map", "online", "store", "sampling", "results", "report"},
    "experiment_design": {"experiment", "spec", "response", "monitoring", "measurement", "design", "simulation", "model_source", "features",
                          "sensitivity", "evaluation", "store", "results", "report", "comparison", "kernels"},
    "inference": {"experiment", "spec", "design", "simulation", "model_source", "features", "sensitivity", "refinement", "inverse_map", "surrogate", "online",
                  "measurement", "store", "results", "report"},
    "c_api": {"inference", "spec", "measurement", "process", "features", "inverse_map", "online", "response"},
    "python": {"experiment", "sweep", "inference", "spec", "monitoring", "measurement", "design", "process", "fmi", "model_source", "simulation",
               "response", "features", "inverse_map", "online"},
    "export": {"experiment", "spec", "response", "design", "features", "inverse_map", "surrogate", "online", "measurement", "store", "results",
               "inference", "fmi", "kernels"},
    "verification": {"experiment", "spec", "monitoring", "design", "simulation", "model_source", "features", "sensitivity", "evaluation",
                     "inverse_map", "store", "sampling", "results"},
    "sweep": {"experiment", "response", "spec", "monitoring", "measurement", "design", "model_source", "simulation", "features",
              "sensitivity", "inverse_map", "network_map", "store", "sampling", "results", "report"},
    "cluster": {"sweep", "experiment", "spec", "monitoring", "measurement", "simulation", "store", "sampling", "results"},
    "cli": {"experiment_design", "experiment", "sweep", "cluster", "comparison", "verification", "inference", "export", "spec", "monitoring", "measurement", "design",
            "fmi", "model_source", "simulation", "features", "store", "sampling", "results", "report"},
}

# Dense linear algebra and JSON, which every part may include.
COMMON = {"linalg", "json"}

# Libraries that stay behind one part. Eigen's decompositions take 3 to 15 s in each translation unit that has one.
LIBRARIES = {
    r"Eigen/(Cholesky|Dense|Eigen|Eigenvalues|Geometry|Householder|Jacobi|LU|QR|SVD)|unsupported/Eigen/.*": {"linalg"},
    r"(Simbody|SimTK\w*|simbody/.*|simmath/.*)(\.h)?": {"multibody"},
    r"yaml-cpp/.*": {"spec"},
    r"muParser.*": {"spec"},
    r"udunits2.*": {"spec"},
    r"hdf5.*": {"hdf5", "store"},
    r"matio.*": {"measurement"},
    r"(zip\.h|pugixml\.hpp)": {"fmi"},
    r"dlfcn\.h": {"fmi", "c_api"},
    r"pybind11/.*": {"python"},
    r"xxhash.*": {"store"},
    r"nlohmann/.*": {"json"},
    r"CLI/.*": {"cli"},
    r"nlopt.*": {"kernels"},
    r"spdlog/.*": {"monitoring"},
    r"filesystem": {"fmi", "spec", "inference", "export", "hdf5", "monitoring", "measurement", "store", "sampling", "results", "report", "comparison", "experiment", "experiment_design",
                     "sweep", "cluster", "verification", "c_api", "python", "cli"},
    r"(omp\.h|fstream|chrono)": {"fmi/fstream", "process/chrono", "process/fstream", "spec", "measurement/fstream", "monitoring/chrono", "simulation", "multibody", "evaluation/chrono",
                                 "store", "sampling", "comparison", "experiment", "sweep", "verification", "python/chrono", "cli", "kernels/omp.h", "kernels/chrono",
                                 "linalg/omp.h"},
}

INCLUDE = re.compile(r'^\s*#\s*include\s*([<"])([^>"]+)[>"]', re.MULTILINE)


def part_of(path):
    """'linalg', 'kernels' for the rest of kernels/, or a folder of framework."""
    if path.parts[0] == "kernels":
        return "linalg" if path.parts[1] == "linalg" else "kernels"
    return path.parts[1]


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
