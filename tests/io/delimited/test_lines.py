"""Lines of a text as offsets: what they start with, and which hold decimals."""

import re

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from tinsmith.io.delimited.lines import TextLines

PIECES = [b"#", b"//", b"/", b" ", b"\t", b"\n", b"1", b"2", b",", b"."]
texts = st.lists(st.sampled_from(PIECES), max_size=14).map(b"".join)


@given(text=texts, prefix=st.sampled_from(["#", "//", "# ", "1"]))
def test_lines_that_start_with_a_prefix(text, prefix):
    lines = TextLines.of(text)
    plain = [lines.decode_line(i).lstrip(" \t") for i in range(len(lines))]
    assert lines.starts_with(prefix).tolist() == [line.startswith(prefix) for line in plain]


@given(text=texts, chosen=st.sets(st.integers(0, 5)))
def test_lines_with_a_mark_between_digits(text, chosen):
    lines = TextLines.of(text)
    numbers = np.array(sorted(i for i in chosen if i < len(lines)), np.int64)
    plain = [i for i in numbers.tolist() if re.search(r"\d[,.]\d", lines.decode_line(i))]
    assert lines.find_with_decimals(numbers).tolist() == plain
