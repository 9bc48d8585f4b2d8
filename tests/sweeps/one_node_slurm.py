# Starts a whole Slurm on this machine for tests: munge, a controller and one node, on the loopback interface.
# SPDX-License-Identifier: Apache-2.0
"""`OneNodeSlurm(folder)` runs until `stop()`. It needs root, because munge and Slurm's daemons do."""
import os
import pathlib
import pwd
import shutil
import signal
import socket
import subprocess
import time

NEEDED = ("slurmctld", "slurmd", "munged", "sbatch", "squeue", "scancel", "scontrol", "sinfo")
ENDS_WITH_US = ("setpriv", "--pdeathsig", "KILL", "--")  # so that no daemon is left when the test is killed
# Slurm runs a requeued task again when its credential has expired, which takes 120 s unless it is told otherwise.
CONF = """
ClusterName=glint-test
SlurmctldHost={host}(127.0.0.1)
SlurmctldPort={port}
SlurmdPort={node_port}
AuthType=auth/munge
AuthInfo=socket={folder}/munge.socket,cred_expire=20
CredType=cred/munge
SlurmUser=root
SlurmdUser=root
StateSaveLocation={folder}/state
SlurmdSpoolDir={folder}/spool
SlurmctldPidFile={folder}/slurmctld.pid
SlurmdPidFile={folder}/slurmd.pid
SlurmctldLogFile={folder}/slurmctld.log
SlurmdLogFile={folder}/slurmd.log
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SwitchType=switch/none
MpiDefault=none
SchedulerType=sched/backfill
SchedulerParameters=sched_interval=1,bf_interval=1,batch_sched_delay=0
SelectType=select/cons_tres
SelectTypeParameters=CR_Core_Memory
ReturnToService=2
MinJobAge=300
JobRequeue=1
KillWait=2
SlurmdTimeout=300
InactiveLimit=0
MaxArraySize=1001
NodeName={host} NodeAddr=127.0.0.1 Port={node_port} CPUs={cpus} RealMemory={memory} State=UNKNOWN
PartitionName=only Nodes={host} Default=YES MaxTime=INFINITE State=UP
"""


def missing():
    """Returns why Slurm cannot be started here, or an empty text."""
    os.environ["PATH"] += ":/usr/sbin:/sbin"
    lacking = [name for name in NEEDED if not shutil.which(name)]
    if lacking:
        return f"no {', '.join(lacking)} (Debian: slurm-wlm and munge)"
    return "" if os.geteuid() == 0 else "Slurm's daemons need root"


class OneNodeSlurm:
    def __init__(self, folder):
        self.folder = pathlib.Path(folder)
        for name in ("state", "spool"):
            (self.folder / name).mkdir(parents=True)
        self.pids = []
        self._start_munge()
        memory = os.sysconf("SC_PHYS_PAGES") * os.sysconf("SC_PAGE_SIZE") // 2**20 - 500
        host, self.cpus = socket.gethostname().split(".")[0], os.cpu_count()
        conf = self.folder / "slurm.conf"
        conf.write_text(CONF.format(host=host, folder=self.folder, port=_free_port(), node_port=_free_port(), cpus=self.cpus, memory=memory))
        os.environ["SLURM_CONF"] = str(conf)
        self._start("slurmctld", "-D", "-f", conf, "-c")
        self._start("slurmd", "-D", "-f", conf, "-N", host)
        self._wait(lambda: "idle" in subprocess.run(["sinfo", "-h", "-o", "%T"], capture_output=True, text=True).stdout, "the node did not come up")

    def _start_munge(self):
        user, key = pwd.getpwnam("munge"), self.folder / "munge.key"
        place = self.folder / "munge"
        place.mkdir()
        self.folder.chmod(0o755)
        key.write_bytes(os.urandom(1024))
        for path in (key, place):
            os.chown(path, user.pw_uid, user.pw_gid)
        key.chmod(0o400)
        place.chmod(0o755)
        # The socket lies where munge's user may make it; `self.folder` leads to it.
        words = [*ENDS_WITH_US, shutil.which("munged"), "--foreground", f"--socket={place}/socket", f"--key-file={key}", f"--pid-file={place}/pid", f"--seed-file={place}/seed", f"--log-file={place}/log"]
        child = subprocess.Popen(words, user=user.pw_uid, group=user.pw_gid, extra_groups=[], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        self.pids.append(child)
        (self.folder / "munge.socket").symlink_to(place / "socket")
        self._wait(lambda: (place / "socket").exists(), "munged did not start")

    def _start(self, name, *words):
        with open(self.folder / f"{name}.out", "wb") as log:
            self.pids.append(subprocess.Popen([*ENDS_WITH_US, shutil.which(name), *map(str, words)], stdout=log, stderr=log))

    def _wait(self, holds, message):
        end = time.monotonic() + 60
        while not holds():
            if time.monotonic() > end:
                logs = "".join(path.read_text(errors="replace")[-1500:] for path in self.folder.glob("*.log")) + "".join(path.read_text(errors="replace")[-800:] for path in self.folder.glob("*.out"))
                self.stop()
                raise RuntimeError(f"{message}\n{logs}")
            time.sleep(0.1)

    def jobs(self):
        return subprocess.run(["squeue", "-h", "-r", "-o", "%A|%j|%T"], capture_output=True, text=True).stdout.splitlines()

    def release_one(self):
        """Lets one task of the held arrays run."""
        held = subprocess.run(["squeue", "-h", "-r", "-o", "%F_%K"], capture_output=True, text=True, check=True).stdout.split()
        subprocess.run(["scontrol", "release", held[0]], check=True)

    def tasks(self):
        """Returns the processes of tasks that run, which are children of slurmd's steps."""
        out = []
        for path in pathlib.Path("/proc").glob("[0-9]*/cmdline"):
            try:
                if b"glint.sweeps.worker" in path.read_bytes() and f"SLURM_CONF={os.environ['SLURM_CONF']}".encode() in (path.parent / "environ").read_bytes():
                    out.append(int(path.parent.name))
            except OSError:
                continue
        return out

    def stop(self):
        subprocess.run(["scancel", "--user=root"], capture_output=True)
        for child in reversed(self.pids):
            child.send_signal(signal.SIGTERM)
            try:
                child.wait(10)
            except subprocess.TimeoutExpired:
                child.kill()
                child.wait()
        os.environ.pop("SLURM_CONF", None)


def _free_port():
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return probe.getsockname()[1]
