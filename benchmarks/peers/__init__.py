"""The tools beside which tinsmith is timed, and whether their answers are right."""
