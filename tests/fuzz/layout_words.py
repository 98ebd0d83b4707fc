"""What survey exports call their columns, by language; from manuals and files, not from our code.

A group is how one export calls number, easting, northing, elevation and description. In groups of
`AXES` X is the easting; in `NORTH_AXES` it is the northing, as on the plans of those countries.
"""

from __future__ import annotations

Group = tuple[str, str, str, str, str]


def groups(text: str) -> tuple[Group, ...]:
    """Return the groups of a table, a line each."""
    lines = [line.split("|") for line in text.strip().splitlines()]
    found = [tuple(cell.strip() for cell in line) for line in lines]
    assert all(len(group) == 5 for group in found), found
    return tuple((a, b, c, d, e) for a, b, c, d, e in found)


WORDS: dict[str, tuple[Group, ...]] = {
    "en": groups("""
        Point|Easting|Northing|Elevation|Description
        Point Number|Easting|Northing|Elevation|Raw Description
        Pt No|East|North|Elev|Code
        Point ID|E|N|RL|Remarks
        PointID|Easting|Northing|Ortho Height|Code
        Name|Easting|Northing|Elevation|Feature Code
        Station|Grid Easting|Grid Northing|Orthometric Height|Notes
        Stn|Easting|Northing|Reduced Level|Remark
        Pt#|E|N|Z|Desc
        No.|Eastings|Northings|Level|Description
        ID|Easting|Northing|Height|Comment
        Point Name|East Coordinate|North Coordinate|Elevation|Feature
        P|E|N|Z|D
        Target|Easting|Northing|Altitude|Label
        """),
    "de": groups("""
        Punktnummer|Rechtswert|Hochwert|Höhe|Code
        Pkt|Ostwert|Nordwert|NHN-Höhe|Bemerkung
        PktNr|Ost|Nord|Höhe|Kommentar
        Punkt-Nr.|E|N|H|Punktart
        Nr.|Rechts|Hoch|Höhe|Beschreibung
        Punktname|Rechtswert|Hochwert|Höhe ü. NN|Code
        Punkt|East|North|Höhe|Bemerkungen
        Pkt.Nr.|Ostwert|Nordwert|Meereshöhe|Objekt
        PNR|Rechtswert|Hochwert|Geländehöhe|Bemerkung
        """),
    "fr": groups("""
        Matricule|Est|Nord|Altitude|Libellé
        Point|Est|Nord|Alti|Code
        Numéro|Est|Nord|Cote|Désignation
        N°|E|N|Alt.|Nature
        Nom|Coordonnée Est|Coordonnée Nord|Altitude|Remarque
        N° point|Est|Nord|Altitude NGF|Observations
        Station|Abscisse|Ordonnée|Altitude|Commentaire
        """),
    "es": groups("""
        Punto|Este|Norte|Cota|Descripción
        Nombre|Este|Norte|Elevación|Código
        Vértice|Coordenada Este|Coordenada Norte|Altitud|Observaciones
        N°|Este|Norte|Altura|Detalle
        Pto|E|N|Z|Desc.
        Id Punto|Este|Norte|Cota|Código
        Nº Punto|Este|Norte|Altura Ortométrica|Descripcion
        """),
    "pt": groups("""
        Ponto|Leste|Norte|Cota|Descrição
        Vértice|Este|Norte|Altitude|Observação
        Nome|Leste|Norte|Elevação|Código
        Marco|E|N|Altitude Ortométrica|Obs
        Nº|Coordenada E|Coordenada N|Cota|Descricao
        """),
    "it": groups("""
        Punto|Est|Nord|Quota|Descrizione
        Nome punto|Est|Nord|Quota|Codice
        N. punto|E|N|Quota|Note
        Vertice|Coordinata Est|Coordinata Nord|Quota ortometrica|Note
        Nome|Est|Nord|Quota s.l.m.|Codice
        """),
    "nl": groups("""
        Puntnummer|Oost|Noord|Hoogte|Omschrijving
        Punt|Oost|Noord|Hoogte NAP|Code
        Puntnr|E|N|Hoogte|Opmerking
        """),
    "da": groups("""
        Punktnr|Øst|Nord|Kote|Kode
        Punkt|E|N|Højde|Bemærkning
        Punktnummer|Øst|Nord|Kote|Beskrivelse
        """),
    "no": groups("""
        Punkt|Øst|Nord|Høyde|Kode
        Punkt-ID|Ø|N|H|Tema
        Punktnr|Øst|Nord|Høyde|Beskrivelse
        Pkt|E|N|Kote|Merknad
        """),
    "sv": groups("""
        Punktnr|Öst|Nord|Höjd|Kod
        Punkt|E|N|Höjd|Beskrivning
        Punkt-ID|Öst|Nord|Plushöjd|Anmärkning
        """),
    "fi": groups("""
        Piste|Itä|Pohjoinen|Korkeus|Koodi
        Pistenumero|E|N|Korkeus|Laji
        Nro|Itäkoordinaatti|Pohjoiskoordinaatti|Korkeus|Selite
        """),
    "et": groups("""
        Punkt|Ida|Põhi|Kõrgus|Kood
        Punkti nr|E|N|Kõrgus|Märkus
        """),
    "lv": groups("""
        Punkts|Austrumi|Ziemeļi|Augstums|Kods
        Nr.|E|N|Augstums|Piezīmes
        """),
    "lt": groups("""
        Taškas|Rytai|Šiaurė|Aukštis|Kodas
        Taško Nr.|E|N|Altitudė|Pastabos
        """),
    "pl": groups("""
        Nr punktu|E|N|Wysokość|Opis
        Numer|Wschód|Północ|Wysokość|Kod
        Punkt|Wschodnia|Północna|Rzędna|Uwagi
        """),
    "cs": groups("""
        Číslo bodu|Východ|Sever|Výška|Popis
        Bod|E|N|Nadmořská výška|Kód
        Č. bodu|E|N|Výška|Poznámka
        """),
    "sk": groups("""
        Číslo bodu|Východ|Sever|Výška|Popis
        Bod|E|N|Nadmorská výška|Kód
        """),
    "sl": groups("""
        Točka|Vzhod|Sever|Višina|Opis
        Št. točke|E|N|Nadmorska višina|Koda
        Točka|E|N|H|Opomba
        """),
    "hr": groups("""
        Točka|Istok|Sjever|Visina|Opis
        Broj točke|E|N|Visina|Napomena
        Oznaka|E|N|H|Kod
        """),
    "sr": groups("""
        Tačka|Istok|Sever|Visina|Opis
        Broj tačke|E|N|Kota|Napomena
        """),
    "hu": groups("""
        Pontszám|Kelet|Észak|Magasság|Kód
        Pont|EOV Y|EOV X|Magasság|Megjegyzés
        """),
    "ro": groups("""
        Nr. pct.|Est|Nord|Cota|Cod
        Punct|Est|Nord|Cotă|Descriere
        Nume punct|E|N|H|Observații
        """),
    "bg": groups("""
        Точка|Изток|Север|Кота|Код
        №|E|N|Височина|Забележка
        """),
    "ru": groups("""
        Номер|Восток|Север|Высота|Код
        № точки|Восток|Север|Отметка|Примечание
        Имя точки|Восточная координата|Северная координата|Высота|Описание
        Точка|E|N|Отметка|Код
        """),
    "uk": groups("""
        Точка|Схід|Північ|Висота|Код
        № точки|Схід|Північ|Відмітка|Опис
        """),
    "el": groups("""
        Σημείο|Ανατολικά|Βόρεια|Υψόμετρο|Κωδικός
        Α/Α|Ανατολή|Βορράς|Υψόμετρο|Περιγραφή
        """),
    "tr": groups("""
        Nokta No|Doğu|Kuzey|Yükseklik|Kod
        Nokta|Sağa|Yukarı|Kot|Açıklama
        Nokta Adı|Doğu|Kuzey|Kot|Açıklama
        """),
    "he": groups("""
        נקודה|מזרח|צפון|גובה|קוד
        מספר נקודה|מזרח|צפון|רום|תיאור
        """),
    "ar": groups("""
        النقطة|شرقيات|شماليات|المنسوب|الوصف
        رقم النقطة|الشرق|الشمال|الارتفاع|ملاحظات
        """),
    "ja": groups("""
        点名|東座標|北座標|標高|コード
        点番号|東|北|高さ|備考
        """),
    "zh": groups("""
        点号|东坐标|北坐标|高程|编码
        点名|东坐标|北坐标|高程|备注
        序号|东|北|高程|代码
        点号|横坐标|纵坐标|高程|说明
        点名|E|N|高程|编码
        """),
    "zh-tw": groups("""
        點號|東坐標|北坐標|高程|備註
        點名|橫坐標|縱坐標|高程|說明
        點號|E|N|高程|代碼
        """),
    "ko": groups("""
        점번호|동쪽|북쪽|표고|코드
        측점|E|N|표고|비고
        점명|동|북|높이|설명
        """),
    "id": groups("""
        Titik|Timur|Utara|Elevasi|Keterangan
        No|Easting|Northing|Elevasi|Keterangan
        No. Titik|Timur|Utara|Ketinggian|Deskripsi
        """),
    "vi": groups("""
        Tên điểm|Đông|Bắc|Cao độ|Ghi chú
        STT|E|N|Độ cao|Mã
        """),
    "th": groups("""
        จุด|ตะวันออก|เหนือ|ระดับ|หมายเหตุ
        ชื่อจุด|E|N|ค่าระดับ|รหัส
        """),
    "is": groups("""
        Punktur|Austur|Norður|Hæð|Kóði
        Nr.|E|N|Hæð|Lýsing
        """),
}
"""Groups that name east and north."""

AXES: dict[str, tuple[Group, ...]] = {
    "en": groups("""
        Point|X|Y|Z|Code
        ID|x|y|z|label
        OBJECTID|POINT_X|POINT_Y|POINT_Z|Type
        fid|X Coordinate|Y Coordinate|Z Coordinate|Description
        Name|X Coord|Y Coord|Elevation|Notes
        pt|coord_x|coord_y|coord_z|code
        """),
    "de": groups("""
        Nr|X|Y|Z|Code
        Punkt|X-Koordinate|Y-Koordinate|Höhe|Bemerkung
        Pkt|X [m]|Y [m]|Z [m]|Art
        """),
    "fr": groups("""
        Point|X|Y|Z|Code
        N°|X|Y|Alti|Nature
        Matricule|Coord. X|Coord. Y|Altitude|Libellé
        """),
    "es": groups("""
        Punto|X|Y|Z|Código
        Nombre|Coord. X|Coord. Y|Cota Z|Descripción
        Punto|Coordenada X|Coordenada Y|Cota|Observaciones
        Vértice|X|Y|Cota|Detalle
        PUNTO|X_UTM|Y_UTM|COTA|DESCRIPCION
        """),
    "pt": groups("""
        Ponto|X|Y|Z|Código
        Ponto|Coordenada X|Coordenada Y|Cota|Descrição
        """),
    "it": groups("""
        Punto|X|Y|Z|Codice
        Nome|Coord. X|Coord. Y|Quota|Descrizione
        """),
    "nl": groups("""
        Puntnummer|X-coördinaat|Y-coördinaat|Hoogte|Omschrijving
        Puntnr|X|Y|Z|Opmerking
        """),
    "el": groups("""
        Α/Α|Χ|Υ|Ζ|Περιγραφή
        Σημείο|X|Y|H|Κωδικός
        """),
    "id": groups("""
        Nama Titik|X|Y|Z|Kode
        No|Koordinat X|Koordinat Y|Elevasi|Keterangan
        """),
    "hr": groups("""
        Točka|X|Y|Z|Opis
        """),
    "he": groups("""
        נקודה|X|Y|Z|קוד
        """),
    "th": groups("""
        จุด|X|Y|Z|หมายเหตุ
        """),
}
"""Groups whose X is the easting."""

NORTH_AXES: dict[str, tuple[Group, ...]] = {
    "de": groups("""
        Punkt|Y|X|H|Bemerkung
        Pkt|Y|X|Höhe|Code
        """),
    "pl": groups("""
        Nr|Y|X|H|Kod
        Nr punktu|Współrzędna Y|Współrzędna X|Wysokość|Opis
        """),
    "sr": groups("""
        Tačka|Y|X|H|Opis
        """),
    "hu": groups("""
        Pontszám|Y|X|Z|Kód
        Pont|Y|X|Magasság|Megjegyzés
        """),
    "ro": groups("""
        Nr|Y|X|Z|Cod
        Nr. punct|Y|X|Cota|Observații
        """),
    "bg": groups("""
        №|Y|X|H|Код
        Точка|Y|X|Кота|Забележка
        """),
    "ru": groups("""
        №|Y|X|H|Код
        Имя|Y|X|Отметка|Описание
        Название точки|Координата Y|Координата X|Высота|Примечание
        """),
    "uk": groups("""
        №|Y|X|H|Код
        Точка|Y|X|Відмітка|Опис
        """),
    "tr": groups("""
        Nokta No|Y|X|Z|Kod
        Nokta|Y|X|Kot|Açıklama
        """),
    "ja": groups("""
        点名|Y座標|X座標|標高|備考
        点番|Y|X|Z|コード
        測点名|Y座標|X座標|地盤高|備考
        """),
    "zh": groups("""
        点号|Y|X|H|编码
        点名|Y坐标|X坐标|高程|备注
        """),
    "ko": groups("""
        점번호|Y|X|Z|코드
        점명|Y좌표|X좌표|표고|비고
        """),
    "vi": groups("""
        Tên điểm|Y|X|H|Ghi chú
        STT|Tọa độ Y|Tọa độ X|Cao độ|Mã
        """),
}
"""Groups whose X is the northing and Y the easting, in the order of number, easting, northing."""

ANGLES = {
    "en": (("Longitude", "Latitude"), ("Lon", "Lat"), ("longitude_deg", "latitude_deg")),
    "de": (("Längengrad", "Breitengrad"), ("Länge", "Breite"), ("Longitude", "Latitude")),
    "fr": (("Longitude", "Latitude"), ("Longitude WGS84", "Latitude WGS84")),
    "es": (("Longitud", "Latitud"),),
    "pt": (("Longitude", "Latitude"),),
    "it": (("Longitudine", "Latitudine"),),
    "nl": (("Lengtegraad", "Breedtegraad"),),
    "sv": (("Longitud", "Latitud"),),
    "da": (("Længdegrad", "Breddegrad"),),
    "pl": (("Długość", "Szerokość"),),
    "ru": (("Долгота", "Широта"),),
    "ja": (("経度", "緯度"),),
    "zh": (("经度", "纬度"),),
    "ko": (("경도", "위도"),),
}
"""Names of longitude and latitude."""

EXTRAS: dict[str, tuple[str, ...]] = {
    "small": (
        "HRMS", "VRMS", "H RMS (m)", "V Prec", "Horz Prec", "PDOP", "HDOP", "StdDev E", "sdev N",
        "Std Dev Z", "SD_E", "Sigma H", "mE", "mN", "mH", "CQ 3D", "Residual", "Residual Z", "dZ",
        "Lateral RMS", "Elevation RMS", "Easting RMS", "Northing RMS", "Precisión H",
        "Genauigkeit",
        "Précision Z", "Lagegenauigkeit", "Höhengenauigkeit", "EMQ Z", "Delta E", "Delta N",
        "Dif. Cota", "精度", "СКО", "Felh. H", "Z error", "Elevation (sdev)", "Vertical Precision",
    ),
    "rod": (
        "Antenna Height", "Antenna height (m)", "HI", "HR", "Target Height", "Instrument Height",
        "Rod Height", "Reflektorhöhe", "Antennenhöhe", "Zielhöhe", "Instrumentenhöhe",
        "Hauteur antenne", "Hauteur prisme", "Altura de antena", "Altura instrumento",
        "Altura do Bastão", "Altezza antenna", "Antennhöjd", "Antennehøyde", "Wysokość anteny",
        "Výška antény", "Высота антенны", "天线高", "アンテナ高", "안테나높이", "Height (antenna)",
        "Height (instrument)", "Pole height",
    ),
    "geoid": (
        "Geoid Separation", "Geoid", "Undulation", "N (geoid)", "Geoid Height", "Geoidundulation",
        "Geoidhöhe", "Ondulation", "Ondulación", "Height anomaly", "H (geoid)", "大地水准面差距",
    ),
    "date": ("Date", "Datum", "Fecha", "Data", "Datum/Zeit", "Dato", "Timestamp", "日期", "Дата"),
    "count": ("Satellites", "Sats", "Epochs", "GNSS Week", "Anzahl Sat", "Satélites", "卫星数",
              "Class", "Return Number", "Intensity", "Layer"),
    "text": ("Solution", "Status", "Fix", "Lösung", "Method", "Surveyor", "Crew", "Layer Name",
             "Photo", "Estado", "状态"),
    "attribute": ("Diameter (mm)", "Width", "Girth", "Tree Height", "Pipe dia", "Length",
                  "Invert Depth", "Durchmesser", "Breite [m]", "Diamètre", "Azimuth", "Slope",
                  "Distance", "Chainage", "Offset", "Station m", "Depth (m)", "Scale Factor",
                  "Combined Factor", "Spread"),
}  # fmt: skip
"""Columns beside the coordinates, that are none of them, by what they hold."""

SECOND_PAIRS = (
    ("Latitude", "Longitude", "Ellipsoidal Height"),
    ("Lat", "Lon", "Ellip Height"),
    ("Latitude", "Longitude", "h ell"),
    ("Breite", "Länge", "Ell. Höhe"),
    ("Latitud", "Longitud", "Altura elipsoidal"),
    ("Latitude", "Longitude", "Hauteur ellipsoïdale"),
    ("Широта", "Долгота", "Эллипсоидальная высота"),
    ("纬度", "经度", "大地高"),
)
"""Names of WGS 84 coordinates that GNSS controllers export beside those of the grid."""

FOREIGN_HEIGHTS = (
    "Height (instrument)", "Height (target)", "Height (antenna)", "Height (geoid)", "Geoid Height",
    "Elev (std dev)", "Z (RMS)", "Z (sdev)", "Elevation (sdev)", "H (geoid)", "Antenna Height",
    "Instrument Height", "Elevation error", "Height above antenna", "Höhe (Reflektor)",
    "Höhe (Antenne)", "Reflektorhöhe", "Altura (antena)", "Altura de instrumento", "Cota (error)",
    "Altitude (précision)", "Hauteur (prisme)", "Quota (errore)", "Высота (инструмент)",
    "Высота антенны", "高程 (精度)", "天线高", "標高 (誤差)", "Tree height", "Baumhöhe", "dZ",
    "Delta Elevation", "Elev diff", "Cut/Fill", "Z residual", "Level (dB)", "Height of rod",
    "Höhendifferenz", "Altura del prisma", "Wysokość (instrumentu)", "Depth", "Tiefe",
    "Profundidad",
    "Profondeur", "Prof.", "Z (depth)", "Z (positive down)", "-Z", "Depth (m)", "Высота (ошибка)",
    "Elevation below datum", "Minus Z", "Z*-1", "Z (inverted)", "Z (x100)", "Z (x0.01)",
    "Elevation/100", "Elev (-300)", "Elev (+1000)", "Z - 300", "10*Z", "Z (truncated)",
)  # fmt: skip
"""Names of columns that hold no elevation of the point, or not as it is."""

FOREIGN_PLACES = (
    ("Easting (x1000)", "Northing (x1000)"), ("E (-500000)", "N (-4000000)"), ("-X", "-Y"),
    ("Easting (offset)", "Northing (offset)"), ("dE", "dN"), ("Easting - 300000",
    "Northing - 200000"),
    ("Delta X", "Delta Y"), ("X (sdev)", "Y (sdev)"), ("Easting (km)", "Northing (km)"),
    ("Westing", "Southing"), ("X (west)", "Y (south)"), ("E error", "N error"),
    ("X (geocentric)", "Y (geocentric)"), ("X ECEF", "Y ECEF"), ("Abw. Rechts", "Abw. Hoch"),
    ("Easting (truncated)", "Northing (truncated)"), ("X/1000", "Y/1000"), ("Pixel X", "Pixel Y"),
    ("X (pixel)", "Y (pixel)"), ("Row", "Column"), ("Chainage", "Offset"), ("Station", "Offset"),
    ("Rechtswert (gekürzt)", "Hochwert (gekürzt)"), ("X [mm]", "Y [mm]"), ("E (chains)",
    "N (chains)"),
    ("Este (error)", "Norte (error)"), ("东坐标 (误差)", "北坐标 (误差)"),
)  # fmt: skip
"""Names of columns that hold no easting and northing in the units of the CRS."""

TITLES = (
    "Job: {job}", "Project: {job}", "Projekt: {job}", "Chantier : {job}", "Obra: {job}",
    "Survey of {job}", "Lavoro: {job}", "Объект: {job}", "工程名称: {job}", "現場名: {job}",
    "Coordinate list {job}", "Koordinatenverzeichnis {job}", "Listado de puntos {job}",
    "Created: 2026-05-04 10:12", "Datum: 04.05.2026", "Fecha: 04/05/2026", "User: JMK",
    "Version 3.20", "Instrument: TS16 S/N 3210456", "Exported by Survey Office",
    "Measured by M. Weber", "Field book 12, page 3",
)  # fmt: skip
"""Lines above a table that say nothing of its columns."""

ORDERS = (
    "# {n},{e},{z}", "# columns: {words}", "# Format: {letters}", "// order: {words}",
    "# {letters}", "; {words}", "# fields: {words}", "# Order of columns: {words}",
    "! {letters} format", "% columns = {words}", "# Columns: {letters}", "Format: {letters}",
    "Point list in order {words}", "Order: {words}", "# {full}", "// {full}", "#{full}",
    "# column order is {words}",
)  # fmt: skip
"""Lines above a table that name the order of its columns."""
