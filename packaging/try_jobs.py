"""Run the main jobs with the tinsmith that is installed beside this Python, in the current folder.

    python packaging/try_jobs.py sample_data/site_survey.csv [--no-picture]

Points to a TIN, a look at it, and what is exported; then whether there are such files. Programs of
this environment are found, no others: a compiler is out of reach.
"""

from __future__ import annotations

import json
import os
import subprocess
import sys
import sysconfig
from pathlib import Path

JOBS = (
    "--version",
    "build {survey} --crs EPSG:32616 -o site.ply -o site.geojson",
    "view site.ply -o site.png",
    "view site.ply -o site.html",
    "contours site.ply --interval 0.5 -o contours.geojson -o contours.gpkg",
    "convert site.ply -o site.dxf -o site.xml",
    "volume site.ply --base 320 -o volume.csv -o volume.png",
    "plan site.ply -o plan.pdf",
    "raster site.ply --spacing 5 -o site.tif",
    "check site.ply",
)
BEGINNINGS = {
    "site.ply": b"ply\n",
    "site.geojson": b"{",
    "site.png": b"\x89PNG",
    "site.html": b"<!doctype html>",
    "contours.geojson": b"{",
    "contours.gpkg": b"SQLite format 3",
    "site.dxf": b"  0\nSECTION",
    "site.xml": b"<?xml",
    "volume.png": b"\x89PNG",
    "plan.pdf": b"%PDF",
    "site.tif": b"II*\0",
}


def main(survey: str, *options: str) -> None:
    """Run the jobs one by one, and look at what they made; a picture needs OpenGL."""
    programs = Path(sysconfig.get_path("scripts"))
    left_out = "site.png" if "--no-picture" in options else None
    for job in JOBS:
        if left_out is not None and left_out in job:
            continue
        arguments = [survey if word == "{survey}" else word for word in job.split()]
        told = run([str(programs / "tinsmith"), *arguments], programs)
        sys.stdout.write(f"tinsmith {job}\n{told}")
    for name, beginning in BEGINNINGS.items():
        if name != left_out and not Path(name).read_bytes().lower().startswith(beginning.lower()):
            raise SystemExit(f"{name} does not begin as such a file does.")
    count = len(json.loads(Path("site.geojson").read_text(encoding="utf-8"))["features"])
    if not count:
        raise SystemExit("site.geojson holds no features.")
    sys.stdout.write(f"All jobs done: {count} features, Python {sys.version.split()[0]}.\n")


def run(command: list[str], programs: Path) -> str:
    """Return what a command told; end this program if it failed."""
    environment = {**os.environ, "PATH": str(programs)}
    done = subprocess.run(
        command, env=environment, capture_output=True, encoding="utf-8", check=False
    )
    if done.returncode:
        raise SystemExit(f"{' '.join(command)} ended with {done.returncode}:\n{done.stderr}")
    return done.stdout


if __name__ == "__main__":
    main(str(Path(sys.argv[1]).resolve()), *sys.argv[2:])
