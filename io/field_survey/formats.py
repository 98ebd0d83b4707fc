"""The formats of survey instruments."""

from ..registry.format import Format
from .signatures import is_dc, is_gsi, is_jobxml, is_sdr

__all__ = ["FORMATS"]

FORMATS = (
    Format(
        name="gsi",
        description="Leica GSI-8 and GSI-16: points of a total station",
        suffixes=(".gsi",),
        read="tinsmith.io.field_survey.instruments.gsi:read",
        writes=(),
        sniff=is_gsi,
    ),
    Format(
        name="sdr",
        description="Sokkia SDR20 and SDR33, of Topcon and Nikon too: points of a total station",
        suffixes=(".sdr",),
        read="tinsmith.io.field_survey.instruments.sdr:read",
        writes=(),
        sniff=is_sdr,
    ),
    Format(
        name="jobxml",
        description="Trimble JobXML: points of a survey job",
        suffixes=(".jxl",),
        read="tinsmith.io.field_survey.instruments.jobxml:read",
        writes=(),
        sniff=is_jobxml,
    ),
    Format(
        name="dc",
        description="Trimble DC of Survey Controller and Access: points of a survey job",
        suffixes=(".dc",),
        read="tinsmith.io.field_survey.instruments.dc:read",
        writes=(),
        sniff=is_dc,
    ),
)
