"""A study whose trial reports the process it runs in."""

import os
import signal
from dataclasses import replace

from tests import toy_study


def trial(condition, seed):
    names = ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS", "NUMBA_NUM_THREADS")
    found = {name: os.environ.get(name) for name in names}
    return {**found, "sigint": signal.getsignal(signal.SIGINT) is signal.SIG_IGN}


study = replace(toy_study.study, name="toy-environment", trial=trial)
