"""Parts of a triangulation that is never in memory as a whole, each of them exact."""
