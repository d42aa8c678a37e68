"""Campaigns keep what they came to: the page says what their file has."""

import json

from tests.reference.faults import campaigns


def test_the_page_has_the_table_of_the_campaigns_that_are_kept():
    rows = json.loads((campaigns.DOCS / "campaigns.json").read_text(encoding="utf-8"))
    page = (campaigns.DOCS / "testing.md").read_text(encoding="utf-8")
    assert campaigns.with_table(page, rows) == page
    assert campaigns.with_table(page, rows[1:]) != page  # the twin
    assert all(row["tries"] == sum(row["ends"].values()) for row in rows)


def test_a_campaign_that_goes_on_has_one_row(tmp_path):
    page = tmp_path / "testing.md"
    page.write_text(f"before\n{campaigns.BEGIN}\n{campaigns.END}\nafter\n")
    campaigns.record("kills", 1, {"row": 2}, 0, tmp_path)
    campaigns.record("kills", 1, {"row": 3, "film": 1}, 0, tmp_path)
    assert page.read_text().count("| kills |") == 1
    assert "| 4 | 1 film, 3 row | 0 |" in page.read_text()
    campaigns.record("kills", 2, {"row": 1}, 1, tmp_path)  # the twin: another seed
    assert page.read_text().count("| kills |") == 2
    campaigns.add({**json.loads((tmp_path / "campaigns.json").read_text())[0], "seed": "3 to 5"}, tmp_path)
    assert page.read_text().count("| kills |") == 3
    assert page.read_text().startswith("before\n")
    assert page.read_text().endswith("\nafter\n")
