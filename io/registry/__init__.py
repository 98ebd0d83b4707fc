"""Formats: what each is, which are known, and the content that shows them."""
