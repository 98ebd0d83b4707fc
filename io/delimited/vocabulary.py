"""The words of headers: which name a coordinate, and which change nothing of its meaning.

A word that is in none of these tables is not known to be harmless, and a column whose name has one
is not taken as a coordinate. Words are written as :func:`simplify` returns them; phrases of several
words are joined ("ussurveyfoot").
"""

from __future__ import annotations

import csv
import re
import unicodedata
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING, Literal, NamedTuple

if TYPE_CHECKING:
    from collections.abc import Iterator

__all__ = [
    "CONTEXT",
    "Kind",
    "Sense",
    "find_sense",
    "list_languages",
    "read_languages",
    "simplify",
]

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


_SENSES: dict[str, Sense] = {
    "easting": Sense("role", "easting", "word"),
    "northing": Sense("role", "northing", "word"),
    "elevation": Sense("role", "elevation", "sure"),
    "height": Sense("role", "elevation", "open"),
    "longitude": Sense("role", "easting", "angle"),
    "latitude": Sense("role", "northing", "angle"),
    "number": Sense("role", "number"),
    "description": Sense("role", "description"),
    "coordinate": Sense("noun"),
}
"""What the phrases say that a column of ``languages.tsv`` lists, parted by commas: "height" is for
words of a height of some kind, "coordinate" for those that say nothing more beside another."""

_ROLES: dict[tuple[str, Kind], str] = {
    ("easting", "word"): "easting eastings east",
    ("easting", "letter"): "e ø",
    ("easting", "axis"): "x abscisse",
    ("easting", "angle"): "longitude long lon lng",
    ("northing", "word"): "northing northings north",
    ("northing", "letter"): "n",
    ("northing", "axis"): "y ordonnee",
    ("northing", "angle"): "latitude lat",
    ("elevation", "axis"): "z",
    ("elevation", "sure"): (
        "elevation elevations elev el rl reducedlevel level orthometricheight orthoheight "
        "orthometricelevation orthoelevation mslheight mslelevation"
    ),
    ("elevation", "open"): "height heights hgt h altitude alt ele up u",
    ("number", ""): (
        "point points pt pts pointnumber pointno pointnr pointnum pointid pointname ptno ptnr "
        "ptnum ptnumber ptid ptname pnt pno p no nr num number id name fid objectid station "
        "stationid stn stationname target targetid"
    ),
    ("description", ""): (
        "description desc descr code featurecode fieldcode rawdescription rawdesc fulldescription "
        "pointcode pointdescription d remark remarks comment comments note notes feature label type"
    ),
    ("hemisphere", ""): (
        "ns ew latdir londir latns lonew longew hemisphere hemi latitudedirection "
        "longitudedirection latdirection londirection lathemisphere lonhemisphere latref lonref"
    ),
}
"""Words in English, and letters."""
CONTEXT = frozenset(("point", "points", "pt", "pnt", "punkt", "pkt", "punto", "ponto"))
"""Words for a point, which beside that for a coordinate say nothing: POINT_X."""

_NOUNS = (
    "coordinate coordinates coord coords coor center centre value position positiveup mn me "
    "м 米 公尺 メートル 미터 metri metros metro metrów metra מ"
)
_AFFIXES = (*("coordinate", "coord", "koordinate", "koord", "coordenada", "coordonnee"),
            *("koordinaatti", "koordinat", "coordinaat", "coordinata"),
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
    "uebernn|ubernn|ueberm?nhn|uberm?nhn|munhn|mnhn|dhhn(12|85|92|2016)?|a?msl|"
    "evrf(2000|2007|2019)(nh)?|"
    "masl|asl|abovemsl|(above)?(mean)?sealevel|verticaldatum|datum|aod|odn?|malin(head)?|belfast|"
    "ahd(71)?|nap|mnap|taw|mtaw|ran95|orth|ngf(ign69)?|ign69|ngg|ln02|lhn95|rh(00|70|2000)|nn(1954|2000)|"
    "dvr90|n(43|60|2000)|eh2000|las(2000|07)?(5|h)?|las2000h5|bpv|kst|kronstadt(86)?|kronsztadt(86)?|nh|hvrs71|dnn|"
    "sno|nvn99|nzvd(2009|2016)|mum|umm|masm|m?snm|slm|orthometric|orthom|ortho|vertical|"
    "chartdatum|mpd|hkpd|tp|jgd(2000|2011)?vertical|(1985|1956)?(国家)?(黄海)?高程(基准|系统)(1985|1956)?|"
    "(1985|1956)国家高程基准|黄海|twvd(2001)?|imbituba|mbf|mbalti|балт(ииская)?|бс(77)?|kn"
)
_ZONE = "(fuso|huso|uso|fuseau|zone|zona|zon|strefa|pas)?[0-9]{0,3}(tm)?[nse]?"
_SYSTEMS = re.compile(
    f"((wgs)?(19)?(84)?utm|mtm|ntm|mga(94|2020)?|amg(66|84)?|map?grid|gk|gausskr(ue|u)ger|"
    "sirgas(2000)?|wgs(19)?(72|84)|etrs(19)?(89)?|nad(27|83)([0-9]{4})?|gda(94|2020)|rgf93|"
    "ed(19)?50|pl2000|pl1992|posgar(94|98|2007|07)?|sad69|psad56|lambert|lamb|cc|lcc|ctm|lo|wg|zone|"
    f"zona|fuso|huso|sk(42|63|95)|ск(42|63|95)|cgcs2000|turef|itrf[0-9]{{0,4}}|sweref99|d96|d48){_ZONE}|"
    "epsg[0-9]{4,6}|osgb(36)?|osgm(02|15)|bng|ig75|irenet95|itm(95)?|(lv|mn)(03|95)|svy21|ch1903|"
    "lambert(ii|iii|iv|i|cc)|cc(4[2-9]|50)|l93|l(2|ii)e?|dhdn|mgi|rt90|rd(new)?|"
    "pz90|jgd(2000|2011)|tokyo|nzgd2000|nztm(2000)?|nzmg|hd72|eov|s?jtsk(03)?|stereo70|"
    "s42|spcs(83|27)?|stateplane|htrs96(tm)?|isn(93|2004|2016)|(pt)?tm(06|35fin|30|65)|tm75|"
    "lks(92|94)|lest(97)?|twd(67|97)(tm2)?|origennacional|magna(sirgas)?|bogota|xian80|西安80|"
    "bj54|beijing54|北京54|国家2000|大地2000|2000国家大地坐标系|kkj|ykj|vn2000|gdm2000|rso|cassini|"
    "hartebeesthoek94|hart94|ggrs87|egsa87|εγσα87|εγσα|igd05|sirgaschile|bgs2005|ccs2005|"
    "уск2000|ucs2000|мск[0-9]{0,2}|msk[0-9]{0,2}|"
    "grid|ground|local|global|world|map|projected|projection|plane"
)
_PLAIN_LETTERS = str.maketrans(
    {"ø": "o", "æ": "ae", "ł": "l", "đ": "d", "œ": "oe", "ı": "i", "ð": "d", "þ": "th"}
)
_SINGLE_LETTERS = {"ø": "ø", "ö": "ø"}
"""Short for "øst" and "öst", where O is short for "oeste"."""
_LOOK_ALIKES = str.maketrans("ΧΥΖΕΝΗχυζХУЕНЗхун", "XYZENHxyzXYEHZxyh")
"""Greek and Cyrillic letters that stand alone for the Latin letters of coordinates."""
_WORDS = re.compile(r"[^\s/'№]+|№")
_ACCENTS = re.compile("[\u0300-\u036f]")


def simplify(word: str) -> str:
    """Return a word without case and accents."""
    if len(word) == 1:
        word = word.translate(_LOOK_ALIKES)
        if word.casefold() in _SINGLE_LETTERS:
            return _SINGLE_LETTERS[word.casefold()]
    letters = unicodedata.normalize("NFKD", word).casefold().translate(_PLAIN_LETTERS)
    return _ACCENTS.sub("", letters)


@cache
def read_languages() -> dict[str, dict[str, str]]:
    """Return the words of ``languages.tsv`` by language and column.

    ``x_is_north`` is not empty where X is the northing on the plans of the countries that speak it.
    """
    text = Path(__file__).with_name("languages.tsv").read_text("utf-8")
    return {row.pop("language"): row for row in csv.DictReader(text.splitlines(), delimiter="\t")}


@cache
def _make_vocabulary() -> dict[str, Sense]:
    words = {
        word: Sense("role", role, kind, rank)
        for (role, kind), text in _ROLES.items()
        for rank, word in enumerate(text.split())
    }
    for what, text in (("unit", _UNITS), ("degree", _DEGREES), ("noun", _NOUNS)):
        words |= {simplify(word): Sense(what) for word in text.split()}  # type: ignore[arg-type]
    for language in read_languages().values():
        for column, sense in _SENSES.items():
            for rank, phrase in enumerate(_list_phrases(language[column])):
                words.setdefault(phrase, sense._replace(rank=rank))
    return words


@cache
def _make_languages() -> dict[str, frozenset[str]]:
    english = {word for text in _ROLES.values() for word in text.split()} | {*_NOUNS.split()}
    found: dict[str, set[str]] = {}
    for name, language in read_languages().items():
        for column in _SENSES:
            for phrase in _list_phrases(language[column]):
                found.setdefault(phrase, set()).add(name)
    return {word: frozenset(names) for word, names in found.items() if word not in english}


def list_languages(phrase: str) -> frozenset[str]:
    """Return the languages that have a phrase, none if English has it; affixes apart.

    Examples
    --------
    >>> sorted(list_languages("wysokosc"))
    ['Polish']
    """
    known = _make_languages()
    if phrase in known:
        return known[phrase]
    for affix in _simplify_affixes():
        if phrase.endswith(affix) and affix in known:
            return known[affix]
    return frozenset()


def _list_phrases(text: str) -> Iterator[str]:
    """Return the phrases of a text as names are compared: their words joined."""
    for phrase in text.split(",") if text else ():
        yield "".join(simplify(word) for word in _WORDS.findall(phrase))


@cache
def _simplify_affixes() -> tuple[str, ...]:
    return tuple(map(simplify, _AFFIXES))


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
    for affix in _simplify_affixes():
        is_behind = phrase.endswith(affix)
        rest = phrase.removesuffix(affix) if is_behind else phrase.removeprefix(affix)
        role = _make_vocabulary().get(rest)
        is_role = rest != phrase and role is not None and role.what == "role"
        if is_role and role is not None and (affix not in _OF_PLANE or role.role != "elevation"):
            return [*(one for one in find_sense(affix) if one.what != "role"), role]
    return []
