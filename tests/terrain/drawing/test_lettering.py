"""Texts that are made to fit, whatever the room is."""

import pytest

from tinsmith.terrain.drawing import fit_text


@pytest.mark.parametrize("width", [-1.0, 0.0, 0.5])
@pytest.mark.parametrize("lines", [1, 3])
def test_a_room_narrower_than_a_letter_cuts_the_text(width, lines):
    found = fit_text(
        "A site plan", width, [2.0, 1.0], lambda text, size: size * len(text), lines=lines
    )
    assert found.is_cut
    assert found.size == 1.0
