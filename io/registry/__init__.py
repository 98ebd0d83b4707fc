"""Formats: what each is, which are known, and the content that shows them."""

from .format import KINDS, SURFACES, Format, Loss, load_function, require_options, takes_progress
from .lookup import (
    choose_clear,
    choose_format,
    find_format,
    find_format_of_suffix,
    find_suffixes,
    find_writer,
    find_writers,
    known_formats,
    list_claims,
    list_suffixes,
)

__all__ = [
    "KINDS",
    "SURFACES",
    "Format",
    "Loss",
    "choose_clear",
    "choose_format",
    "find_format",
    "find_format_of_suffix",
    "find_suffixes",
    "find_writer",
    "find_writers",
    "known_formats",
    "list_claims",
    "list_suffixes",
    "load_function",
    "require_options",
    "takes_progress",
]
