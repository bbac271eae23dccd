"""A Slurm of two nodes on this machine, started and stopped by whoever uses it, with a key and a socket of its own."""
import os
import shutil
import signal
import socket
import subprocess
import time
from pathlib import Path

PROGRAMS = ("munged", "slurmctld", "slurmd", "sbatch", "squeue")
CONFIGURATION = """
ClusterName=twinmap
SlurmctldHost={host}(127.0.0.1)
SlurmctldPort={controller}
SlurmUser=root
SlurmdUser=root
AuthType=auth/munge
AuthInfo=socket={folder}/munge.socket,cred_expire=15
CredType=cred/munge
StateSaveLocation={folder}/state
SlurmdSpoolDir={folder}/spool-%n
SlurmctldPidFile={folder}/slurmctld.pid
SlurmdPidFile={folder}/slurmd-%n.pid
SlurmctldLogFile={folder}/slurmctld.log
SlurmdLogFile={folder}/slurmd-%n.log
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
JobAcctGatherType=jobacct_gather/none
SelectType=select/cons_tres
SelectTypeParameters=CR_Core
SchedulerType=sched/backfill
SchedulerParameters=bf_interval=1,sched_min_interval=100000
SlurmdTimeout=15
SlurmctldTimeout=15
KillWait=3
ReturnToService=2
MpiDefault=none
SlurmdParameters=config_overrides
NodeName=n1 NodeHostname={host} NodeAddr=127.0.0.1 Port={first} CPUs=2 RealMemory=4000
NodeName=n2 NodeHostname={host} NodeAddr=127.0.0.1 Port={second} CPUs=2 RealMemory=4000
PartitionName=main Nodes=n1,n2 Default=YES MaxTime=INFINITE State=UP
"""


def find_missing():
    """What of Slurm is not here, or why it cannot be started; None if nothing is in the way."""
    path = os.environ["PATH"] + ":/usr/sbin:/sbin"
    missing = [name for name in PROGRAMS if shutil.which(name, path=path) is None]
    if missing:
        return f"Slurm is not installed: {', '.join(missing)}"
    return None if os.geteuid() == 0 else "a Slurm of one's own is started by root alone"


def find_ports(count):
    sockets = [socket.socket() for _ in range(count)]
    for one in sockets:
        one.bind(("127.0.0.1", 0))
    ports = [one.getsockname()[1] for one in sockets]
    for one in sockets:
        one.close()
    return ports


class Slurm:
    def __init__(self, folder):
        self.folder = folder
        folder.chmod(0o755)
        controller, first, second = find_ports(3)
        (folder / "state").mkdir()
        host = socket.gethostname().split(".")[0]
        (folder / "slurm.conf").write_text(
            CONFIGURATION.format(folder=folder, host=host, controller=controller, first=first, second=second)
        )
        self.environment = {
            **os.environ,
            "SLURM_CONF": str(folder / "slurm.conf"),
            "PATH": os.environ["PATH"] + ":/usr/sbin:/sbin",
        }
        self.processes = {}

    def spawn(self, name, *command):
        with open(self.folder / f"{name}.out", "ab") as log:
            self.processes[name] = subprocess.Popen(
                [str(word) for word in command], env=self.environment, stdout=log, stderr=log, start_new_session=True
            )

    def start(self):
        key = self.folder / "munge.key"
        key.write_bytes(os.urandom(128))
        key.chmod(0o600)
        self.spawn(
            "munged",
            "munged",
            "--foreground",
            "--force",
            "--key-file",
            key,
            "--socket",
            self.folder / "munge.socket",
            "--pid-file",
            self.folder / "munged.pid",
            "--log-file",
            self.folder / "munged.log",
            "--seed-file",
            self.folder / "munged.seed",
        )
        self.wait(lambda: (self.folder / "munge.socket").exists(), "munged does not answer")
        self.spawn("slurmctld", "slurmctld", "-D", "-c", "-f", self.folder / "slurm.conf")
        for node in ("n1", "n2"):
            (self.folder / f"spool-{node}").mkdir()
            self.start_node(node)
        self.wait(
            lambda: self.call("sinfo", "--noheader", "--format=%D %t").stdout.split() == ["2", "idle"],
            "the nodes do not come up",
        )

    def start_node(self, node):
        self.spawn(node, "slurmd", "-D", "-N", node, "-f", self.folder / "slurm.conf")

    def kill_node(self, node):
        """The node's daemon and all that runs on it."""
        tasks = [pid for pid in self.find_tasks() if self.read_environment(pid).get("SLURMD_NODENAME") == node]
        self.processes[node].kill()
        self.processes[node].wait()
        for pid in tasks:
            try:
                os.kill(pid, signal.SIGKILL)
            except ProcessLookupError:
                pass

    def read_environment(self, pid):
        try:
            pairs = Path(f"/proc/{pid}/environ").read_bytes().decode(errors="replace").split("\0")
        except OSError:
            return {}
        return dict(pair.split("=", 1) for pair in pairs if "=" in pair)

    def find_tasks(self):
        """Processes that this Slurm started for jobs."""
        return [
            int(pid)
            for pid in os.listdir("/proc")
            if pid.isdigit()
            and self.read_environment(pid).get("SLURM_CONF") == str(self.folder / "slurm.conf")
            and "SLURM_JOB_ID" in self.read_environment(pid)
        ]

    def call(self, *command, **options):
        return subprocess.run(
            [str(word) for word in command],
            env=self.environment,
            capture_output=True,
            text=True,
            timeout=120,
            **options,
        )

    def wait(self, condition, message, seconds=60.0):
        deadline = time.monotonic() + seconds
        while not condition():
            if time.monotonic() > deadline:
                logs = "".join(path.read_text(errors="replace")[-1500:] for path in self.folder.glob("slurm*.log"))
                raise RuntimeError(message + "\n" + logs)
            time.sleep(0.1)

    def is_idle(self):
        return self.call("squeue", "--noheader").stdout == ""

    def stop(self):
        self.call("scancel", "--user=root")
        for name in ("n1", "n2", "slurmctld", "munged"):
            process = self.processes.get(name)
            if process is not None and process.poll() is None:
                process.terminate()
                try:
                    process.wait(timeout=5)
                except subprocess.TimeoutExpired:
                    process.kill()
                    process.wait()
        for pid in self.find_tasks():
            os.kill(pid, signal.SIGKILL)
