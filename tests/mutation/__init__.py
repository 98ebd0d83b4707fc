"""Mutation tests: small changes to the code, one at a time, that the tests must notice.

Run them with `make mutants`, or `PYTHONPATH=tests python -m mutation --help`.
"""
