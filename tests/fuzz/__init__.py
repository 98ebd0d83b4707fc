"""Random campaigns: cases without end, each with a number that makes it again.

Run them with `make fuzz`, or `PYTHONPATH=tests python -m fuzz --help`.
"""
