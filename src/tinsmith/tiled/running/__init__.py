"""How a run is carried out: its folder and records, phases of tasks, and who does these."""

from .executors import Processes, connect_to_dask, run_tasks
from .run_options import RunOptions, RunSettings, estimate_memory
from .runs import FINAL, Fingerprint, Record, Run, UnfinishedError, hash_file
from .workers import Phase, Status

__all__ = [
    "FINAL",
    "Fingerprint",
    "Phase",
    "Processes",
    "Record",
    "Run",
    "RunOptions",
    "RunSettings",
    "Status",
    "UnfinishedError",
    "connect_to_dask",
    "estimate_memory",
    "hash_file",
    "run_tasks",
]
