"""Long proofs run only when asked for by their marker."""

from __future__ import annotations


def pytest_collection_modifyitems(config, items):
    if "proof" in config.option.markexpr:
        return
    proofs = [item for item in items if "proof" in item.keywords]
    config.hook.pytest_deselected(items=proofs)
    items[:] = [item for item in items if "proof" not in item.keywords]
