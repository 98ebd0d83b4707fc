"""Products of a surface: each runs at a small size and its answer holds; no timing is looked at."""

from __future__ import annotations

import pytest

from benchmarks.__main__ import SECTIONS
from benchmarks.measure import Outcome
from benchmarks.products import PRODUCTS, measure
from benchmarks.report.page import write_report
from benchmarks.sections import products


@pytest.mark.every_case("slow")
@pytest.mark.slow
@pytest.mark.parametrize("name", PRODUCTS)
def test_every_product_is_right(name):
    figures = measure(name, 3000)
    assert figures["seconds"] > 0
    assert figures["found"]


def test_a_wrong_product_is_an_error(monkeypatch):
    wrong = PRODUCTS["catchments"]._replace(run=lambda tin: PRODUCTS["pits"].run(tin))
    monkeypatch.setitem(PRODUCTS, "catchments", wrong)
    with pytest.raises(KeyError):
        measure("catchments", 3000)


def test_they_have_a_part_of_the_page(tmp_path, monkeypatch):
    assert products.SECTION in SECTIONS
    monkeypatch.setattr(products, "PRODUCTS", ("pits",))
    outcome = Outcome()
    outcome.add(products.run(1500, repeats=1))
    written = write_report(outcome, {"machine": "one"}, "a command", tmp_path / "page.md")
    page = written[0].read_text(encoding="utf-8")
    assert "## Products of a surface" in page
    assert "| pits | 1,500 |" in page
    assert " MB |" in page
