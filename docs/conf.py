"""Sphinx configuration of the site (``make docs``); pages also read well as plain Markdown."""

import sys
from importlib.metadata import version as installed
from pathlib import Path

sys.path.append(str(Path(__file__).parents[1]))  # for our own extension

project = "crowdbot"
author = "The crowdbot developers"
release = version = installed("crowdbot")
extensions = [
    "myst_parser",
    "sphinx.ext.autodoc",
    "sphinx.ext.napoleon",
    "scripts.accessible_pages",
]
root_doc = "index"
source_suffix = {".md": "markdown"}
exclude_patterns = ["**/.pytest_cache", "**/node_modules"]

# Every link within the documents must resolve. Types in signatures are not pages.
nitpicky = True
nitpick_ignore_regex = [(r"py:.*", r".*")]
suppress_warnings = ["myst.strikethrough"]
myst_heading_anchors = 6
myst_links_external_new_tab = False

autodoc_member_order = "bysource"
autodoc_typehints = "signature"
autodoc_class_signature = "separated"
python_use_unqualified_type_names = True
napoleon_google_docstring = True
napoleon_numpy_docstring = False
napoleon_use_rtype = False

html_theme = "furo"
html_title = "crowdbot"
html_show_sphinx = False
html_show_copyright = False
html_copy_source = False
# Search would fetch each page that it finds for an excerpt, which browsers refuse in a folder.
html_show_search_summary = False
# Pages for developers of crowdbot are not found by users who search.
unsearched = ("decisions/", "developers/")
# Nothing is loaded from elsewhere: the site, its search too, works from a folder.
html_theme_options = {"navigation_with_keys": True, "top_of_page_buttons": []}
highlight_language = "text"
