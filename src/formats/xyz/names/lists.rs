//! The words that names of columns are made of, in lower case and without accents, between blanks.

/// Words for an axis: x, y and z, then east and north, then longitude and latitude.
pub(super) const ACROSS: [[&str; 2]; 3] = [
    ["x", "y"],
    [
        "e east easting eastings est ost oost aust ostwert rechtswert rechts estx utme este leste wschod \
         vychod dogu kelet восток 东 東 东坐标 東坐標",
        "n north northing northings nord noord norr nordwert hochwert hoch utmn norte polnoc sever kuzey eszak \
         север 北 北坐标 北坐標",
    ],
    [
        "lon long lng longitude laenge laengengrad lange langengrad longitud longitudine lengte lengtegraad \
         долгота 经度 經度 経度",
        "lat latitude breite breitengrad latitud latitudine breedte breedtegraad широта 纬度 緯度",
    ],
];
/// Of heights the first line comes first; depths come last.
pub(super) const UP: [&str; 4] = [
    "z",
    "elevation elev height hgt altitude alt hoehe hohe hauteur altitud cote ellipsoidalheight \
     orthometricheight ellipsoidischehoehe level rl quota altura cota kot kote hoogte hojde hoyde hojd vyska \
     wysokosc rzedna korkeus yukseklik magassag elevacion elevacao altezza altitudine msl hae nap nhn ngf \
     высота отметка 高程 高度 标高 標高 高さ",
    "h u up",
    "depth tiefe profondeur profundidad profundidade diepte dybde djup",
];
pub(super) const NORMAL: [&str; 3] = ["nx vnx", "ny vny", "nz vnz"];
pub(super) const COLOR: [&str; 3] = [
    "r red rouge rot rojo rosso rf rood vermelho rod czerwony cervena красный 红 赤",
    "g green vert gruen grun verde gf groen gron zielony zelena зеленый 绿 緑",
    "b blue bleu blau azul blu bf blauw bla niebieski modra синий 蓝 青",
];
pub(super) const PACKED: &str =
    "rgb rgba argb color colour couleur farbe hex rgbhex hexcolor packedrgb rgbpacked";
/// Words that say nothing beside those of an axis.
pub(super) const BESIDE: &str = "coord coords coordinate coordinates koordinate coordonnee pos position point pt utm lambert l93 wgs84 deg \
    dd value wert m mm cm ft in gps";
pub(super) const BESIDE_COLOR: &str = "diffuse color colour farbe couleur rgb channel kanal camera";
/// Names of arrays of three, whose components are numbered or lettered.
pub(super) const PLACES: &str = "points point pointsmxyz xyz coords coord coordinates coordinate position positions pos location p vertex \
    vertices koordinate koordinaten";
pub(super) const NORMALS: &str = "normals normal norm n normale normalen vn";
pub(super) const COLORS: &str = "colors color colours colour rgb rgba rgbacolor farbe";
/// Beside one of these a word is no axis, and no channel of a colour, of a point.
pub(super) const UNLIKE: &str = "velocity vel speed v acceleration acc accel linear angular rotation rot orientation quaternion quat q \
    euler gyro mag magnetic force scale size width length normal normals norm direction dir sigma std stddev \
    sd var variance error err rms rmse accuracy precision uncertainty cov count index idx row col column \
    pixel px image img uv uvw texture tex min max";

/// Whether a list has a word.
pub(super) fn is_in(list: &str, word: &str) -> bool {
    list.split(' ').any(|own| own == word)
}
