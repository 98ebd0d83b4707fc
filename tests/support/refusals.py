"""Functions that must refuse what they are given, in a sentence."""

import pytest

import tinsmith as ts


def refuse(words, function, *arguments, error=ts.ReadError, **options):
    """Call what must raise an error of one sentence with such words in it; return the sentence."""
    with pytest.raises(error, match=words or None) as caught:
        function(*arguments, **options)
    text = str(caught.value)
    assert text.isprintable()
    assert text.endswith(".")
    return text
