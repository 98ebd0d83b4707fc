"""What is derived from a TIN, beside the peers that do the same: a module each.

Every module has ``run(n_points, *, repeats)``, which returns an Outcome of the section "answers".
"""
