"""Check a TIN."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

from qgis.core import QgsProcessingOutputBoolean, QgsProcessingOutputNumber

from ..inputs import Surface
from ..options import choice
from ..process import Failed
from .base import CommandAlgorithm, Run


class CheckAlgorithm(CommandAlgorithm):
    """Prove that a TIN is sound."""

    verb = "check"
    title = "Check TIN"
    summary = "Proves that a TIN is sound and Delaunay, exactly, without the code that built it."
    explanation = (
        "Problems are in the log, red; SOUND tells a model whether there is any. Points and DEMs "
        "are checked by the TIN that is built of them."
    )
    surfaces = (Surface(words="TIN"),)
    options = (
        choice(
            "LEVEL",
            "Level of proof",
            "--level",
            "1: indices and neighbours. 2: also orientation, hull, areas. 3: also every edge "
            "exactly Delaunay.",
            ("3", "2", "1"),
        ),
    )

    def add_outputs(self) -> None:
        """Add the verdict."""
        help_text = "Counts and problems as tinsmith tells them."
        self.add_file_output("OUTPUT", "Findings", "JSON (*.json)", help_text, optional=True)
        self.addOutput(QgsProcessingOutputBoolean("SOUND", "Sound"))
        self.addOutput(QgsProcessingOutputNumber("PROBLEMS", "Problems"))

    def make(self, run: Run) -> dict[str, Any]:
        """Check; a TIN that is not sound is a finding, no failure of the algorithm."""
        path = run.name_output("OUTPUT")
        found = self._check(run)
        for problem in found["problems"]:
            run.feedback.reportError(problem["sentence"] if "sentence" in problem else str(problem))
        if not found["problems"]:
            counts = ", ".join(f"{value:,} {name}" for name, value in found["counts"].items())
            run.feedback.pushInfo(f"Sound by level {found['level']}: {counts}.")
        outputs = {"SOUND": found["ok"], "PROBLEMS": len(found["problems"])}
        if path:
            Path(path).write_text(json.dumps(found, indent=2) + "\n", encoding="utf-8")
            outputs["OUTPUT"] = path
        return outputs

    def _check(self, run: Run) -> dict[str, Any]:
        try:
            return run.run(self.list_inputs(run))
        except Failed as failed:
            found = json.loads(failed.answer) if failed.answer.strip() else {}
            if found.get("ok") is False:
                return dict(found)
            raise
