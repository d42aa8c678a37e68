"""What checks a built manual finds: dead links and what is loaded from the network.  The build itself: .ci/run."""

import pytest

from docs._ext.docstring import docstring, pieces
from docs._ext.folders import with_page
from tests.manual.build import Page, dead_links, from_elsewhere
from tests.reference.folders import DOCS, ROOT

SOUND = """<html><head><link rel="stylesheet" href="x.css"><link rel="canonical" href="https://a.b/c"></head><body>
<h1 id="top">x</h1><a href="#top">a</a><a href="other.html#there">b</a><a href="https://a.b">c</a><img src="p.png">
</body></html>"""


@pytest.fixture
def site(tmp_path):
    (tmp_path / "index.html").write_text(SOUND, encoding="utf-8")
    (tmp_path / "other.html").write_text('<p id="there">x</p>', encoding="utf-8")
    (tmp_path / "x.css").write_text("p { color: red; background: url(p.png) }", encoding="utf-8")
    (tmp_path / "p.png").write_bytes(b"")
    return tmp_path


def test_a_sound_site_has_no_fault(site):
    assert list(dead_links(site)) == []
    assert list(from_elsewhere(site)) == []


@pytest.mark.parametrize(
    ("right", "wrong"), [("#there", "#nowhere"), ("#top", "#bottom"), ("other.html", "none.html"), ("p.png", "q.png")]
)
def test_a_dead_link_is_found(site, right, wrong):  # the checks that must fail
    page = site / "index.html"
    page.write_text(SOUND.replace(f'"{right}', f'"{wrong}').replace(right + '"', wrong + '"'), encoding="utf-8")
    assert list(dead_links(site)) != []


@pytest.mark.parametrize(
    "added",
    ['<script src="https://cdn.x/y.js"></script>', '<img src="//x/y.png">', '<link rel="stylesheet" href="http://x/y">',
     '<p style="background: url(https://x/y.png)">', '<iframe src="https://x"></iframe>'],
)  # fmt: skip
def test_what_comes_from_the_network_is_found(site, added):
    (site / "index.html").write_text(SOUND + added, encoding="utf-8")
    assert len(list(from_elsewhere(site))) == 1


def test_a_style_that_loads_a_font_is_found(site):
    (site / "x.css").write_text("@import url('https://fonts.x/y');", encoding="utf-8")
    assert len(list(from_elsewhere(site))) == 1


def test_a_page_knows_its_anchors():
    assert {"top"} == Page(SOUND).anchors


def test_links_to_folders_lead_to_their_pages():
    made = with_page("[a](../cases/rock) [b](theory/) [c](../cases/rock/rock.py) [d](x#y)", DOCS)
    assert made == "[a](../cases/rock/README.md) [b](theory/index.md) [c](../cases/rock/rock.py) [d](x#y)"


def test_a_docstring_is_found_with_its_formulas():
    text, path, line = docstring("porescale.dem.contact.hertz.Hertz.of")
    assert path == ROOT / "porescale/dem/contact/hertz.py"
    assert "Young's modulus" in text
    assert line > 100
    kinds = [type(it).__name__ for it in pieces(docstring("porescale.dem.contact.hertz")[0])]
    assert "literal_block" in kinds
    assert "paragraph" in kinds
    for wrong in ("porescale.dem.contact.hertz.Hearts", "porescale.none_such.at_all", "no_package.x"):
        with pytest.raises(LookupError):
            docstring(wrong)


def test_what_scrolls_is_reached_by_keyboard(page, axe, tmp_path):
    script = (DOCS / "_static" / "manual.js").read_text(encoding="utf-8")
    wide = "<pre style='overflow-x: auto; width: 20em'>" + "x" * 200 + "</pre><pre>x</pre>"
    text = f"<p role=heading>Guides</p><main><h1>x</h1>{wide}</main>"
    whole = f"<!doctype html><html lang=en><meta charset=utf-8><title>x</title><body>{text}"
    for name, added in (("without", ""), ("with", f"<script>{script}</script>")):
        (tmp_path / f"{name}.html").write_text(whole + added, encoding="utf-8")
    page.goto((tmp_path / "without.html").as_uri())
    assert [it.split(" ")[0] for it in axe(page)] == ["aria-required-attr", "scrollable-region-focusable"]  # must fail
    page.goto((tmp_path / "with.html").as_uri())
    assert axe(page) == []
    assert page.locator("pre[tabindex]").count() == 1
