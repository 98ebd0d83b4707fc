"""Install the command."""

from __future__ import annotations

from typing import Any

from qgis.core import (
    QgsProcessingAlgorithm,
    QgsProcessingException,
    QgsProcessingOutputString,
    QgsProcessingParameterFile,
    QgsProcessingParameterString,
)

from ..command import Command, find_command
from ..icons import load_icon
from ..inputs import ANY_FILE
from ..installation import find_python, install
from ..options import describe


class InstallAlgorithm(QgsProcessingAlgorithm):
    """Install tinsmith for this profile, and say which command is used."""

    def createInstance(self) -> Any:
        return type(self)()

    def name(self) -> str:
        return "install"

    def displayName(self) -> str:
        return "Install tinsmith"

    def shortDescription(self) -> str:
        return "Installs the command tinsmith for this profile of QGIS, with a Python of its own."

    def shortHelpString(self) -> str:
        return (
            f"<p>{self.shortDescription()}</p>"
            "<p>Makes a virtual environment in the folder of the profile and lets pip install "
            "there what you name: a wheel, a folder with the sources of tinsmith, or what else pip "
            "takes. pip may fetch the libraries that tinsmith needs from the index it is set up "
            "for; nothing is fetched unless you run this. The Python of QGIS is left as it is.</p>"
            "<p>Without a source nothing is installed, and the log says which command is used.</p>"
        )

    def icon(self) -> Any:
        return load_icon("install")

    def initAlgorithm(self, configuration: Any = None) -> None:
        """Add what to install, and with which Python."""
        source = QgsProcessingParameterString("SOURCE", "What to install", None, False, True)
        python = QgsProcessingParameterFile(
            "PYTHON", "Python to use", QgsProcessingParameterFile.File, "", None, True, ANY_FILE
        )
        help_text = (
            "A wheel of tinsmith, the folder of its sources (which needs a C++ compiler), or what "
            "else pip takes. If it is empty, nothing is installed."
        )
        self.addParameter(describe(source, help_text))
        self.addParameter(
            describe(
                python, "Version 3.11 or newer; else the first one on PATH is taken.", "", True
            )
        )
        self.addOutput(QgsProcessingOutputString("COMMAND", "Command"))
        self.addOutput(QgsProcessingOutputString("VERSION", "Version"))

    def processAlgorithm(
        self, parameters: dict[str, Any], context: Any, feedback: Any
    ) -> dict[str, Any]:
        """Install, and ask what was installed for its version."""
        source = self.parameterAsString(parameters, "SOURCE", context).strip()
        if source:
            python = find_python(self.parameterAsFile(parameters, "PYTHON", context))
            installed = str(install(python, source, feedback))
            version = Command(installed, "installed for this profile").find_version()
            feedback.pushInfo(f"{version} is installed: {installed}")
        command = find_command()
        version = command.find_version()
        feedback.pushInfo(f"{version} is used: {command.path} ({command.origin})")
        if source and command.path != installed:
            feedback.pushWarning("Another command comes first, so the one installed is not used.")
        return {"COMMAND": command.path, "VERSION": version}

    def checkParameterValues(self, parameters: dict[str, Any], context: Any) -> tuple[bool, str]:
        """Refuse a Python that is not there before anything is done."""
        chosen = self.parameterAsFile(parameters, "PYTHON", context)
        try:
            if chosen:
                find_python(chosen)
        except QgsProcessingException as error:
            return False, str(error)
        good, words = super().checkParameterValues(parameters, context)
        return bool(good), str(words)
