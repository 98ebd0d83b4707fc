"""Words of headers in the languages that survey exports are written in, beside English.

Phrases are parted by commas, and compared as :func:`.vocabulary.simplify` returns them.
"""

from __future__ import annotations

from typing import NamedTuple

__all__ = ["LANGUAGES", "LOOK_ALIKES", "Language"]


class Language(NamedTuple):
    """What a language calls coordinates and what stands beside them."""

    easting: str
    northing: str
    elevation: str
    """Words for an elevation and nothing else: "cota"."""
    height: str
    """Words for a height of some kind: "altura"."""
    number: str
    description: str
    longitude: str = ""
    latitude: str = ""
    coordinate: str = ""
    """Words that say nothing more beside another: "coordinate", "above sea level"."""
    x_is_north: bool = False
    """Whether X is the northing on the plans of the countries that speak it."""


LANGUAGES = {
    "German": Language(
        "rechtswert, ostwert, ost, rechts, rw, hochachse ost, ostkoordinate, osten",
        "hochwert, nordwert, nord, hoch, hw, nordkoordinate, norden",
        "nhn, meereshöhe, seehöhe, geländehöhe, orthometrische höhe, normalhöhe, gebrauchshöhe",
        "höhe, hoehe, höhen, punkthöhe, höhenwert, höhenkote",
        "punkt, punktnummer, punktnr, punkt nr, pktnr, pkt, pkt nr, punktname, punkt name, "
        "punktid, "
        "punkt id, punktbezeichnung, punkt bezeichnung, pnr, nummer, lfd nr, messpunkt, "
        "bezeichnung",
        "bemerkung, bemerkungen, beschreibung, kommentar, punktart, punktcode, objekt, objektart, "
        "art, kodierung, attribut, hinweis, anmerkung, notiz, kode",
        "länge, laenge, längengrad, geographische länge, geogr länge",
        "breite, breitengrad, geographische breite, geogr breite",
        "koordinate, koordinaten, koord, wert, über nn, über nhn, ü nn, ü nhn, ü a, ü adria, "
        "über adria, "
        "ü m, ü m ü m, m ü m, müm, ü nap, ü m nn, m ü nn, m ü nhn, über meer",
    ),
    "French": Language(
        "est, coordonnée est",
        "nord, coordonnée nord",
        "cote, alti, cote altimétrique, altitude ngf, alti ngf, cote ngf, cote tn, tn, "
        "terrain naturel, altitude orthométrique",
        "altitude, alt, hauteur",
        "point, points, numéro, numéro de point, numéro point, numéro du point, n point, "
        "no point, "
        "matricule, mat, nom, nom du point, nom point, num, num point, identifiant, repère",
        "libellé, désignation, nature, remarque, remarques, commentaire, commentaires, "
        "observation, "
        "observations, objet, description, code",
        "longitude",
        "latitude",
        "coordonnée, coordonnées, coord, valeur",
    ),
    "Spanish": Language(
        "este, abscisa este",
        "norte",
        "cota, cota ortométrica, cota terreno, altura ortométrica, altitud ortométrica, "
        "elevación, elevacion, elev ortométrica",
        "altura, altitud, alt",
        "punto, pto, nombre, vértice, número, num, id punto, nº punto, n punto, no punto, "
        "número de punto, nombre punto, nombre del punto, punto no, estación, est no, "
        "identificador, identificación, pto no",
        "descripción, descripcion, código, codigo, detalle, observación, observaciones, obs, "
        "comentario, comentarios, nota, notas, desc, tipo, referencia, descriptor",
        "longitud",
        "latitud",
        "coordenada, coordenadas, coord, valor, msnm, snm, m s n m, s n m, sobre nivel del mar, "
        "sobre el nivel del mar",
    ),
    "Portuguese": Language(
        "leste, este",
        "norte",
        "cota, elevação, elevacao, altitude ortométrica, alt ortométrica, cota ortométrica",
        "altitude, altura, alt",
        "ponto, vértice, marco, nome, número, id ponto, nº ponto, n ponto, nome do ponto, pto, "
        "nome ponto, ponto nº, estação, identificação",
        "descrição, descricao, código, codigo, observação, observações, obs, comentário, desc, "
        "tipo",
        "longitude",
        "latitude",
        "coordenada, coordenadas, coord, valor",
    ),
    "Italian": Language(
        "est",
        "nord",
        "quota, quota ortometrica, quota slm, quota s l m, quota terreno, altezza ortometrica",
        "altezza, altitudine",
        "punto, nome, nome punto, nome del punto, n punto, num punto, numero, numero punto, "
        "vertice, punto n, stazione, pto, id punto",
        "descrizione, codice, note, nota, osservazioni, commento, tipo, desc",
        "longitudine",
        "latitudine",
        "coordinata, coordinate, coord, valore, slm, s l m, sul livello del mare, sul mare",
    ),
    "Romanian": Language(
        "est",
        "nord",
        "cota, cotă, cota teren, altitudine ortometrică",
        "altitudine, înălțime",
        "punct, nr punct, nr pct, pct, nume punct, număr punct, nume, nr crt, denumire, "
        "denumire punct, numar punct",
        "descriere, cod, observații, observaţii, obs, comentariu, denumire cod, tip",
        "longitudine",
        "latitudine",
        "coordonata, coordonată, coordonate, coord",
        x_is_north=True,
    ),
    "Dutch": Language(
        "oost, oosting, oosten, oostwaarde",
        "noord, noording, noorden, noordwaarde",
        "nap, maaiveldhoogte, maaiveld, peil",
        "hoogte",
        "punt, puntnummer, puntnr, punt nr, punt nummer, puntnaam, punt id, nummer, naam, volgnr",
        "omschrijving, opmerking, opmerkingen, code, codering, beschrijving, puntcode",
        "lengtegraad",
        "breedtegraad",
        "coördinaat, coördinaten, coord, coor, waarde, tov, t o v, t o v nap, tov nap, mnap",
    ),
    "Afrikaans": Language("oos", "noord", "", "hoogte", "punt", "beskrywing, kode, opmerking"),
    "Danish": Language(
        "øst, østlig, østkoordinat, easting",
        "nord, nordlig, nordkoordinat",
        "kote, terrænkote, koter, terrænhøjde",
        "højde, hoejde",
        "punkt, punktnr, punktnummer, punkt nr, punktnavn, punkt id, nummer, navn",
        "beskrivelse, kode, bemærkning, bemærkninger, kommentar, punktkode",
        "længdegrad",
        "breddegrad",
        "koordinat, koordinater, værdi",
    ),
    "Norwegian": Language(
        "øst, aust, østkoordinat",
        "nord, nordkoordinat",
        "kote, terrenghøyde, ortometrisk høyde",
        "høyde, hoyde, høgde",
        "punkt, punktnr, punktnummer, punkt nr, punktnavn, punktid, punkt id, pkt, pkt nr, navn, "
        "nummer",
        "beskrivelse, kode, tema, temakode, merknad, merknader, kommentar, objekttype, sosi kode",
        "lengdegrad",
        "breddegrad",
        "koordinat, koordinater, verdi, moh, m o h, over havet",
    ),
    "Swedish": Language(
        "öst, östlig, ostlig, östkoordinat",
        "nord, norr, nordlig, nordkoordinat",
        "plushöjd, markhöjd",
        "höjd, hojd",
        "punkt, punktnr, punktnummer, punkt nr, punktid, punkt id, punktnamn, namn, nummer, pkt",
        "beskrivning, kod, anmärkning, kommentar, punktkod, littera",
        "longitud, längdgrad",
        "latitud, breddgrad",
        "koordinat, koordinater, värde, möh, m ö h, över havet",
    ),
    "Icelandic": Language(
        "austur", "norður", "", "hæð", "punktur, punktnúmer, nafn, númer", "kóði, lýsing, "
        "athugasemd",
        "lengdargráða", "breiddargráða", "hnit",
    ),
    "Finnish": Language(
        "itä, itäkoordinaatti, itä koordinaatti",
        "pohjoinen, pohjoiskoordinaatti, pohjoinen koordinaatti, pohj",
        "maanpinnan korkeus, ortometrinen korkeus",
        "korkeus, kork",
        "piste, pistenumero, piste nro, pistenro, nro, nimi, pistetunnus, tunnus, pistenimi",
        "koodi, laji, selite, kuvaus, huomautus, huom, lajikoodi, pistelaji, kommentti",
        "pituusaste",
        "leveysaste",
        "koordinaatti, koordinaatit, mpy",
    ),
    "Estonian": Language(
        "ida, idakoordinaat",
        "põhi, põhja, põhjakoordinaat",
        "absoluutkõrgus, abs kõrgus",
        "kõrgus",
        "punkt, punkti nr, punkti number, punkti nimi, nimi, jrk nr",
        "kood, märkus, märkused, kirjeldus, selgitus",
        "pikkuskraad", "laiuskraad", "koordinaat, koordinaadid",
    ),
    "Latvian": Language(
        "austrumi, austrumu", "ziemeļi, ziemeļu", "augstuma atzīme, atzīme", "augstums",
        "punkts, punkta nr, punkta numurs, numurs, nosaukums",
        "kods, apraksts, piezīmes, piezīme",
        "ģeogrāfiskais garums", "ģeogrāfiskais platums", "koordināta, koordinātas",
    ),
    "Lithuanian": Language(
        "rytai, rytų", "šiaurė, šiaurės", "altitudė", "aukštis",
        "taškas, taško nr, taško numeris, numeris, pavadinimas",
        "kodas, aprašymas, pastabos, pastaba",
        "ilguma", "platuma", "koordinatė, koordinatės",
    ),
    "Polish": Language(
        "wschód, wschodnia, współrzędna wschodnia",
        "północ, północna, współrzędna północna",
        "rzędna, rzędna terenu, rzedna, wysokość normalna, wysokość npm, wysokość n p m",
        "wysokość, wys",
        "punkt, nr punktu, numer, numer punktu, nr pkt, nazwa, nazwa punktu, nr pktu, pkt, lp, id",
        "opis, kod, uwagi, uwaga, komentarz, obiekt, kod punktu",
        "długość geograficzna, dł geogr",
        "szerokość geograficzna, szer geogr",
        "współrzędna, współrzędne, wsp, npm, n p m, m n p m",
        x_is_north=True,
    ),
    "Czech": Language(
        "východ, východní souřadnice, východní",
        "sever, severní souřadnice, severní",
        "nadmořská výška, nadm výška, kóta, výška bpv",
        "výška",
        "číslo bodu, číslo, č bodu, bod, název bodu, název, jméno bodu, č b, čb, předčíslí",
        "popis, kód, poznámka, kód bodu, charakteristika, pozn",
        "zeměpisná délka", "zeměpisná šířka",
        "souřadnice, souř, hodnota, m n m, mnm",
        x_is_north=True,
    ),
    "Slovak": Language(
        "východ, východná súradnica", "sever, severná súradnica",
        "nadmorská výška, kóta", "výška",
        "číslo bodu, číslo, č bodu, bod, názov bodu, názov",
        "popis, kód, poznámka, kód bodu",
        "zemepisná dĺžka", "zemepisná šírka", "súradnica, súradnice, m n m, mnm",
        x_is_north=True,
    ),
    "Slovene": Language(
        "vzhod", "sever", "nadmorska višina, kota", "višina",
        "točka, št točke, številka točke, ime točke, številka, ime, oznaka, zap št",
        "opis, koda, opomba, opombe, komentar, šifra",
        "geografska dolžina", "geografska širina", "koordinata, koordinate, nmv",
    ),
    "Croatian and Serbian": Language(
        "istok, istočna koordinata, исток",
        "sjever, sever, sjeverna koordinata, severna koordinata",
        "kota, nadmorska visina, apsolutna visina, кота, надморска висина",
        "visina, висина",
        "točka, tačka, broj točke, broj tačke, br točke, br tačke, oznaka, broj, ime točke, "
        "naziv, "
        "red br, тачка, број тачке",
        "opis, kod, napomena, komentar, šifra, опис, код, напомена",
        "geografska dužina", "geografska širina",
        "koordinata, koordinate, координата",
        x_is_north=True,
    ),
    "Hungarian": Language(
        "kelet, keleti, eov y, eovy, keleti koordináta",
        "észak, északi, eov x, eovx, északi koordináta",
        "tengerszint feletti magasság, balti magasság, abszolút magasság, terepmagasság",
        "magasság",
        "pont, pontszám, psz, pont szám, pontnév, pont neve, pontazonosító, sorszám, név",
        "kód, megjegyzés, leírás, jelleg, pontkód, kód leírás",
        "földrajzi hosszúság", "földrajzi szélesség", "koordináta, koordináták, mbf, m b f",
        x_is_north=True,
    ),
    "Albanian": Language(
        "lindje", "veri", "kuota", "lartësia, lartesia", "pika, nr i pikës, emri",
        "përshkrimi, kodi, shënim", "gjatësia gjeografike", "gjerësia gjeografike", "koordinata",
    ),
    "Bulgarian": Language(
        "изток, източна координата", "север, северна координата", "кота, надморска височина",
        "височина",
        "точка, номер, номер на точка, № точка, име, точка номер",
        "код, забележка, описание, бележка", "географска дължина", "географска ширина",
        "координата, координати",
        x_is_north=True,
    ),
    "Russian": Language(
        "восток, восточная координата, восточное, восточная, на восток, восточное положение",
        "север, северная координата, северное, северная, на север, северное положение",
        "отметка, абс отметка, абсолютная отметка, высотная отметка, отметка земли, отм, "
        "нормальная высота, абс высота, абсолютная высота, ортометрическая высота",
        "высота, выс",
        "номер, точка, имя, имя точки, номер точки, название, название точки, № точки, no точки, "
        "№ п п, no п п, номер пункта, пункт, название пункта, тчк, наименование, "
        "наименование точки",
        "код, описание, примечание, комментарий, кодовое описание, код точки, признак, тип",
        "долгота", "широта", "координата, координаты, коорд, балт, бс, балтийская",
        x_is_north=True,
    ),
    "Ukrainian": Language(
        "схід, східна координата, східна", "північ, північна координата, північна",
        "відмітка, позначка, абсолютна відмітка, абс відмітка, нормальна висота", "висота",
        "точка, номер, назва, ім'я, № точки, номер точки, назва точки, no точки, пункт, № п п",
        "код, опис, примітка, коментар", "довгота", "широта", "координата, координати",
        x_is_north=True,
    ),
    "Greek": Language(
        "ανατολή, ανατολικά, ανατολική, ανατολική συντεταγμένη",
        "βορράς, βόρεια, βορράς συντεταγμένη, βόρεια συντεταγμένη",
        "υψόμετρο, ορθομετρικό υψόμετρο, απόλυτο υψόμετρο, υψομ",
        "ύψος, υψος",
        "σημείο, α/α, α α, αα, κωδικός σημείου, αριθμός, αριθμός σημείου, όνομα, όνομα σημείου",
        "κωδικός, περιγραφή, παρατηρήσεις, σχόλια, είδος",
        "γεωγραφικό μήκος, γεωγρ μήκος", "γεωγραφικό πλάτος, γεωγρ πλάτος", "συντεταγμένη, "
        "συντεταγμένες",
    ),
    "Turkish": Language(
        "doğu, sağa, sağa değer, sağa değeri",
        "kuzey, yukarı, yukarı değer, yukarı değeri",
        "kot, rakım, ortometrik yükseklik, arazi kotu, zemin kotu",
        "yükseklik",
        "nokta, nokta no, nokta adı, nokta numarası, n no, nokta ismi, nokta id",
        "kod, açıklama, açıklamalar, not, tanım, nokta kodu, tür",
        "boylam", "enlem", "koordinat, koordinatı, koordinatlar, değer, değeri",
        x_is_north=True,
    ),
    "Hebrew": Language(
        "מזרח", "צפון", "רום", "גובה", "נקודה, מספר נקודה, מס נקודה, שם נקודה, שם, מספר",
        "קוד, תיאור, הערות, הערה", "קו אורך", "קו רוחב", "קואורדינטה, קואורדינטות",
    ),
    "Arabic": Language(
        "شرقيات, الشرق, شرق, الشرقيات, احداثي شرقي",
        "شماليات, الشمال, شمال, الشماليات, احداثي شمالي",
        "المنسوب, منسوب",
        "الارتفاع, ارتفاع",
        "النقطة, رقم النقطة, نقطة, رقم, اسم النقطة, الاسم",
        "الوصف, ملاحظات, وصف, الكود, كود, ملاحظة",
        "خط الطول", "خط العرض", "احداثي, احداثيات",
    ),
    "Persian": Language("شرقی", "شمالی", "", "ارتفاع", "نقطه, شماره نقطه, شماره", "کد, توضیحات"),
    "Japanese": Language(
        "東, 東方向, 東西, 東距, 東座標",
        "北, 北方向, 南北, 北距, 北座標",
        "標高, 地盤高, 海抜, 標高値",
        "高さ, 高度, 高",
        "点名, 点番, 点番号, 測点, 測点名, 測点番号, 番号, 名称, 点, ポイント, ポイント名",
        "コード, 備考, 説明, 属性, 種別, メモ, コメント, 地物コード",
        "経度", "緯度", "座標, 座標値",
        x_is_north=True,
    ),
    "Chinese": Language(
        "东, 东坐标, 横坐标, 东向, 东方向, 東, 東坐標, 橫坐標, 橫座標, 東座標, 东距",
        "北, 北坐标, 纵坐标, 北向, 北方向, 北坐標, 縱坐標, 縱座標, 北座標, 北距",
        "高程, 标高, 海拔, 海拔高, 正常高, 正高, 标高值, 地面高程, 高程值, 標高, "
        "地面標高, 海拔高程",
        "高, 高度",
        "点号, 点名, 序号, 编号, 点, 名称, 测点, 點號, 點名, 序號, 編號, 點, 名稱, 測點, 桩号名",
        "编码, 代码, 备注, 说明, 描述, 属性, 属性码, 编码说明, 代碼, 備註, 說明, 編碼, 屬性, 类型",
        "经度, 經度", "纬度, 緯度", "坐标, 坐標, 座標, 坐标值",
        x_is_north=True,
    ),
    "Korean": Language(
        "동, 동쪽, 횡좌표, 동거, 동향, 동좌표",
        "북, 북쪽, 종좌표, 북거, 북향, 북좌표",
        "표고, 지반고, 해발고도, 정표고, 해발",
        "높이, 고도",
        "점, 점번호, 점명, 측점, 번호, 측점명, 점이름, 측점번호, 명칭, 기준점",
        "코드, 비고, 설명, 속성, 메모",
        "경도", "위도", "좌표, 좌표값",
        x_is_north=True,
    ),
    "Vietnamese": Language(
        "đông, hướng đông, tọa độ đông", "bắc, hướng bắc, tọa độ bắc",
        "cao độ, cao trình, độ cao thủy chuẩn", "độ cao, chiều cao",
        "điểm, tên điểm, stt, số hiệu điểm, số hiệu, tên",
        "ghi chú, mã, mô tả, mã điểm", "kinh độ", "vĩ độ", "tọa độ, toạ độ",
        x_is_north=True,
    ),
    "Indonesian and Malay": Language(
        "timur", "utara", "elevasi, aras laras, elevasi tanah", "ketinggian, tinggi, aras",
        "titik, nama titik, no titik, nomor titik, nama, nomor, patok, stesen, no stesen",
        "keterangan, deskripsi, kode, catatan, kod", "bujur, longitud", "lintang, latitud",
        "koordinat, mdpl",
    ),
    "Thai": Language(
        "ตะวันออก, ทิศตะวันออก, ค่าพิกัดตะวันออก", "เหนือ, ทิศเหนือ, ค่าพิกัดเหนือ",
        "ระดับ, ค่าระดับ, ระดับความสูง, รทก", "ความสูง",
        "จุด, ชื่อจุด, จุดที่, หมายเลข, หมายเลขจุด, ลำดับ",
        "หมายเหตุ, รหัส, คำอธิบาย, รายละเอียด", "ลองจิจูด", "ละติจูด", "พิกัด, ค่าพิกัด",
    ),
}  # fmt: skip

LOOK_ALIKES = str.maketrans("ΧΥΖΕΝΗχυζХУЕНЗхун", "XYZENHxyzXYEHZxyh")
"""Greek and Cyrillic letters that stand alone for the Latin letters of coordinates."""
