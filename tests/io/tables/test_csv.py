"""Cells of a CSV that spreadsheets would compute are told; numbers stay numbers."""

import warnings

import pytest

import tinsmith as ts


@pytest.mark.parametrize(
    "text", ["=1+2", "+cmd|' /C calc'!A0", "@SUM(A1)", "-2+3", " =HYPERLINK(1)"]
)
def test_texts_that_are_formulas_are_told(tmp_path, text):
    table = ts.Table({"code": ["a", text], "z": [1.0, -2.0]})
    with pytest.warns(ts.LossWarning, match="spreadsheets compute as formulas"):
        ts.write(table, tmp_path / "t.csv")
    assert text.strip("'") in (tmp_path / "t.csv").read_text()


def test_numbers_are_none(tmp_path):
    table = ts.Table(
        {"code": ["-5.25", "+3", "-1e3", "A-1", "-"], "z": [-1.0, -2.0, 0.0, 4.0, 5.0]}
    )
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        ts.write(table, tmp_path / "t.csv")
    assert "-5.25,-1.0" in (tmp_path / "t.csv").read_text()
