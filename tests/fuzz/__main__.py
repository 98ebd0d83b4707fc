"""The command line of the campaigns; exit code 1 says that something was found."""

from __future__ import annotations

import os

# Small cases gain nothing from a second BLAS thread, and a process with threads forks badly.
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

import argparse
import dataclasses
import json
import sys
from pathlib import Path
from typing import Any

from .campaign import Campaign, discover
from .child import Child
from .run import Options, run_campaign, summarize

MINUTES = 5.0


def parse(arguments: list[str] | None = None) -> argparse.Namespace:
    parser = argparse.ArgumentParser("python -m fuzz", description=__doc__)
    add = parser.add_argument
    add("--campaign", action="append", metavar="NAME", help="only this one; may be repeated")
    add("--cases", type=int, help="cases of each campaign")
    add("--minutes", type=float, help=f"minutes for all campaigns together [{MINUTES:g}]")
    add("--seed", type=int, default=1)
    add("--jobs", type=int, default=os.cpu_count() or 1)
    add("--only", type=int, metavar="NUMBER", help="the one case of this number")
    add("--first", type=int, default=0, metavar="NUMBER", help="number to begin with")
    add("--replay", type=Path, metavar="FILE", help="examine the case of a find again")
    add("--module", action="append", default=[], help="a further module with CAMPAIGNS")
    add("--folder", type=Path, default=Path("build/fuzz"), help="where finds are kept")
    add("--shrink-seconds", type=float, default=30.0, help="time to make one find small [30]")
    add("--no-memory-limit", action="store_true", help="as sanitizers need it")
    add("--list", action="store_true", help="list the campaigns")
    return parser.parse_args(arguments)


def main(arguments: list[str] | None = None) -> int:
    given = parse(arguments)
    find = json.loads(given.replay.read_text(encoding="utf-8")) if given.replay else None
    campaigns = discover(given.module, [find["campaign"]] if find else given.campaign or ())
    if given.list:
        print("\n".join(f"{c.name:<20} {c.what}" for c in campaigns.values()))
        return 0
    if find:
        return replay(campaigns, find, has_limits=not given.no_memory_limit)
    unknown = set(given.campaign or ()) - set(campaigns)
    if unknown:
        sys.exit(f"no campaign {', '.join(sorted(unknown))}; there are {', '.join(campaigns)}")
    chosen = [c for name, c in campaigns.items() if name in (given.campaign or campaigns)]
    return run_all(chosen, as_options(given, len(chosen)))


def as_options(given: argparse.Namespace, n_campaigns: int) -> Options:
    options = Options(
        seed=given.seed,
        jobs=given.jobs,
        first=given.first,
        folder=given.folder,
        shrink_seconds=given.shrink_seconds,
        has_limits=not given.no_memory_limit,
    )
    if given.only is not None:
        return dataclasses.replace(options, first=given.only, cases=1, jobs=1)
    if given.cases is not None:
        return dataclasses.replace(options, cases=given.cases)
    minutes = MINUTES if given.minutes is None else given.minutes
    return dataclasses.replace(options, seconds=60.0 * minutes / n_campaigns)


def run_all(campaigns: list[Campaign], options: Options) -> int:
    tallies = []
    for campaign in campaigns:
        own = options
        if options.cases is not None and len(campaigns) > 1:
            own = dataclasses.replace(options, cases=-(-options.cases // campaign.weight))
        tallies.append(run_campaign(campaign, own))
        print(summarize(tallies[-1:]).splitlines()[1], flush=True)
    print(f"\nseed {options.seed}\n{summarize(tallies)}")
    return int(any(tally.finds for tally in tallies))


def replay(campaigns: dict[str, Campaign], find: dict[str, Any], *, has_limits: bool) -> int:
    child = Child(campaigns[find["campaign"]], find["seed"], has_limits=has_limits)
    try:
        outcome = child.ask("case", find["case"])
    finally:
        child.stop()
    print(f"{outcome.kind}: {outcome.where}\n{outcome.text}" if outcome.kind else outcome.label)
    return int(outcome.kind is not None)


if __name__ == "__main__":
    sys.exit(main())
