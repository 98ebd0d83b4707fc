"""What children are asked to do in the tests of their limits."""

import os
import signal
import sys
import time

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
