"""Equations as MathML, written when the manual is built: no script and no font is loaded to show them.

latex2mathml turns LaTeX into MathML.  What it does not know stops the build: a warning names the page, the equation and
the word.  Every browser of today shows MathML by itself; bold letters need the style sheet.
"""

from typing import Any

from docutils import nodes
from docutils.utils.math import pick_math_environment
from latex2mathml.converter import convert
from sphinx.application import Sphinx
from sphinx.util import logging

LOG = logging.getLogger(__name__)


def mathml(text: str, node: nodes.Node, block: bool) -> str:
    """MathML of LaTeX; an empty string, and a warning at the node, where a word of it is not known."""
    code = text.strip()
    if block and "\\begin{" not in code[:8] and pick_math_environment(code) == "align*":
        code = f"\\begin{{align*}}\n{code}\n\\end{{align*}}"
    try:
        found: str = convert(code, display="block" if block else "inline")
    except Exception as fault:  # of many kinds, none of which is documented
        LOG.warning("equation not understood: %s: %r", code, fault, location=node, type="math")
        return ""
    if "\\" in found:  # words that it does not know are left as they are
        LOG.warning("equation not understood: %s: unknown word", code, location=node, type="math")
        return ""
    return found


def visit_math(self: Any, node: nodes.math) -> None:
    """An equation in a line of text."""
    self.body.append(mathml(node.astext(), node, block=False))
    raise nodes.SkipNode


def visit_math_block(self: Any, node: nodes.math_block) -> None:
    """An equation on a line of its own, with its number and the anchor that references lead to."""
    self.body.append(self.starttag(node, "div", CLASS="math notranslate nohighlight"))
    if node.get("number"):
        number = nodes.Text(f"({node['number']})").astext()
        self.body.append(f'<span class="eqno">{number}')
        self.add_permalink_ref(node, "Link to this equation")
        self.body.append("</span>")
    self.body.append(mathml(node.astext(), node, block=True))
    self.body.append("</div>\n")
    raise nodes.SkipNode


def setup(app: Sphinx) -> dict[str, Any]:
    """Take the place of MathJax."""
    app.add_html_math_renderer("mathml", (visit_math, None), (visit_math_block, None))
    app.connect("config-inited", lambda app, config: setattr(config, "html_math_renderer", "mathml"))
    return {"version": "1", "parallel_read_safe": True, "parallel_write_safe": True}
