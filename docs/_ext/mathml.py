"""Equations as MathML, written when the manual is built: no script and no font is loaded to show them.

docutils turns LaTeX into MathML.  What it does not know stops the build: a warning names the page, the equation and the
word.  Every browser of today shows MathML by itself.
"""

from typing import Any

from docutils import nodes
from docutils.utils.math import MathError, latex2mathml, pick_math_environment
from sphinx.application import Sphinx
from sphinx.util import logging

LOG = logging.getLogger(__name__)


def mathml(text: str, node: nodes.Node, block: bool) -> str:
    """MathML of LaTeX; an empty string, and a warning at the node, where docutils does not know a word of it."""
    code = text.strip()
    if block and "\\begin{" not in code[:8]:
        environment = pick_math_environment(code)
        if environment == "align*":
            code = f"\\begin{{align*}}\n{code}\n\\end{{align*}}"
    try:
        return str(latex2mathml.tex2mathml(code, as_block=block))
    except (MathError, AttributeError, IndexError, ValueError) as fault:
        LOG.warning("equation not understood: %s: %s", fault, code, location=node, type="math")
        return ""


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
