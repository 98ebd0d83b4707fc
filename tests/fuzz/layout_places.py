"""Places of surveys: a CRS, a point in it, the languages spoken there, and what X means there."""

from __future__ import annotations

from typing import NamedTuple


class Place(NamedTuple):
    """A place, with what the surveyors there take for granted."""

    crs: str | None
    point: tuple[float, float, float]
    """Easting, northing and elevation of a site, in the units of the CRS."""
    languages: str
    x_is_north: bool = False
    """Whether X is the northing and Y the easting on the plans of the country."""
    unit: str = "m"
    """Of the CRS."""
    zone: str = ""
    """What exports write for the CRS beside the names of columns."""
    datum: str = ""
    """What exports write for the height system beside the elevation."""


PLACES = {
    "Tennessee": Place("EPSG:32616", (752_700, 4_024_240, 322), "en", zone="UTM 16N"),
    "Nashville, feet": Place("EPSG:2274", (1_745_000, 665_000, 520), "en", unit="ftUS"),
    "New York, feet": Place("EPSG:2263", (985_000, 200_000, 31), "en", unit="ftUS"),
    "Austin, feet": Place("EPSG:2277", (3_115_000, 10_070_000, 550), "en", unit="ftUS"),
    "Phoenix, feet": Place("EPSG:2223", (650_000, 890_000, 1_090), "en", unit="ft"),
    "Toronto": Place("EPSG:2952", (313_000, 4_835_000, 92), "en", zone="MTM 10", datum="CGVD2013"),
    "Quebec": Place("EPSG:2949", (246_000, 5_186_000, 61), "fr", zone="MTM 7"),
    "Melbourne": Place("EPSG:7855", (321_000, 5_813_000, 41), "en", zone="MGA 55", datum="AHD"),
    "Wellington": Place("EPSG:2193", (1_749_000, 5_428_000, 22), "en", zone="NZTM2000"),
    "Birmingham": Place("EPSG:27700", (407_000, 287_000, 120), "en", zone="OSGB36", datum="ODN"),
    "Dublin": Place("EPSG:2157", (715_000, 734_000, 14), "en", zone="ITM", datum="Malin"),
    "Nairobi": Place("EPSG:32737", (257_000, 9_857_000, 1_702), "en", zone="UTM 37S"),
    "Lagos": Place("EPSG:32631", (543_000, 713_000, 8), "en", zone="UTM 31N"),
    "Munich": Place("EPSG:25832", (691_000, 5_335_000, 519), "de", zone="UTM32", datum="NHN"),
    "Munich, GK": Place("EPSG:31468", (4_468_000, 5_335_000, 519), "de", zone="GK4", datum="NN"),
    "Vienna": Place("EPSG:31256", (2_300, 340_700, 171), "de", x_is_north=True, datum="ü. A."),
    "Bern": Place("EPSG:2056", (2_600_100, 1_199_800, 553), "de fr it", zone="LV95", datum="LN02"),
    "Paris": Place("EPSG:2154", (652_000, 6_862_000, 36), "fr", zone="L93", datum="NGF"),
    "Nantes": Place("EPSG:3947", (1_355_000, 6_236_000, 19), "fr", zone="CC47", datum="IGN69"),
    "Brussels": Place("EPSG:31370", (149_000, 170_500, 25), "fr nl", datum="TAW"),
    "Amersfoort": Place("EPSG:28992", (155_100, 463_200, 3), "nl", zone="RD", datum="NAP"),
    "Madrid": Place("EPSG:25830", (440_000, 4_474_000, 652), "es", zone="UTM30"),
    "Mexico": Place("EPSG:32614", (486_000, 2_148_000, 2_241), "es", zone="UTM 14N"),
    "Lima": Place("EPSG:32718", (280_000, 8_665_000, 151), "es", zone="UTM 18S"),
    "Bogota": Place("EPSG:9377", (4_880_000, 2_075_000, 2_601), "es", zone="Origen Nacional"),
    "Santiago": Place("EPSG:32719", (346_000, 6_297_000, 571), "es", zone="WGS84 19S"),
    "Lisbon": Place("EPSG:3763", (-87_500, -103_700, 61), "pt", zone="PT-TM06"),
    "Sao Paulo": Place("EPSG:31983", (333_000, 7_395_000, 761), "pt", zone="SIRGAS2000 23S"),
    "Rome": Place("EPSG:32633", (290_500, 4_640_300, 51), "it", zone="UTM33"),
    "Copenhagen": Place("EPSG:25832", (724_300, 6_175_800, 11), "da", zone="UTM32", datum="DVR90"),
    "Oslo": Place("EPSG:25832", (598_000, 6_643_000, 92), "no", zone="UTM32", datum="NN2000"),
    "Oslo, NTM": Place("EPSG:5110", (114_000, 1_212_000, 92), "no", zone="NTM10"),
    "Stockholm": Place("EPSG:3006", (674_000, 6_580_000, 31), "sv", zone="SWEREF99TM"),
    "Stockholm, 18": Place("EPSG:3011", (153_000, 6_580_000, 31), "sv", datum="RH2000"),
    "Helsinki": Place("EPSG:3067", (385_000, 6_672_000, 21), "fi", zone="TM35FIN", datum="N2000"),
    "Tallinn": Place("EPSG:3301", (542_000, 6_589_000, 33), "et", zone="L-EST97", datum="EH2000"),
    "Riga": Place("EPSG:3059", (506_000, 312_000, 9), "lv", zone="LKS92"),
    "Vilnius": Place("EPSG:3346", (582_000, 6_061_000, 112), "lt", zone="LKS94"),
    "Warsaw": Place("EPSG:2178", (7_501_000, 5_788_000, 103), "pl", x_is_north=True),
    "Prague, UTM": Place("EPSG:32633", (458_000, 5_548_000, 252), "cs", zone="UTM33", datum="Bpv"),
    "Bratislava": Place("EPSG:32633", (668_000, 5_334_000, 141), "sk", zone="UTM33", datum="Bpv"),
    "Ljubljana": Place("EPSG:3794", (462_000, 101_000, 301), "sl", zone="D96/TM"),
    "Zagreb": Place("EPSG:3765", (459_000, 5_074_000, 121), "hr", zone="HTRS96/TM"),
    "Belgrade": Place("EPSG:32634", (457_000, 4_963_000, 118), "sr", x_is_north=True),
    "Budapest": Place("EPSG:23700", (650_200, 240_100, 112), "hu", x_is_north=True, zone="EOV"),
    "Bucharest": Place("EPSG:3844", (586_100, 330_100, 91), "ro", x_is_north=True),
    "Sofia": Place("EPSG:7801", (322_000, 4_731_000, 563), "bg", x_is_north=True),
    "Moscow": Place("EPSG:28407", (7_413_000, 6_180_000, 152), "ru", x_is_north=True),
    "Kyiv": Place("EPSG:32636", (325_000, 5_590_000, 181), "uk", x_is_north=True),
    "Athens": Place("EPSG:2100", (476_000, 4_204_000, 102), "el", zone="ΕΓΣΑ87"),
    "Istanbul": Place("EPSG:5254", (416_000, 4_540_000, 54), "tr", x_is_north=True),
    "Tel Aviv": Place("EPSG:2039", (180_000, 665_000, 32), "he"),
    "Riyadh": Place("EPSG:32638", (671_000, 2_734_000, 612), "ar", zone="UTM 38N"),
    "Tokyo": Place("EPSG:6677", (-12_100, -35_100, 13), "ja", x_is_north=True, datum="T.P."),
    "Wuhan": Place(
        "EPSG:4547", (505_000, 3_380_000, 31), "zh", x_is_north=True, datum="1985国家高程基准"
    ),
    "Taipei": Place("EPSG:3826", (305_000, 2_770_000, 16), "zh-tw", zone="TWD97"),
    "Seoul": Place("EPSG:5186", (200_300, 550_400, 42), "ko", x_is_north=True),
    "Jakarta": Place("EPSG:32748", (702_000, 9_312_000, 21), "id", zone="UTM 48S"),
    "Hanoi": Place("EPSG:3405", (588_000, 2_325_000, 12), "vi", x_is_north=True),
    "Bangkok": Place("EPSG:32647", (665_000, 1_520_000, 4), "th", zone="UTM 47N"),
    "Reykjavik": Place("EPSG:3057", (357_000, 407_000, 33), "is", zone="ISN93"),
    "a local grid": Place(None, (5_000, 1_000, 98), "en de fr es"),
    "a local grid of a plant": Place(None, (10_200, 20_400, 3), "en sv ru zh"),
}
