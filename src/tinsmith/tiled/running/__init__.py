"""How a run is carried out: its folder and records, phases of tasks, and who does these."""

from .executors import Processes, connect_to_dask, run_tasks
from .how import How, Way, estimate_memory
from .runs import FINAL, Fingerprint, Record, Run, UnfinishedError, hash_file
from .workers import Phase, Status

__all__ = [
    "FINAL",
    "Fingerprint",
    "How",
    "Phase",
    "Processes",
    "Record",
    "Run",
    "Status",
    "UnfinishedError",
    "Way",
    "connect_to_dask",
    "estimate_memory",
    "hash_file",
    "run_tasks",
]
