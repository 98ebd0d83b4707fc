"""Run campaigns in child processes, and make small and keep what they find."""

from __future__ import annotations

import itertools
import json
import sys
import time
from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass, field
from multiprocessing.connection import wait
from pathlib import Path

from .campaign import Campaign, Case
from .child import Child, Outcome
from .minimise import minimise

MOST_LABELS = 6  # of a campaign in the summary
MOST_SHOWN = 12  # case numbers at one place; a find's file has all


@dataclass
class Options:
    """How a run goes; `cases` or else `seconds` ends each campaign."""

    seed: int = 1
    cases: int | None = None
    seconds: float | None = None
    jobs: int = 2
    first: int = 0
    folder: Path = Path("build/fuzz")
    most_defects: int = 5
    has_limits: bool = True
    shrink_seconds: float = 30.0  # for making one find small


@dataclass
class Tally:
    """What became of the cases of one campaign."""

    campaign: str
    labels: Counter[str] = field(default_factory=Counter)
    finds: Counter[str] = field(default_factory=Counter)  # by where
    numbers: dict[str, list[int]] = field(default_factory=dict)  # of the cases, by where
    files: dict[str, Path] = field(default_factory=dict)  # by where
    seconds: float = 0.0

    @property
    def n_cases(self) -> int:
        """Cases examined, finds included."""
        return self.labels.total() + self.finds.total()


def run_campaign(campaign: Campaign, options: Options) -> Tally:
    """Examine numbered cases until enough are done, or enough defects are found."""
    tally = Tally(campaign.name)
    began = time.monotonic()
    numbers = _numbers(options, began)
    children = [
        Child(campaign, options.seed, has_limits=options.has_limits) for _ in range(options.jobs)
    ]
    try:
        busy = {c for c in children if _give(c, numbers)}
        while busy:
            for child in _answering(busy):
                outcome = child.receive()
                _note(campaign, options, tally, child.number, outcome)
                if len(tally.finds) >= options.most_defects or not _give(child, numbers):
                    busy.discard(child)
            _show(options, tally, began)
    finally:
        for child in children:
            child.stop()
    tally.seconds = time.monotonic() - began
    _end_line(options)
    _note_further_cases(tally)
    return tally


def _numbers(options: Options, began: float) -> Iterator[int]:
    for count in itertools.count():
        if options.cases is not None and count >= options.cases:
            return
        if options.seconds is not None and time.monotonic() - began > options.seconds:
            return
        yield options.first + count


def _give(child: Child, numbers: Iterator[int]) -> bool:
    number = next(numbers, None)
    if number is None:
        return False
    child.number = number
    child.send("number", number)
    return True


def _answering(busy: set[Child]) -> list[Child]:
    """Wait for answers, or for the first deadline."""
    patience = max(0.0, min(c.deadline for c in busy) - time.monotonic())
    ready = set(wait([c.connection for c in busy], timeout=patience))
    now = time.monotonic()
    return [c for c in busy if c.connection in ready or c.deadline <= now]


# ------------------------------------------------------------------------- finds


def _note(
    campaign: Campaign, options: Options, tally: Tally, number: int, outcome: Outcome
) -> None:
    if outcome.kind is None:
        tally.labels[outcome.label] += 1
        return
    is_new = outcome.where not in tally.finds
    if is_new and outcome.kind == "hang" and not _recurs(campaign, options, number):
        tally.labels["slow"] += 1
        return
    tally.finds[outcome.where] += 1
    tally.numbers.setdefault(outcome.where, []).append(number)
    if is_new:
        _end_line(options)
        tally.files[outcome.where] = keep_find(campaign, options, number, outcome)


def _note_further_cases(tally: Tally) -> None:
    """Write into each find, and print, which other cases ended at the same place."""
    for where, path in tally.files.items():
        others = sorted(tally.numbers[where][1:])
        if others:
            find = json.loads(path.read_text(encoding="utf-8"))
            path.write_text(json.dumps({**find, "others": others}, indent=1) + "\n", "utf-8")
            shown = ", ".join(map(str, others[:MOST_SHOWN]))
            more = f" and {len(others) - MOST_SHOWN:,} more" if len(others) > MOST_SHOWN else ""
            print(f"also in {tally.campaign}, cases {shown}{more}: {where}", flush=True)


def _recurs(campaign: Campaign, options: Options, number: int) -> bool:
    """Return whether a case hangs again, alone: a busy machine makes cases slow, too."""
    child = Child(campaign, options.seed, has_limits=options.has_limits)
    try:
        return child.ask("number", number).kind is not None
    finally:
        child.stop()


def keep_find(campaign: Campaign, options: Options, number: int, outcome: Outcome) -> Path:
    """Make a find small, write it, and print how to see it again."""
    child = Child(campaign, options.seed, has_limits=options.has_limits)
    try:
        case = child.ask("make", number)
        is_made = not isinstance(case, Outcome)
        small = _minimised(child, case, outcome, options.shrink_seconds) if is_made else None
    finally:
        child.stop()
    options.folder.mkdir(parents=True, exist_ok=True)
    path = options.folder / f"{campaign.name}-{options.seed}-{number}.json"
    find = {
        "campaign": campaign.name,
        "seed": options.seed,
        "number": number,
        "kind": outcome.kind,
        "where": outcome.where,
        "text": outcome.text,
        "case": small,
    }
    path.write_text(json.dumps(find, indent=1) + "\n", encoding="utf-8")
    print(f"FOUND {outcome.kind} in {campaign.name}, case {number}: {outcome.where}")
    print("  " + outcome.text.strip().replace("\n", "\n  "))
    print(f"  again: --campaign {campaign.name} --seed {options.seed} --only {number}")
    print(f"  small: --replay {path}", flush=True)
    return path


def _minimised(child: Child, case: Case, outcome: Outcome, seconds: float) -> Case:
    def is_same(candidate: Case) -> bool:
        other = child.ask("case", candidate)
        return bool(other.kind == outcome.kind and other.where == outcome.where)

    if not is_same(case):
        print("  does not recur alone: it depends on what ran before it, or on chance")
        return case
    small: Case = minimise(case, is_same, seconds=seconds)
    return small


# -------------------------------------------------------------------------- told


def _show(options: Options, tally: Tally, began: float) -> None:
    if not sys.stderr.isatty():
        return
    rate = tally.n_cases / max(1e-9, time.monotonic() - began)
    line = f"{tally.campaign}: {tally.n_cases:,} cases, {rate:,.0f}/s, {tally.finds.total()} finds"
    print(f"\r{line:<78}", end="", file=sys.stderr, flush=True)


def _end_line(options: Options) -> None:
    if sys.stderr.isatty():
        print(f"\r{'':<78}\r", end="", file=sys.stderr, flush=True)


def summarize(tallies: list[Tally]) -> str:
    """Return a table: cases, seconds, finds, and what became of the cases."""
    lines = [f"{'campaign':<20} {'cases':>9} {'seconds':>8} {'finds':>6}  outcomes"]
    for tally in tallies:
        common = tally.labels.most_common(MOST_LABELS)
        outcomes = ", ".join(f"{label} {n:,}" for label, n in common)
        if len(tally.labels) > MOST_LABELS:
            outcomes += f", other {tally.labels.total() - sum(n for _, n in common):,}"
        lines.append(
            f"{tally.campaign:<20} {tally.n_cases:>9,} {tally.seconds:>8.1f} "
            f"{tally.finds.total():>6}  {outcomes}"
        )
    return "\n".join(lines)
