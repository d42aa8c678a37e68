"""The manual: what Sphinx makes of the pages of this folder, of cases/*/README.md and of the pages at the root.

The source folder is the root of the repository, so that a link between pages is the same on a repository page and here.
Build it with ``python -m tests.manual``, which calls Sphinx with the root as source and this folder for the settings.
"""

import gc
import sys
from pathlib import Path

gc.set_threshold(50_000, 20, 50)  # trees of pages are circles that stay: looking for those to remove took a sixth

ROOT = Path(__file__).resolve().parents[1]
sys.path.insert(0, str(ROOT))

from porescale.common.core.version import VERSION  # noqa: E402 - found once the root is on the path

project = "porescale"
author = "The porescale project"
version = release = VERSION
root_doc = "docs/index"
include_patterns = ["docs/**", "cases/*/README.md", "CONTRIBUTING.md", "CHANGELOG.md"]
exclude_patterns = [
    ".*", "**/.*", "porescale", "continuum_sph", "tests", "runs", "build", "dist", "venv", "**/__pycache__",
    "docs/_ext", "docs/_static", "**/*.ipynb",
]  # fmt: skip
extensions = [
    "myst_parser",
    "sphinx_copybutton",
    "sphinx_design",
    "docs._ext.mathml",
    "docs._ext.docstring",
    "docs._ext.rows",
    "docs._ext.folders",
    "docs._ext.made",
    "docs._ext.navigation",
]

myst_enable_extensions = ["dollarmath", "amsmath", "colon_fence", "deflist", "attrs_inline"]
myst_heading_anchors = 4
suppress_warnings = ["myst.header"]  # pages on a repository begin at level 1 and skip to what they need
nitpicky = True
nitpick_ignore_regex = [("py:.*", ".*")]  # types in signatures are numpy's and Python's, which are not described here
html_show_copyright = False

html_theme = "furo"
html_title = f"porescale {VERSION}"
html_static_path = ["_static"]
html_css_files = ["manual.css"]
html_js_files = [("manual.js", {"defer": "defer"})]
html_copy_source = False
html_show_sourcelink = False
html_theme_options = {"navigation_with_keys": True}
copybutton_prompt_text = "$ "
copybutton_only_copy_prompt_lines = False
