"""Formats: what each is, which are known, and the content that shows them."""

from .format import Format, load_function, require_options
from .lookup import (
    choose_format,
    find_format,
    find_format_of_suffix,
    find_suffixes,
    find_writer,
    known_formats,
    list_suffixes,
)

__all__ = [
    "Format",
    "choose_format",
    "find_format",
    "find_format_of_suffix",
    "find_suffixes",
    "find_writer",
    "known_formats",
    "list_suffixes",
    "load_function",
    "require_options",
]
