"""Reports: what was measured between two surfaces, on paper to be signed."""

from .production import VolumeReport, volume_report

__all__ = ["VolumeReport", "volume_report"]
