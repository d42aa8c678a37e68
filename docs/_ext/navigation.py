"""The tree of all pages that each page has at its side, made of the titles alone.

Sphinx makes it anew for each page, from the headings of all pages, and then removes all headings but the titles: three
tenths of the time that the manual takes.  Here they are removed once.
"""

from typing import Any

from docutils.nodes import Element
from sphinx.addnodes import toctree
from sphinx.application import Sphinx


def title_alone(headings: Element) -> Element:
    """A copy of a page's headings with its title and the trees of pages below it, as Sphinx's ``titles_only``."""
    copy = headings.deepcopy()
    for top in copy.children:
        if len(top) > 1:
            trees = list(top.findall(toctree))
            if trees:
                top[1][:] = trees
            else:
                top.pop(1)
    return copy


def use(app: Sphinx) -> None:
    """Let the builder make trees of titles from titles."""
    builder: Any = app.builder
    whole = getattr(builder, "_get_local_toctree", None)
    if whole is None:  # of no HTML
        return
    titles = dict[str, Element]()

    def tree(docname: str, **options: Any) -> str:
        """The tree, as HTML."""
        env = builder.env
        if not options.get("titles_only"):
            return str(whole(docname, **options))
        if not titles:
            titles.update((name, title_alone(headings)) for name, headings in env.tocs.items())
        headings, env.tocs = env.tocs, titles
        try:
            return str(whole(docname, **options))
        finally:
            env.tocs = headings

    builder._get_local_toctree = tree


def setup(app: Sphinx) -> dict[str, Any]:
    """Listen to the builder being ready; pages are written once all are read."""
    app.connect("builder-inited", use)
    return {"version": "1", "parallel_read_safe": True, "parallel_write_safe": True}
