"""The program as something that runs: what it printed, how it ended, what it took."""
import os
import re
import resource
import signal
import subprocess
import tempfile
import time

MAX_RESIDENT_MIB = 1024
MAX_ADDRESS_MIB = 4096  # what is beyond it fails to allocate, so that the machine stays usable
MAX_LINE_CHARACTERS = 4500  # the longest path of the system and a sentence
# C0 but for newline and tab, DEL, and C1, which terminals take for commands
CONTROL = re.compile("[\x00-\x08\x0b-\x1f\x7f-\x9f]")
# sanitizers map all of the address space
LIMITS_ADDRESSES = "SANITIZED" not in os.environ


def limit_this_process():
    """For all that is started from now on."""
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
    if LIMITS_ADDRESSES:
        limit = MAX_ADDRESS_MIB << 20
        resource.setrlimit(resource.RLIMIT_AS, (limit, limit))


class Outcome:
    def __init__(self, arguments, status, out, err, is_hung, peak_mib, seconds):
        self.arguments = arguments
        self.exit = os.waitstatus_to_exitcode(status)  # negative: the signal
        self.out = out
        self.err = err
        self.is_hung = is_hung
        self.peak_mib = peak_mib
        self.seconds = seconds

    def complaints(self):
        """Lines of stderr that are no warnings and no progress."""
        kept = []
        for line in self.err.splitlines():
            is_warning = re.match(r"samewhere: (warning|info): ", line)
            is_progress = re.search(r" \d+/\d+ +[\d.]+ per s +\d+ s left$|^Writing \d+ nodes to ", line)
            if line and not is_warning and not is_progress:
                kept.append(line)
        return kept

    def faults(self):
        """What no input may bring about, whatever it holds: one sentence each."""
        found = []
        if self.is_hung:
            found.append(f"did not end within {self.seconds:.0f} s")
        elif self.exit < 0:
            found.append(f"ended by {signal.Signals(-self.exit).name}")
        elif self.exit not in (0, 2, 130):
            found.append(f"exit status {self.exit}")
        if self.exit == 2 and len(self.complaints()) != 1:
            found.append(f"{len(self.complaints())} lines on stderr, expected one")
        if self.exit == 0 and self.complaints():
            found.append("exit status 0 and something on stderr that is no warning")
        if self.peak_mib > MAX_RESIDENT_MIB:
            found.append(f"{self.peak_mib:.0f} MiB of memory, expected {MAX_RESIDENT_MIB} at most")
        for name, text in (("stdout", self.out), ("stderr", self.err)):
            if CONTROL.search(text):
                found.append(f"control characters on {name}")
            if any(len(line) > MAX_LINE_CHARACTERS for line in text.splitlines()):
                found.append(f"a line of more than {MAX_LINE_CHARACTERS} characters on {name}")
        return found

    def __str__(self):
        last = " | ".join(self.err.splitlines()[-2:])[:300]
        return f"samewhere {' '.join(self.arguments)}: exit {self.exit}: {last!r}"


class Program:
    def __init__(self, path, timeout_s=20.0):
        self.path = os.path.realpath(path)
        self.timeout_s = timeout_s

    def run(self, *arguments, cwd, timeout_s=None, env=None):
        arguments = [str(argument) for argument in arguments]
        with tempfile.TemporaryFile() as out, tempfile.TemporaryFile() as err:
            start = time.monotonic()
            child = subprocess.Popen([self.path, *arguments], cwd=cwd, stdin=subprocess.DEVNULL,
                                     stdout=out, stderr=err, env=env, start_new_session=True)
            status, usage, is_hung = wait(child, start + (timeout_s or self.timeout_s))
            seconds = time.monotonic() - start
            return Outcome(arguments, status, text_of(out), text_of(err), is_hung,
                           usage.ru_maxrss / 1024, seconds)


def wait(child, end):
    pause_s = 0.001
    while True:
        pid, status, usage = os.wait4(child.pid, os.WNOHANG)
        if pid:
            child.returncode = os.waitstatus_to_exitcode(status)
            return status, usage, False
        if time.monotonic() > end:
            child.kill()
            _, status, usage = os.wait4(child.pid, 0)
            child.returncode = os.waitstatus_to_exitcode(status)
            return status, usage, True
        time.sleep(pause_s)
        pause_s = min(2 * pause_s, 0.02)


def text_of(file):
    file.seek(0)
    return file.read(4 << 20).decode("utf-8", errors="replace")
