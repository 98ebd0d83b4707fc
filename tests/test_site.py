"""The site of the documentation: every page in its navigation, no link without an end."""

import itertools
import json
import re
import sys
from html.parser import HTMLParser
from pathlib import Path
from urllib.parse import unquote, urlsplit

import click
import pytest
from support.blocks import ROOT, list_pages, name_page, read_blocks, remove_code
from support.pages import open_served
from support.processes import run
from support.validators import find_violations

import tinsmith as ts
from tinsmith.cli import main

INDEX = ROOT / "docs" / "index.md"
NOT_IN_SITE = {"README.md"}  # a first screen of its own, which the index begins with, too
LINK = re.compile(r"!?\[(?:[^\[\]]|\[[^\]]*\])*\]\(([^()\s]+)\)")

# -------------------------------------------------------------------------------- navigation


def list_navigation():
    """Return the files that the tables of contents name, from the root."""
    named = []
    for page in (INDEX, ROOT / "docs" / "api.md"):
        for block in read_blocks(page, "{toctree}"):
            lines = [line for line in block.text.splitlines() if line and line[0] != ":"]
            named += [(page.parent / line).resolve() for line in lines]
    return [path.relative_to(ROOT).as_posix() for path in named]


def test_every_page_is_in_the_navigation_once():
    notebooks = (ROOT / "docs" / "notebooks").glob("*.ipynb")
    pages = {name_page(page) for page in [*list_pages(), *notebooks]} - NOT_IN_SITE
    expected = {str(Path(page).with_suffix("")) for page in pages} - {"docs/index"}
    named = list_navigation()
    missing, gone = sorted(expected - set(named)), sorted(set(named) - expected)
    assert not missing, f"add to a toctree of docs/index.md, without the suffix: {missing}"
    assert not gone, f"a toctree names what is no page: {gone}"
    assert len(named) == len(set(named)), "a page stands in the navigation twice"


def test_the_overview_names_every_page_that_a_reader_may_want():
    """Each subject has its link in the overview, not in the side bar alone."""
    body = INDEX.read_text().split("## In a minute")[1]
    linked = {(INDEX.parent / target).resolve() for target in LINK.findall(remove_code(body))}
    subjects = {page for page in (ROOT / "docs").glob("*.md") if page != INDEX}
    missing = sorted(page.name for page in subjects - linked)
    assert not missing, f"name in the overview of docs/index.md: {missing}"


# ------------------------------------------------------------------------------------- links


def make_anchor(heading):
    """Return the anchor of a heading, as repositories and the site make it."""
    words = re.sub(r"!?\[([^\]]*)\]\([^)]*\)|[*`]", r"\1", heading).strip().lower()
    return re.sub(r"[^\w\- ]", "", words).replace(" ", "-")


def list_anchors(page):
    return {make_anchor(line) for line in re.findall(r"^#+ (.*)$", page.read_text(), re.MULTILINE)}


def judge_link(page, target):
    """Return what is wrong with a link, None if nothing is."""
    parts = urlsplit(target)
    if parts.scheme:
        fine = parts.scheme == "https" and "." in parts.netloc and not re.search(r"\s", target)
        return None if fine else "is no address of HTTPS"
    place = (page.parent / unquote(parts.path)).resolve() if parts.path else page
    if not place.is_relative_to(ROOT):
        return "leads out of the repository"
    if not place.exists():
        return "leads nowhere"
    if place.is_dir():
        return "leads to a folder, which the site does not show"
    if parts.fragment and parts.fragment not in list_anchors(place):
        return f"has no such heading: {sorted(list_anchors(place))}"
    return None


@pytest.mark.parametrize("page", list_pages(), ids=name_page)
def test_links_lead_somewhere(page):
    found = {
        target: judge_link(page, target) for target in LINK.findall(remove_code(page.read_text()))
    }
    assert {target: why for target, why in found.items() if why} == {}


def test_pictures_are_those_that_pages_show():
    shown = set()
    for page in list_pages():
        text = remove_code(page.read_text())
        shown |= {(page.parent / target).resolve() for target in LINK.findall(text)}
    unused = {path for path in (ROOT / "docs").rglob("*.png") if path.resolve() not in shown}
    assert {path.name for path in unused} == set()


# ----------------------------------------------------------------------------------- reference


@pytest.fixture
def reference(monkeypatch):
    """Return the module that writes the reference for Sphinx."""
    pytest.importorskip("sphinx")
    monkeypatch.syspath_prepend(str(ROOT / "docs" / "site"))
    import reference

    return reference


def test_every_public_name_is_on_one_page_of_the_reference(reference):
    pages = {page.stem for page in (ROOT / "docs" / "api").glob("*.md")}
    assert pages == set(reference.PAGES)
    for page in pages:
        assert f".. public-names:: {page}" in (ROOT / "docs" / "api" / f"{page}.md").read_text()
    listed = [name for page in pages for name in reference.names_of_page(page)]
    assert sorted(listed) == sorted(name for name in ts.__all__ if callable(getattr(ts, name)))


def test_the_reference_of_commands_has_every_option(reference):
    commands = dict(reference.list_commands())
    assert list(commands) == main.list_commands(click.Context(main))[: len(commands)]
    sections = reference.describe_commands()
    text = {section["names"][0]: section.astext() for section in sections}
    for name, command in commands.items():
        for option in command.params:
            if isinstance(option, click.Option) and not option.hidden:
                assert max(option.opts, key=len) in text[f"tinsmith {name}"]


# ----------------------------------------------------------------------------------- notebooks

NOTEBOOKS = sorted((ROOT / "docs" / "notebooks").glob("*.ipynb"))


def list_outputs(notebook):
    """Return what each cell says, and of what kinds its pictures are."""
    found = []
    for cell in notebook.cells:
        for output in cell.get("outputs", ()):
            data = output.get("data", {"text/plain": output.get("text")})
            found.append((sorted(data), data.get("text/plain")))
    return found


@pytest.mark.every_case("slow")
@pytest.mark.slow
@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda path: path.stem)
def test_notebooks_run_and_say_what_they_show(path, monkeypatch):
    nbformat = pytest.importorskip("nbformat")
    monkeypatch.syspath_prepend(str(ROOT / "docs"))
    from make_notebooks import run_notebook

    kept = nbformat.read(path, as_version=4)
    assert list_outputs(run_notebook(path)) == list_outputs(kept), "run docs/make_notebooks.py"


@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda path: path.stem)
def test_notebooks_are_small_and_have_run(path):
    assert path.stat().st_size < 1_000_000
    cells = [cell for cell in json.loads(path.read_text())["cells"] if cell["cell_type"] == "code"]
    assert [cell["execution_count"] for cell in cells] == list(range(1, len(cells) + 1))
    said = [output for cell in cells for output in cell["outputs"]]
    assert not [one for one in said if one["output_type"] == "error"]
    assert sum("image/png" in one.get("data", {}) for one in said) >= 2


# ------------------------------------------------------------------------------------ the site


KINDS_OF_PAGES = (
    *("docs/index.html", "docs/many-files.html", "docs/rasters.html", "docs/at-home.html"),
    *("docs/api/errors.html", "docs/notebooks/raster.html", "search.html"),
)
NESTED_LINK = re.compile(r"<a [^>]*>(?:(?!</a>).)*<a ", re.DOTALL)


class Assets(HTMLParser):
    """What a page loads by itself: scripts, styles, pictures, frames."""

    def __init__(self):
        super().__init__()
        self.loaded, self.ids, self.links = [], set(), []

    def handle_starttag(self, tag, attrs):
        given = dict(attrs)
        self.ids.add(given.get("id"))
        if tag in {"script", "img", "iframe", "source", "video"}:
            self.loaded += [given[name] for name in ("src", "srcset") if given.get(name)]
        if tag == "link" and given.get("rel") not in {"canonical", "prev", "next", "index"}:
            self.loaded.append(given["href"])
        if tag == "a" and given.get("href"):
            self.links.append(given["href"])


@pytest.mark.slow
def test_the_site_is_built_without_a_warning_and_needs_no_network(tmp_path):
    program = [sys.executable, "-m", "sphinx", "-q", "-W", "--keep-going", "-c", "docs"]
    done = run(*program, "-d", str(tmp_path / "trees"), ".", str(tmp_path / "site"), cwd=ROOT)
    assert done.returncode == 0, done.stdout + done.stderr
    pages = {path: Assets() for path in (tmp_path / "site").rglob("*.html")}
    assert len(pages) > 40
    for path, assets in pages.items():
        assets.feed(path.read_text(encoding="utf-8"))
        foreign = [one for one in assets.loaded if urlsplit(one).scheme not in {"", "data"}]
        assert foreign == [], path
    for path, assets in pages.items():
        for link in assets.links:
            parts = urlsplit(link)
            if parts.scheme or link.startswith("#"):
                continue
            place = (path.parent / unquote(parts.path)).resolve()
            assert place.exists(), f"{path}: {link}"
            if parts.fragment and place in pages:
                assert parts.fragment in pages[place].ids, f"{path}: {link}"
    assert "ts.contours" in (tmp_path / "site/docs/contours.html").read_text()
    assert "contours" in (tmp_path / "site/searchindex.js").read_text()
    check_access(tmp_path / "site")


def check_access(site):
    """No page of each kind breaks a rule of WCAG 2.1 AA, and no link stands in a link."""
    for path in site.rglob("*.html"):
        assert not NESTED_LINK.search(path.read_text(encoding="utf-8")), path
    for name, size in itertools.product(KINDS_OF_PAGES, ((1200, 800), (360, 640))):
        viewport = dict(zip(("width", "height"), size, strict=True))
        with open_served(site, name, ready="Promise.resolve(1)", viewport=viewport) as page:
            assert find_violations(page) == [], (name, size)
