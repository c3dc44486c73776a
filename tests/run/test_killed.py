"""A run is killed at random moments and resumed until it ends: its results have the same bits as those of a run
that was left alone. The moments are drawn anew each time; their seed is printed.

usage: test_killed.py WISP RANKS
"""
import os
import random
import signal
import subprocess
import sys
import tempfile
import time

from program import expect, expect_success, same_files, wisp, write_case

KILLS = 4


def descendants(pid):
    """Processes that a process started, and those that they started: ranks are in groups of their own."""
    children = {}
    for name in filter(str.isdigit, os.listdir("/proc")):
        try:
            with open(f"/proc/{name}/stat", encoding="utf-8") as stream:
                parent = int(stream.read().rsplit(")", 1)[1].split()[1])
        except OSError:
            continue
        children.setdefault(parent, []).append(int(name))
    found = [pid]
    for one in found:
        found += children.get(one, [])
    return found


def is_alive(pid):
    try:
        with open(f"/proc/{pid}/stat", encoding="utf-8") as stream:
            return stream.read().rsplit(")", 1)[1].split()[0] != "Z"
    except OSError:
        return False


def kill_all(pid):
    pids = descendants(pid)
    for one in pids:
        try:
            os.kill(one, signal.SIGKILL)
        except ProcessLookupError:
            pass
    while any(is_alive(one) for one in pids):
        time.sleep(0.01)


def kill_at(command, seconds):
    """Starts the program and kills it, with all its ranks, after a while; tells whether it was still running."""
    process = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True,
                               start_new_session=True)
    try:
        _, errors = process.communicate(timeout=seconds)
        return False, process.returncode, errors
    except subprocess.TimeoutExpired:
        kill_all(process.pid)
        process.communicate()
        return True, process.returncode, ""


def main(program, ranks):
    seed = random.randrange(10**6)
    print(f"seed {seed}")
    moments = random.Random(seed)
    many = [] if ranks == "1" else ["--ranks", ranks]
    with tempfile.TemporaryDirectory() as folder:
        case = write_case(folder, basis="gimp", points=3,
                          stage='type = "explicit"\nduration = 0.2\nsteps = 400\nmass = "consistent"',
                          output="frames = 10\ncheckpoint_every = 10")
        alone, killed = os.path.join(folder, "alone"), os.path.join(folder, "killed")
        started = time.monotonic()
        expect_success(wisp(program, "run", case, "--out", alone, *many))
        duration = time.monotonic() - started
        command = [program, "run", case, "--out", killed, *many]
        count = 0
        for _ in range(KILLS):
            was_running, status, errors = kill_at(command, moments.uniform(0.15, 0.4) * duration)
            count += was_running
            expect(was_running or status == 0, f"status {status}: {errors}")
            if os.path.exists(os.path.join(killed, "checkpoint.txt")):
                command = [program, "resume", killed]
        print(f"killed {count} times")
        expect(count > 0, "the run was never killed")
        expect_success(wisp(*command))
        names, different = same_files(alone, killed)
        expect(len(names) >= 14, f"only {len(names)} files")
        expect(not different, f"after {count} kills these files differ: {', '.join(different)}")


if __name__ == "__main__":
    main(*sys.argv[1:])
