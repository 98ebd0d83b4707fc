"""Look for tinsmith on the path, before where it is installed; follow children of a test."""

import os
import sys

sys.meta_path[:] = [f for f in sys.meta_path if "ScikitBuild" not in type(f).__name__]
if os.environ.get("MUTATION_TEST"):
    from mutation import tracing

    tracing.follow_child()
