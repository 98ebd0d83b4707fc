"""What an installation without extras has: other libraries of this environment are hidden."""

from __future__ import annotations

import json
import re
from importlib.metadata import PackageNotFoundError, distribution, packages_distributions

SITE = """
import sys

class Hidden:
    names = frozenset({names})

    def find_spec(self, name, path=None, target=None):
        if name.partition(".")[0] in self.names:
            raise ModuleNotFoundError(f"No module named '{{name}}'", name=name)

sys.meta_path.insert(0, Hidden())
"""


def normalise(name):
    return re.sub(r"[-_.]+", "-", name).lower()


def list_plain(root="tinsmith"):
    """Return the distributions that pip installs with one, by what their metadata require."""
    found, waiting = set(), [(root, frozenset())]
    seen = set()
    while waiting:
        name, extras = waiting.pop()
        if (name, extras) in seen:
            continue
        seen.add((name, extras))
        try:
            required = distribution(name).requires or []
        except PackageNotFoundError:  # of another system
            continue
        found.add(normalise(name))
        for line in required:
            requirement, _, marker = line.partition(";")
            asked = re.search(r"extra\s*==\s*['\"]([^'\"]+)", marker)
            if asked is not None and asked[1] not in extras:
                continue
            other, wanted = re.match(r"([\w.-]+)(?:\[([^\]]*)\])?", requirement).groups()
            waiting.append((normalise(other), frozenset(re.findall(r"[\w.-]+", wanted or ""))))
    return found


def list_hidden():
    """Return the modules that only other distributions bring."""
    plain = list_plain()
    return sorted(
        module
        for module, owners in packages_distributions().items()
        if not plain & {normalise(one) for one in owners} and module.isidentifier()
    )


def hide_others(folder):
    """Write a sitecustomize into a folder, which hides those modules from every process."""
    text = SITE.format(names=json.dumps(list_hidden()))
    (folder / "sitecustomize.py").write_text(text, encoding="utf-8")
