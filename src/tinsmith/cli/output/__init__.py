"""What a command says: results, summaries, progress, failures."""
