"""The fixtures that look at pages find what is wrong with a wrong page."""

import pytest

GOOD = """<!doctype html><html lang="en"><meta charset="utf-8"><title>Good</title>
<main><h1>Good</h1><button>Press</button><p id="said"></p></main>
<script>document.querySelector("button").onclick =
() => document.getElementById("said").textContent = "pressed";</script>
"""
WRONG = """<!doctype html><html lang="en"><meta charset="utf-8"><title>Wrong</title>
<main><h1>Wrong</h1><button></button><img src="http://example.org/a.png"></main>
<script>console.error("said"); new WebSocket("ws://example.org/b"); throw new Error("thrown");</script>
"""


def test_a_good_page_has_no_fault(page, heard, axe, tmp_path):
    file = tmp_path / "good.html"
    file.write_text(GOOD)
    page.goto(file.as_uri())
    page.get_by_role("button").click()
    assert page.inner_text("#said") == "pressed"
    assert axe(page) == []
    assert heard.requests == [file.as_uri()]


def test_a_wrong_page_is_found(page, heard, axe, tmp_path):
    file = tmp_path / "wrong.html"
    file.write_text(WRONG)
    page.goto(file.as_uri())
    assert [it.split(" ")[0] for it in axe(page)] == ["button-name", "image-alt"]
    assert any("said" in it for it in heard.errors)
    assert any("thrown" in it for it in heard.errors)
    assert sorted(heard.refused) == ["http://example.org/a.png", "ws://example.org/b"]
    heard.errors.clear()
    heard.refused.clear()


def test_node_runs_scripts_in_one_scope_and_names_a_wrong_one(node, tmp_path):
    (tmp_path / "one.js").write_text("const two = 2;\n")
    (tmp_path / "other.js").write_text("function twice(x) { return two * x; }\n")
    (tmp_path / "wrong.js").write_text("function twice(x { }\n")
    assert node("[twice(4), two]", tmp_path / "one.js", tmp_path / "other.js") == [8, 2]
    with pytest.raises(AssertionError, match=r"wrong\.js:1"):
        node("1", tmp_path / "wrong.js")
