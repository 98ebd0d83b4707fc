"""The words of headers: which name a coordinate, and which change nothing of its meaning.

A word that is in none of these tables is not known to be harmless, and a column whose name has one
is not taken as a coordinate. Words are written as :func:`simplify` returns them; phrases of several
words are joined ("ussurveyfoot").
"""

from __future__ import annotations

import re
import unicodedata
from functools import cache
from typing import Literal, NamedTuple

__all__ = ["CONTEXT", "Kind", "Sense", "find_sense", "simplify"]

Kind = Literal["word", "letter", "axis", "angle", "sure", "open", ""]
"""How a word names its role.

``"word"`` easting, ``"letter"`` E, ``"axis"`` X, Y, Z, which point elsewhere in some countries;
``"angle"`` longitude; ``"sure"`` an elevation and nothing else, ``"open"`` a height of some kind.
"""


class Sense(NamedTuple):
    """What a word or phrase says of a column."""

    what: Literal["role", "unit", "degree", "datum", "system", "noun"]
    role: str = ""
    """What a word for a role names; the name of a system."""
    kind: Kind = ""
    rank: int = 0
    """Of words for one role the first say it most clearly."""


_ROLES: dict[tuple[str, Kind], str] = {
    ("easting", "word"): "easting eastings east rechtswert ostwert ost rechts rw este est leste",
    ("easting", "letter"): "e",
    ("easting", "axis"): "x abscisse",
    ("easting", "angle"): "longitude long lon lng longitud lange laenge",
    ("northing", "word"): "northing northings north hochwert nordwert nord hoch hw norte",
    ("northing", "letter"): "n",
    ("northing", "axis"): "y ordonnee",
    ("northing", "angle"): "latitude lat latitud breite",
    ("elevation", "axis"): "z",
    ("elevation", "sure"): (
        "elevation elevations elev elevacion elevacao el rl reducedlevel level cota quota kote "
        "orthometricheight orthoheight orthometricelevation nhn"
    ),
    ("elevation", "open"): (
        "height heights hgt h hoehe hohe altitude altitud alt altura hoyde hojd hoogte ele"
    ),
    ("number", ""): (
        "point points pt pts pointnumber pointno pointnr pointnum pointid pointname ptno ptnr "
        "ptnum ptnumber ptid ptname pnt pno p no nr num number id name punkt punktnummer punktnr "
        "pktnr punto fid objectid pkt ponto matricule numero"
    ),
    ("description", ""): (
        "description desc descr code featurecode fieldcode rawdescription fulldescription "
        "pointcode pointdescription d bemerkung beschreibung descripcion codigo remark remarks "
        "comment note notes feature label type libelle descricao descrizione codice"
    ),
    ("hemisphere", ""): (
        "ns ew latdir londir latns lonew longew hemisphere hemi latitudedirection "
        "longitudedirection latdirection londirection lathemisphere lonhemisphere latref lonref"
    ),
}
CONTEXT = frozenset(("point", "points", "pt", "pnt", "punkt", "pkt", "punto", "ponto"))
"""Words for a point, which beside that for a coordinate say nothing: POINT_X."""

_NOUNS = (
    "coordinate coordinates coord coords coor koordinate koordinaten koord coordenada coordenadas "
    "coordinata coordonnee coordonnees center centre value wert valor valeur position up positiveup"
)
_AFFIXES = (*("coordinate", "coord", "koordinate", "koord", "coordenada", "coordonnee"),
            *("point", "center", "centre", "utm", "grid", "value"))  # fmt: skip
"""Words that are written together with the letter of an axis: xcoord, utmx."""

_OF_PLANE = ("utm", "grid")

_UNITS = (
    "m metre metres meter meters mtr mtrs mm cm dm km ft foot feet usft ussft ftus usfoot usfeet "
    "sft ussurveyfoot ussurveyfeet surveyfoot surveyfeet ussurveyft surveyft ift intft ftint "
    "internationalfoot internationalfeet yd yard yards fathom fathoms"
)
_DEGREES = "deg degs degree degrees ° dd decdeg decimaldegree decimaldegrees grad° wgs84degrees"
_DATUMS = re.compile(
    "navd(88)?|ngvd(29)?|egm(84|96|2008|08)|geoid(03|09|12a?|12b|18)|cgvd(28|2013)|nhn|nn|mnn|unn|"
    "uebernn|ubernn|ueberm?nhn|uberm?nhn|munhn|mnhn|dhhn(85|92|2016)?|evrf(2000|2007|2019)|a?msl|"
    "masl|asl|abovemsl|(above)?(mean)?sealevel|verticaldatum|datum|aod|odn|od|malin|ahd(71)?|nap|"
    "ngf(ign69)?|ign69|ln02|lhn95|rh(70|2000)|nn(1954|2000)|dvr90|n(60|2000)|bpv|kronstadt|"
    "nzvd(2009|2016)|mum|umm|masm|orthometric|orthom|ortho|vertical|chartdatum"
)
_SYSTEMS = re.compile(
    "(wgs)?(19)?84?utm(zone)?[0-9]{0,2}[ns]?|utm(zone)?[0-9]{0,2}[ns]?|zone[0-9]{1,2}[ns]?|"
    "wgs(19)?(72|84)|nad(27|83)([0-9]{4})?|etrs(89|1989)?|epsg[0-9]{4,6}|gda(94|2020)|"
    "mga(94|2020)?(zone)?[0-9]{0,2}|osgb(36)?|bng|itm|lv(03|95)|ch1903|rgf93|"
    "lambert(ii|iii|iv|i|93|72|2008|cc[0-9]{2})?|l93|gk[0-9]?|gausskr(ue|u)ger|dhdn|mgi|"
    "sweref99(tm)?|rt90|rd(new)?|sirgas(2000)?|sad69|pz90|sk42|jgd(2000|2011)|nzgd2000|nztm(2000)?|"
    "hd72|eov|sjtsk|spcs|stateplane|grid|ground|local|global|world|map|projected|projection|plane"
)
_PLAIN_LETTERS = str.maketrans({"ø": "o", "æ": "ae", "ł": "l", "đ": "d", "œ": "oe"})
_ACCENTS = re.compile("[\u0300-\u036f]")


def simplify(word: str) -> str:
    """Return a word without case and accents."""
    letters = unicodedata.normalize("NFKD", word).casefold().translate(_PLAIN_LETTERS)
    return _ACCENTS.sub("", letters)


@cache
def _make_vocabulary() -> dict[str, Sense]:
    words = {
        word: Sense("role", role, kind, rank)
        for (role, kind), text in _ROLES.items()
        for rank, word in enumerate(text.split())
    }
    for what, text in (("unit", _UNITS), ("degree", _DEGREES), ("noun", _NOUNS)):
        words |= {word: Sense(what) for word in text.split()}  # type: ignore[arg-type]
    return words


def find_sense(phrase: str) -> list[Sense]:
    """Return what a phrase says; [] if it is not known.

    Examples
    --------
    >>> find_sense("hochwert")[0].role, find_sense("m")[0].what
    ('northing', 'unit')
    >>> [sense.what for sense in find_sense("utmx")], find_sense("sdev")
    (['system', 'role'], [])
    """
    known = _make_vocabulary().get(phrase)
    if known is not None:
        return [known]
    if _DATUMS.fullmatch(phrase):
        return [Sense("datum")]
    if _SYSTEMS.fullmatch(phrase):
        return [Sense("system", phrase)]
    for affix in _AFFIXES:
        is_behind = phrase.endswith(affix)
        rest = phrase.removesuffix(affix) if is_behind else phrase.removeprefix(affix)
        role = _make_vocabulary().get(rest)
        is_role = rest != phrase and role is not None and role.what == "role"
        if is_role and role is not None and (affix not in _OF_PLANE or role.role != "elevation"):
            return [*(one for one in find_sense(affix) if one.what != "role"), role]
    return []
