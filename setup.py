"""Builds the package's module by CMake; pyproject.toml says the rest."""
import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

from setuptools import Extension, setup
from setuptools.command.build_ext import build_ext

ROOT = Path(__file__).resolve().parent
TARGET = "twinmap_python"
SIMBODY = "twinmap_simbody.so"
UNITS = "share/twinmap/units"


def find_version():
    return re.search(r"project\(twinmap VERSION (\S+)", (ROOT / "CMakeLists.txt").read_text()).group(1)


def belongs_to_this_python(build):
    """Whether the module that this build folder makes is for this interpreter."""
    cache = build / "CMakeCache.txt"
    found = re.search(r"^_?Python3_EXECUTABLE:\w+=(.+)$", cache.read_text(), re.MULTILINE) if cache.is_file() else None
    return found is not None and os.path.realpath(found.group(1)) == os.path.realpath(sys.executable)


def choose_build():
    """TWINMAP_BUILD, else build/release, where most is built already, unless it is for another Python."""
    if "TWINMAP_BUILD" in os.environ:
        return Path(os.environ["TWINMAP_BUILD"]).resolve()
    release = ROOT / "build" / "release"
    return release if belongs_to_this_python(release) else ROOT / "build" / "python"


class CMakeBuild(build_ext):
    def build_extension(self, extension):
        build = choose_build()
        if not (build / "build.ninja").is_file():
            subprocess.run(
                [
                    "cmake",
                    "--preset",
                    "release",
                    "-B",
                    str(build),
                    "-DTWINMAP_BUILD_TESTS=OFF",
                    "-DTWINMAP_BUILD_BENCHMARKS=OFF",
                    "-DTWINMAP_BUILD_PYTHON=ON",
                    f"-DPython3_EXECUTABLE={sys.executable}",
                ],
                cwd=ROOT,
                check=True,
            )
        subprocess.run(["cmake", "--build", str(build), "--target", TARGET], check=True)
        target = Path(self.get_ext_fullpath(extension.name))
        target.parent.mkdir(parents=True, exist_ok=True)
        shutil.copy2(build / "framework" / "python" / "twinmap" / target.name, target)
        # which the module loads from there
        shutil.copy2(next(build.glob(f"lib*/**/twinmap/{SIMBODY}")), target.parent)
        shutil.copytree(build / UNITS, target.parent / UNITS, dirs_exist_ok=True)


setup(
    version=find_version(), ext_modules=[Extension("twinmap._twinmap", sources=[])], cmdclass={"build_ext": CMakeBuild}
)
