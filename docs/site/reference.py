"""Directives that write the reference anew for each build: public names, and commands.

``public-names`` lists what Python offers, by the docstrings; ``commands`` what the command line
offers, by click. Neither needs a change where a name, a command or an option is added.
"""

from __future__ import annotations

import inspect
import re
from typing import TYPE_CHECKING, Any

import click
from docutils import nodes
from docutils.parsers.rst import Directive
from docutils.statemachine import StringList
from sphinx import addnodes
from sphinx.transforms import SphinxTransform

import tinsmith
from tinsmith.cli import main

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator

    from sphinx.application import Sphinx
    from sphinx.environment import BuildEnvironment

PAGES = {
    "surfaces": ("tin", ""),
    "quality": ("tin.checking", "tin.meshing", "tin.voronoi", "tin.paper"),
    "products": ("terrain",),
    "results": ("terrain.results", "terrain.charts", "terrain.viewer", "terrain.plans"),
    "files": ("io",),
    "errors": ("errors", "crs"),
}
"""Each page with the packages whose names it lists; the longest name that fits wins."""

_WITHOUT_LINKS = (addnodes.pending_xref, nodes.reference, nodes.title, nodes.term)

SHARED_BY = 4
"""An option of so many commands is described once, below all of them."""


def names_of_page(page: str) -> list[str]:
    """Return the public names of a page: what is called, of the smallest package first."""
    return [name for name in _public_names() if _page_of(name) == page]


def _public_names() -> list[str]:
    names = [name for name in tinsmith.__all__ if callable(getattr(tinsmith, name))]
    return sorted(names, key=lambda name: (not inspect.isclass(getattr(tinsmith, name)), name))


def _page_of(name: str) -> str:
    module = getattr(tinsmith, name).__module__.removeprefix("tinsmith").strip(".")
    fits = {
        prefix: page
        for page, prefixes in PAGES.items()
        for prefix in prefixes
        if f"{module}.".startswith(f"{prefix}." if prefix else "")
    }
    return fits[max(fits, key=len)]


class PublicNames(Directive):
    """``public-names:: PAGE`` lists the names of a page with their docstrings."""

    required_arguments = 1

    def run(self) -> list[nodes.Node]:
        """Return what autodoc makes of the names."""
        lines = [line for name in names_of_page(self.arguments[0]) for line in _describe_name(name)]
        found = nodes.Element()
        self.state.nested_parse(StringList(lines, source="docstrings"), 0, found)
        return found.children


def _describe_name(name: str) -> list[str]:
    thing = getattr(tinsmith, name)
    if not inspect.isclass(thing):
        return [f".. autofunction:: tinsmith.{name}", ""]
    if issubclass(thing, BaseException):
        return [f".. autoexception:: tinsmith.{name}", ""]
    return [f".. autoclass:: tinsmith.{name}", "   :members:", ""]


# ----------------------------------------------------------------------------------- commands


class Commands(Directive):
    """``commands::`` describes every command and, below them, the options that many share."""

    def run(self) -> list[nodes.Node]:
        """Return the sections."""
        return [*describe_commands()]


def describe_commands() -> list[nodes.section]:
    """Return a section for each command, and one of shared options."""
    commands = dict(list_commands())
    shared = _find_shared(commands.values())
    made = [_describe_command(name, command, shared) for name, command in commands.items()]
    return [*made, _describe_shared(shared)]


def list_commands() -> Iterator[tuple[str, click.Command]]:
    """Yield the commands of the package, without those of plug-ins."""
    context = click.Context(main, info_name="tinsmith")
    for name in main.list_commands(context):
        command = main.get_command(context, name)
        if command is not None and command.callback.__module__.startswith("tinsmith."):
            yield name, command


def _options_of(command: click.Command) -> list[click.Option]:
    return [one for one in command.params if isinstance(one, click.Option) and not one.hidden]


def _find_shared(commands: Iterable[click.Command]) -> dict[str, click.Option]:
    """Return the options that many commands have, told alike, by what identifies them."""
    found: dict[str, list[click.Option]] = {}
    for command in commands:
        for option in _options_of(command):
            found.setdefault(_identify(option), []).append(option)
    return {key: some[0] for key, some in found.items() if len(some) >= SHARED_BY}


def _identify(option: click.Option) -> str:
    return f"{_flags(option)} {option.help}"


def _flags(option: click.Option) -> str:
    return ", ".join([*option.opts, *option.secondary_opts])


def _anchor(option: click.Option) -> str:
    return f"option-{max(option.opts, key=len).lstrip('-')}"


def _describe_command(
    name: str, command: click.Command, shared: dict[str, click.Option]
) -> nodes.section:
    section = _make_section(f"tinsmith {name}")
    context = click.Context(command, info_name=f"tinsmith {name}")
    usage = f"tinsmith {name} {' '.join(command.collect_usage_pieces(context))}"
    section += nodes.literal_block(usage, usage, language="text")
    section += _describe_help(command)
    own = [one for one in _options_of(command) if _identify(one) not in shared]
    if own:
        section += _list_options(own, f"{name}-", context)
    common = [one for one in _options_of(command) if _identify(one) in shared]
    if common:
        section += _link_options(common, "Also" if own else "Options:")
    return section


def _make_section(title: str) -> nodes.section:
    section = nodes.section(ids=[nodes.make_id(title)], names=[nodes.fully_normalize_name(title)])
    section += nodes.title(title, title)
    return section


def _describe_help(command: click.Command) -> list[nodes.Node]:
    """Return the paragraphs of a help text; what follows its control character is an example."""
    found: list[nodes.Node] = []
    for part in inspect.cleandoc(command.help or "").split("\n\n"):
        if part.startswith("\b"):
            lines = part.splitlines()[1:]
            title, rest = lines[0], lines[1:] if lines[0].endswith(":") else lines
            if rest is not lines:
                found.append(nodes.paragraph(title, title))
            code = "\n".join(line.strip() for line in rest)
            found.append(nodes.literal_block(code, code, language="sh"))
        else:
            found.append(nodes.paragraph(part, part.replace("\n", " ")))
    return found


def _list_options(
    options: Iterable[click.Option], prefix: str, context: click.Context
) -> nodes.definition_list:
    found = nodes.definition_list(classes=["options"])
    for option in options:
        written, text = option.get_help_record(context) or (_flags(option), "")
        term = nodes.term("", "", nodes.literal(written, written), ids=[prefix + _anchor(option)])
        meaning = nodes.definition("", nodes.paragraph(text, text))
        found += nodes.definition_list_item("", term, meaning)
    return found


def _link_options(options: Iterable[click.Option], before: str) -> nodes.paragraph:
    found = nodes.paragraph("", f"{before} ", classes=["options"])
    for k, option in enumerate(options):
        flag = max(option.opts, key=len)
        link = nodes.reference("", "", nodes.literal(flag, flag), refid=_anchor(option))
        found += [*([nodes.Text(", ")] if k else []), link]
    found += nodes.Text(".")
    return found


def _describe_shared(shared: dict[str, click.Option]) -> nodes.section:
    section = _make_section("Options that many commands have")
    section += _list_options(shared.values(), "", click.Context(main))
    return section


# -------------------------------------------------------------------------- names within texts


class LinkNames(SphinxTransform):
    """Link what pages set as code, ``ts.contours`` or ``tinsmith volume``, to its reference."""

    default_priority = 400

    def apply(self, **_: Any) -> None:
        """Wrap such literals, but those of links, headings and lists of options."""
        for literal in list(self.document.findall(nodes.literal)):
            target = _find_target(literal.astext())
            if target and not any(isinstance(one, _WITHOUT_LINKS) for one in _list_above(literal)):
                link = addnodes.pending_xref("", **target, refdoc=self.env.docname, refwarn=False)
                literal.replace_self(link)
                link += literal


def _list_above(node: nodes.Node) -> Iterator[nodes.Node]:
    while (node := node.parent) is not None:
        yield node


class LinkTypes(SphinxTransform):
    """Link the types that docstrings name to public names alone, not to what is called alike."""

    default_priority = 401

    def apply(self, **_: Any) -> None:
        """Name the target in full, or leave the word."""
        for link in list(self.document.findall(addnodes.pending_xref)):
            if link.get("refspecific") and link["refdomain"] == "py":
                if link["reftarget"] in tinsmith.__all__:
                    link["reftarget"] = f"tinsmith.{link['reftarget']}"
                else:
                    link.replace_self(link.children)


def _find_target(text: str) -> dict[str, str] | None:
    """Return what a literal speaks of as a cross-reference says it."""
    python = re.match(r"(?:ts|tinsmith)\.([A-Za-z_]+)", text)
    if python and python[1] in tinsmith.__all__:
        return {"refdomain": "py", "reftype": "obj", "reftarget": f"tinsmith.{python[1]}"}
    method = re.match(r"(?:tin|TIN)\.([a-z_]+)", text)
    if method and hasattr(tinsmith.TIN, method[1]):
        return {"refdomain": "py", "reftype": "obj", "reftarget": f"tinsmith.TIN.{method[1]}"}
    command = re.match(r"tinsmith ([a-z]+)", text)
    if command and command[1] in main.list_commands(click.Context(main)):
        return {"refdomain": "", "reftype": "command", "reftarget": command[1]}
    return None


def link_command(
    app: Sphinx,
    env: BuildEnvironment,  # noqa: ARG001 - Sphinx's signature
    node: addnodes.pending_xref,
    content: nodes.Node,
) -> nodes.reference | None:
    """Return a link to the section of a command."""
    if node["reftype"] != "command":
        return None
    place = app.builder.get_relative_uri(node["refdoc"], "docs/commands")
    uri = f"{place}#tinsmith-{node['reftarget']}"
    return nodes.reference("", "", content, refuri=uri, internal=True)


def flatten_references(
    _app: Sphinx, _kind: str, _name: str, _thing: object, _options: object, lines: list[str]
) -> None:
    """Make words of numbered references: a page holds many docstrings that each begin at 1."""
    text = re.sub(r"\[(\d+)\]_", r"\\[\1]", "\n".join(lines))
    entry = re.compile(r"^\.\. (\[\d+\].*(?:\n   .*)*)", re.MULTILINE)
    lines[:] = entry.sub(lambda found: "\n\\" + found[1].replace("\n   ", "\n"), text).split("\n")


def setup(app: Sphinx) -> dict[str, bool]:
    """Tell Sphinx of the directives."""
    app.add_directive("public-names", PublicNames)
    app.add_directive("commands", Commands)
    app.add_transform(LinkNames)
    app.add_transform(LinkTypes)
    app.connect("missing-reference", link_command)
    app.connect("autodoc-process-docstring", flatten_references, priority=100)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
