"""What cmake --install leaves, used as others do: by pkg-config, by find_package, from another place."""
import os
import shutil
import subprocess
import sys
import unittest
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parent.parent / "cli"))
from support import RunTestCase  # noqa: E402

BUILD = os.environ["TWINMAP_BUILD_DIR"]
LIBRARY = os.environ["TWINMAP_LIBRARY"]


def run(*command, **options):
    result = subprocess.run([str(word) for word in command], capture_output=True, text=True, timeout=600, **options)
    if result.returncode != 0:
        raise RuntimeError(f"{command}: {result.stdout}{result.stderr}")
    return result.stdout


class Symbols(unittest.TestCase):
    def test_exports_its_functions_alone_and_with_their_version(self):
        lines = [line.split() for line in run("nm", "-D", "--defined-only", LIBRARY).splitlines()]
        names = {line[-1] for line in lines} - {"TWINMAP_0.1"}
        self.assertTrue(all(name.startswith("twinmap_") and name.endswith("@@TWINMAP_0.1") for name in names), names)
        header = (Path(os.environ["TWINMAP_SOURCE_DIR"]) / "framework/c_api/twinmap.h").read_text()
        self.assertEqual(len(names), header.count("\nTWINMAP_API "))

    def test_has_a_versioned_name(self):
        self.assertIn("libtwinmap.so.0]", run("readelf", "-d", LIBRARY))


class Installed(RunTestCase):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        first = cls.folder / "first"
        run("cmake", "--install", BUILD, "--prefix", first)
        cls.prefix = cls.folder / "elsewhere"  # nothing may depend on where it was installed
        first.rename(cls.prefix)
        cls.libraries = next(cls.prefix.rglob("libtwinmap.so")).parent
        cls.example = next(cls.prefix.rglob("infer.c"))
        cls.measurement = cls.simulate("m.csv", "parameters.k_y=8")

    def expect_answer(self, program):
        output = run(
            program, self.run_folder, self.measurement, env={**os.environ, "LD_LIBRARY_PATH": str(self.libraries)}
        )
        self.assertRegex(output, r"m\.csv: ok \(p = 0\.\d+\)\n")
        self.assertRegex(output, r"k_y +(7\.9|8\.)\d* \+- 0\.0\d+ +N/m")

    def test_example_by_pkg_config(self):
        environment = {**os.environ, "PKG_CONFIG_PATH": str(self.libraries / "pkgconfig")}
        flags = run("pkg-config", "--cflags", "--libs", "twinmap", env=environment).split()
        program = self.folder / "by_pkg_config"
        run("cc", "-std=c99", "-pedantic", "-Wall", "-Wextra", "-Werror", self.example, *flags, "-o", program)
        self.expect_answer(program)

    def test_example_by_find_package(self):
        source, build = self.folder / "example", self.folder / "example_build"
        shutil.copytree(self.example.parent, source)
        run("cmake", "-S", source, "-B", build, f"-DCMAKE_PREFIX_PATH={self.prefix}")
        run("cmake", "--build", build)
        self.expect_answer(build / "infer")

    def test_python_package(self):
        package = next(iter(self.prefix.rglob("dist-packages")), None)
        if package is None:
            self.skipTest("the Python package was not built")
        environment = {**os.environ, "PYTHONPATH": str(package)}
        code = (
            f"import twinmap; print(twinmap.Map.load({str(self.run_folder)!r}).infer({str(self.measurement)!r}).status)"
        )
        self.assertEqual(run("/usr/bin/python3", "-c", code, env=environment), "ok\n")

    def test_header_is_one_of_cpp_as_well(self):
        source = self.folder / "header.cpp"
        source.write_text("#include <twinmap.h>\nint main() { return twinmap_get_version()[0] == 0; }\n")
        run(
            "c++",
            "-std=c++17",
            "-Wall",
            "-Wextra",
            "-Werror",
            f"-I{self.prefix}/include",
            source,
            f"-L{self.libraries}",
            "-ltwinmap",
            "-o",
            self.folder / "header",
        )
