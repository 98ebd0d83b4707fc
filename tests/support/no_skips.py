"""A plugin of pytest: in CI a skipped test fails, as nobody would see that it was left out.

A missing extra, graphics library or device would else hide all the tests that need it.
"""

from __future__ import annotations

import os

import pytest


def pytest_addoption(parser):
    parser.addoption(
        "--no-skips",
        action="store_true",
        default=os.environ.get("CI", "").lower() not in ("", "0", "false"),
        help="skipped and expected failures fail; so it is wherever CI is set",
    )


def _fail_if_skipped(config, report):
    if report.skipped and config.getoption("no_skips"):
        reason = getattr(report, "wasxfail", None) or str(report.longrepr)
        vars(report).pop("wasxfail", None)
        report.outcome = "failed"
        report.longrepr = f"skipped where nothing may be skipped: {reason}"


@pytest.hookimpl(wrapper=True)
def pytest_runtest_makereport(item):
    report = yield
    _fail_if_skipped(item.config, report)
    return report


@pytest.hookimpl(wrapper=True)
def pytest_make_collect_report(collector):
    report = yield
    _fail_if_skipped(collector.config, report)
    return report
