"""Look for tinsmith on the path, before where it is installed."""

import sys

sys.meta_path[:] = [f for f in sys.meta_path if "ScikitBuild" not in type(f).__name__]
