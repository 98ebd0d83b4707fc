"""What children are asked to do in the tests of their limits."""

import os
import signal
import sys
import time
from pathlib import Path

import numpy as np

from tinsmith.io.isolated import Answer, Refusal


def answer(**arguments):
    """Print where no answer belongs, and answer."""
    sys.stdout.write("noise")
    sys.stdout.flush()
    sys.stderr.write("noise")
    os.write(1, b"noise of a library")
    return Answer(arguments, {"numbers": np.arange(3.0), "none": np.empty((0, 2), np.int64)})


def parts(count):
    """Answer in parts."""
    for k in range(count):
        yield Answer(k, {"numbers": np.full(200_000, k)})


def process(path=None):
    """Tell which process answers, and where it looks for modules."""
    return Answer([os.getpid(), sys.path], {})


def refuse(text):
    raise Refusal(text)


def fail(text):
    raise ValueError(text)


def crash():
    os.kill(os.getpid(), signal.SIGSEGV)


def spin():
    while True:
        pass


def wait():
    time.sleep(1000)


def hoard():
    return Answer(None, {"numbers": np.ones(1 << 40, np.uint8)})


def hoard_slowly():
    kept = []
    while True:
        kept.append(bytearray(os.urandom(16)) * (1 << 20))


def objects():
    return Answer(None, {"objects": np.array([object()])})


def leave():
    os._exit(0)


def limits():
    """Tell what limits there are, and what is in use."""
    import resource

    pages = int(Path("/proc/self/statm").read_text().split()[0])
    found = {
        "seconds": resource.getrlimit(resource.RLIMIT_CPU)[0],
        "used": sum(resource.getrusage(resource.RUSAGE_SELF)[:2]),
        "memory": resource.getrlimit(resource.RLIMIT_AS)[0],
        "mapped": pages * resource.getpagesize(),
        "core": resource.getrlimit(resource.RLIMIT_CORE),
        "ends": [str(Path(f"/proc/self/fd/{number}").readlink()) for number in range(3)],
    }
    return Answer(found, {})


def limits_of_parts():
    """Work for more than a second between two answers."""
    found = limits()
    begin = time.process_time()
    while time.process_time() < begin + 1.1:
        pass
    yield found
    yield limits()
