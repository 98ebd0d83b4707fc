"""Columns of cells: numbers as Python reads them one by one, and tables as pandas reads them."""

import io

import numpy as np
import pandas as pd
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from tinsmith.io.delimited.cell_bounds import find_cell_bounds
from tinsmith.io.delimited.cells import BLANKS, is_number
from tinsmith.io.delimited.parsing import parse_column

digits = st.text("0123456789", max_size=22)
numbers = st.builds(
    "{}{}{}{}{}".format,
    st.sampled_from(["", "-", "+"]),
    digits,
    st.sampled_from(["", "."]),
    digits,
    st.sampled_from(["", "", "", "e3", "E-7", "e+300", "e999"]),
).filter(lambda text: is_number(text, "."))
floats = st.floats(allow_nan=False, allow_infinity=False).map(repr)
words = st.sampled_from(
    ["", "  ", "-", "nan", "inf", "-Infinity", "True", "false", "IP 1", "1 2", "1_0", "0x1", "1e",
     "é", "12ft", "9223372036854775807", "-9223372036854775807", "007", "+5", "-0", "1.", ".5"]
)  # fmt: skip


def columns_of(rows, delimiter=",", decimal=".", texts=()):
    data = "\n".join(delimiter.join(row) for row in rows).encode()
    bounds = find_cell_bounds(data, delimiter, len(rows[0]))
    return [
        parse_column(bounds, k, decimal=decimal, is_text=k in texts) for k in range(len(rows[0]))
    ]


@given(st.lists(st.one_of(numbers, floats), min_size=1, max_size=8))
def test_numbers_are_the_nearest_to_their_texts(texts):
    column, _ = columns_of([(text, "0") for text in texts])
    whole = all(text.lstrip("+-").isdecimal() for text in texts)
    if whole and all(-(2**63) < int(text) < 2**63 for text in texts):
        assert column.dtype == np.int64
        assert column.tolist() == [int(text) for text in texts]
    elif column.dtype == object:  # a whole number that no float holds
        assert column.tolist() == texts
        assert any(text.lstrip("+-").isdecimal() and abs(int(text)) >= 2**63 for text in texts)
    else:
        expected = np.array([float(text) for text in texts])
        assert column.view(np.int64).tolist() == expected.view(np.int64).tolist()


def is_small(text):
    """Whether pandas has an integer for it, too: it takes larger ones for floats, or uint64."""
    return not text.strip("+-").isdecimal() or abs(int(text)) < 2**63


@given(
    st.lists(
        st.tuples(st.one_of(numbers.filter(is_small), floats, words), words), min_size=1, max_size=8
    ),
    st.booleans(),
)
def test_tables_are_those_of_pandas(rows, is_quoted):
    assume(not is_quoted or all(number == number.strip() for number, _ in rows))  # it keeps blanks
    written = [tuple(f'"{one}"' for one in row) if is_quoted else row for row in rows]
    frame = pd.read_csv(
        io.StringIO("\n".join(",".join(row) for row in written)), header=None, names=[0, 1],
        dtype={1: object}, skipinitialspace=True, skip_blank_lines=False, keep_default_na=False,
        na_values={0: [""]},
    )  # fmt: skip
    numbers_or_texts, texts = columns_of(written, texts=(1,))
    assert texts.tolist() == frame[1].tolist()
    expected = frame[0].to_numpy()
    if expected.dtype.kind in "bif":
        assert numbers_or_texts.dtype == expected.dtype
        np.testing.assert_array_equal(numbers_or_texts, expected)  # it drops some signs of zeros
    else:
        texts = numbers_or_texts.tolist()
        if any(isinstance(one, bool) for one in expected):  # truths and empty cells are texts here
            texts = [text.title() for text in texts]
        assert texts == frame[0].fillna("").astype(str).tolist()


def test_quoted_numbers_keep_their_signs_and_quoted_blanks_are_empty():
    column, _ = columns_of([('"0.5"', ""), ('"-0"', ""), ('"  "', "")])
    assert column[:2].tobytes() == np.array([0.5, -0.0]).tobytes()
    assert np.isnan(column[2])


@pytest.mark.parametrize("count", [1, 32_767, 32_768, 32_769])
def test_a_column_is_one_kind_over_all_blocks(count):
    rows = [(str(k), f"{k}.5", str(k)) for k in range(count)] + [("7", "", "x")]
    whole, broken, text = columns_of(rows)
    assert whole.tolist() == [*range(count), 7]
    assert np.array_equal(broken, [*(k + 0.5 for k in range(count)), np.nan], equal_nan=True)
    assert text.tolist() == [*map(str, range(count)), "x"]


@pytest.mark.parametrize(
    ("text", "delimiter", "decimal"),
    [
        ("1,5;-2,25;  3\n+4; 5e1;6,", ";", ","),
        (" 1.5  -2.25\t3\n+4\t\t5e1 6. ", BLANKS, "."),
        ('"1.5","-2.25", 3\n+4,"5e1",6.', ",", "."),
    ],
)
def test_delimiters_marks_and_blanks(text, delimiter, decimal):
    bounds = find_cell_bounds(text.encode(), delimiter, 3)
    found = [parse_column(bounds, k, decimal=decimal).tolist() for k in range(3)]
    assert found == [[1.5, 4.0], [-2.25, 50.0], [3.0, 6.0]]
