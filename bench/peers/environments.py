"""Environments of the peers, made below a folder outside of the source tree: one a file of requirements."""
import os
import subprocess
from pathlib import Path

REQUIREMENTS = Path(__file__).resolve().parent / "requirements"
#: What the page names of each, of the many that they bring.
SHOWN = {
    "plain": ["scipy", "numpy", "pypesto", "mujoco", "scikit-learn"],
    "torch": ["sbi", "torch", "gpytorch", "numpy"],
    "figaroh": ["figaroh", "pin"],
}


def run(*command, **options):
    return subprocess.run([str(part) for part in command], check=True, **options)


def describe(error):
    """Without folders of this machine."""
    command = getattr(error, "cmd", None)
    return f"`{Path(command[0]).name}` ends with status {error.returncode}" if command else type(error).__name__


class Environments:
    def __init__(self, folder, build):
        self.folder, self.build = folder, build

    def get_variables(self, name):
        """One thread each, twinmap's command and package, and where Debian's torch was unpacked."""
        paths, libraries = [self.build / "framework/python"], []
        if name == "torch":
            root = self.folder / "torch-root/usr"
            paths.append(root / "lib/python3/dist-packages")
            libraries = [root / "lib", root / "lib/x86_64-linux-gnu"]
        return {
            **os.environ,
            **{f"{kind}_NUM_THREADS": "1" for kind in ("OMP", "OPENBLAS", "MKL")},
            "PYTHONPATH": ":".join(map(str, paths)),
            "LD_LIBRARY_PATH": ":".join(map(str, libraries)),
            "TWINMAP": str(self.build / "framework/cli/twinmap"),
        }

    def get_python(self, name):
        return self.folder / name / "bin/python"

    def is_ready(self, name):
        return (self.folder / f"{name}.ready").exists()

    def explain_lack(self, name):
        """Why make() could not have it the last time; "" where it could, or was not asked."""
        file = self.folder / f"{name}.lacks"
        return file.read_text() if file.exists() else ""

    def make(self, name):
        """Nothing where it is there already; explain_lack() where it cannot be had."""
        if self.is_ready(name):
            return
        lacks = self.folder / f"{name}.lacks"
        self.folder.mkdir(parents=True, exist_ok=True)
        try:
            self.install(name)
            lacks.unlink(missing_ok=True)
            (self.folder / f"{name}.ready").touch()
        except (OSError, subprocess.CalledProcessError) as error:
            lacks.write_text(f"its environment `{name}` cannot be had: {describe(error)}")

    def install(self, name):
        options = []
        if name == "torch":
            self.unpack_torch()
            options = ["--system-site-packages"]
        run("/usr/bin/python3", "-m", "venv", "--clear", *options, self.folder / name)
        install = [self.get_python(name), "-m", "pip", "install", "--quiet", "-r", REQUIREMENTS / f"{name}.txt"]
        run(*install, env=self.get_variables(name))

    def unpack_torch(self):
        """Debian's, without installing it: a wheel of torch brings gigabytes for graphics cards."""
        planned = run("apt-get", "install", "-s", "--no-install-recommends", "python3-torch", capture_output=True)
        names = [line.split()[1] for line in planned.stdout.decode().splitlines() if line.startswith("Inst ")]
        packages = self.folder / "torch-packages"
        packages.mkdir(parents=True, exist_ok=True)
        run("apt-get", "download", *names, cwd=packages)
        for package in packages.glob("*.deb"):
            run("dpkg", "-x", package, self.folder / "torch-root")

    def get_twinmap_version(self):
        command = [self.get_variables("plain")["TWINMAP"], "--version"]
        return run(*command, capture_output=True, text=True).stdout.strip()

    def list_versions(self, name):
        if not self.is_ready(name):
            return []
        code = f"from importlib.metadata import version\nfor n in {SHOWN[name]}: print(n, version(n))"
        done = run(self.get_python(name), "-c", code, env=self.get_variables(name), capture_output=True, text=True)
        return done.stdout.splitlines()
