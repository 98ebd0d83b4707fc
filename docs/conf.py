"""How `make docs` builds the site: Sphinx with MyST and the theme Furo, no file from elsewhere.

Pages are Markdown that reads well where it lies. The source folder is the root of the repository:
links between its pages, programs and samples are the same in the site as in the repository.
"""

import re
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parent / "site"))

import tinsmith

project = "tinsmith"
author = "tinsmith contributors"
version = release = tinsmith.__version__

extensions = [
    "myst_nb",
    "sphinx.ext.autodoc",
    "sphinx.ext.napoleon",
    "sphinx_copybutton",
    "reference",
]
include_patterns = [
    "docs/**",
    "ARCHITECTURE.md",
    "CHANGELOG.md",
    "sample_data/README.md",
    "tests/data/README.md",
    "tin/cpp/README.md",
]
root_doc = "docs/index"

# Anchors of headings are those that repositories show, too.
myst_heading_anchors = 4
myst_enable_extensions = ["deflist"]
nb_execution_mode = "off"  # the tests run the notebooks; their outputs are kept in them

autodoc_typehints = "none"  # docstrings give types
autodoc_member_order = "groupwise"
napoleon_google_docstring = False
napoleon_custom_sections = [("Attributes", "params_style")]
napoleon_use_rtype = False

html_theme = "furo"
html_title = "tinsmith"
html_static_path = ["site/static"]
html_css_files = ["tinsmith.css"]
html_copy_source = False
html_show_sphinx = False
templates_path = ["site/templates"]
html_additional_pages = {"index": "to_docs.html"}
html_theme_options = {
    "light_css_variables": {"color-brand-primary": "#8a4b14", "color-brand-content": "#8a4b14"},
    "dark_css_variables": {"color-brand-primary": "#e3a66b", "color-brand-content": "#e3a66b"},
}
copybutton_prompt_text = "$ "


def _serve_keys_and_readers(_app, _page, _template, context, _doctree):
    """Let keys scroll wide code and tables, and tell the level of headings of the side bar."""
    body = context.get("body", "").replace("<pre>", '<pre tabindex="0">')
    wide = re.compile(r'<div class="table-wrapper[^"]*"')
    context["body"] = wide.sub(lambda found: f'{found[0]} tabindex="0"', body)
    tree = context.get("furo_navigation_tree", "")
    context["furo_navigation_tree"] = tree.replace(
        'class="caption" role="heading"', 'class="caption" role="heading" aria-level="2"'
    )


def setup(app):
    """Change pages after the theme has made them."""
    app.connect("html-page-context", _serve_keys_and_readers, priority=900)
