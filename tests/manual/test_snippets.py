"""The code that the manual's pages show runs as it stands there."""

import pytest

from tests.manual.snippets import DOCS, PAGES, run_page, snippets


def run_text(text, tmp_path):
    """What running a page of this text ends with."""
    page, folder = tmp_path / "page.md", tmp_path / "folder"
    page.write_text(text, encoding="utf-8")
    folder.mkdir()
    return run_page(page, folder)


WITH_CODE = [page for page in PAGES if any(it.runs for it in snippets(page.read_text(encoding="utf-8")))]


LONG = {"first_hour/film", "first_hour/python", "first_hour/sweep", "howto/error_bars", "howto/force_on_a_pipe",
        "howto/open_results", "howto/own_law", "howto/paper_figure", "howto/photograph", "howto/resume",
        "howto/unsaturated", "python"}  # fmt: skip
"""Pages that run for ten seconds or more."""


def name_of(page):
    return page.relative_to(DOCS).with_suffix("").as_posix()


def marked(page):
    return pytest.param(page, marks=pytest.mark.slow) if name_of(page) in LONG else page


def test_every_long_page_is_one():
    assert {name_of(page) for page in WITH_CODE} >= LONG


@pytest.mark.parametrize("page", [marked(page) for page in WITH_CODE], ids=name_of)
def test_a_page_runs(page, tmp_path):
    folder = tmp_path / "folder"
    folder.mkdir()
    done = run_page(page, folder)
    assert done.returncode == 0, f"{done.stdout[-4000:]}\n{done.stderr[-4000:]}"


PAGE = """# Page
```python
x = 2
```
<!-- not run: takes a week -->
```python
raise ValueError
```
<!-- file: words/some.txt -->
```text
two words
```
```console
$ grep -c words \\
    words/some.txt
1
$ porescale --version
```
```python
from pathlib import Path
assert x == 2 and Path("words/some.txt").exists()
```
```python
print(x, "of", 3)
for _ in range(3): print("again")
```
```text
2 of 3
again
...
```
```console
$ echo one  && echo "two three"
```
```text
one
two ...
```
<!-- exit code: 2 -->
```console
$ porescale check no_such_case
```
"""


def test_names_files_and_exit_codes_carry_on(tmp_path):
    done = run_text(PAGE, tmp_path)
    assert done.returncode == 0, done.stderr
    assert "no_such_case" in done.stdout


@pytest.mark.parametrize(
    ("right", "wrong", "line"),
    [("x == 2 and", "x == 3 and", "line 21"), ("code: 2", "code: 0", "line 41"), ("c words", "c verbs", "line 14"),
     ("<!-- not run: takes a week -->\n", "", "line 6"), ("2 of 3\nagain", "2 of 4\nagain", "line 28: is not what"),
     ("again\n...", "again", "line 28: is not what"), ("two ...", "three ...", "line 36: is not what")],
)  # fmt: skip
def test_a_page_that_is_wrong_fails(right, wrong, line, tmp_path):  # the checks that must fail
    assert right in PAGE
    done = run_text(PAGE.replace(right, wrong), tmp_path)
    assert done.returncode != 0
    assert line in done.stderr


def test_the_line_of_each_block_is_known():
    assert [(it.kind, it.line, it.runs) for it in snippets(PAGE)][:3] == [
        ("python", 3, True), ("python", 7, False), ("text", 11, True),
    ]  # fmt: skip
