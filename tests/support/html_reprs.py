"""Cards of a notebook, read back: their words, their elements, their picture."""

from __future__ import annotations

import base64
import io
import re
from html.parser import HTMLParser

import numpy as np
from PIL import Image


class Reader(HTMLParser):
    """The words and the elements of a page; an element that is not closed fails."""

    def __init__(self):
        super().__init__()
        self.words, self.tags, self.open = [], [], []

    def handle_starttag(self, tag, attrs):
        self.tags.append((tag, dict(attrs)))
        if tag not in {"img", "br"}:
            self.open.append(tag)

    def handle_endtag(self, tag):
        assert self.open.pop() == tag

    def handle_data(self, data):
        self.words.append(data)


def read(card):
    reader = Reader()
    reader.feed(card)
    assert reader.open == []
    return reader


def picture_of(card):
    data = re.search(r'src="data:image/png;base64,([^"]+)"', card)[1]
    return np.asarray(Image.open(io.BytesIO(base64.b64decode(data))))
