"""The recipe for conda says what pyproject.toml says."""

from __future__ import annotations

import re
import tomllib

import yaml
from support.distributions import ROOT

import tinsmith as ts

RECIPE = yaml.safe_load((ROOT / "packaging" / "conda" / "recipe.yaml").read_text())
VARIANTS = yaml.safe_load((ROOT / "packaging" / "conda" / "variants.yaml").read_text())
PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text())


NO_EXTRAS = {"laspy[lazrs]>=2.5": {"laspy>=2.5", "lazrs-python"}}
"""conda has no extras: what they bring has a line of its own."""


def normalize(requirements):
    plain = {one.replace(" ", "") for one in requirements}
    return {part for one in plain for part in NO_EXTRAS.get(one, {one})}


def test_the_recipe_needs_what_the_wheel_needs():
    needs = RECIPE["requirements"]
    project = PROJECT["project"]
    python = f"python{project['requires-python']}"
    assert normalize(needs["run"]) == normalize([python, *project["dependencies"]])
    tools = {one for one in normalize(needs["host"]) if one not in ("python", "pip")}
    assert tools == normalize(PROJECT["build-system"]["requires"])


def test_the_recipe_is_of_this_version():
    assert RECIPE["context"]["version"] == ts.__version__


def test_the_recipe_needs_the_cmake_that_the_sources_need():
    (least,) = re.findall(
        r"cmake_minimum_required\(VERSION (\d+[.]\d+)", (ROOT / "CMakeLists.txt").read_text()
    )
    assert f"cmake>={least}" in normalize(RECIPE["requirements"]["build"])


def test_every_python_of_the_recipe_is_supported():
    least = tuple(map(int, re.findall(r"\d+", PROJECT["project"]["requires-python"])))
    versions = [tuple(map(int, one.split("."))) for one in VARIANTS["python"]]
    assert versions == sorted(set(versions))
    assert versions[0] == least
