/** What the page is given: one JSON text with numbers packed as bytes. */

/** Whole numbers, as differences in zigzag coding, by planes of bytes, deflated, in base64. */
export interface Packed {
  /** Rows. */
  rows: number;
  /** Numbers in a row. */
  columns: number;
  /** Bytes of a number that are given; those above are zero. */
  planes: number;
  data: string;
}

/** Polylines: vertices one after the other, and the number of vertices of each. */
export interface PackedLines {
  vertices: Packed;
  counts: Packed;
}

export interface LineLayer {
  kind: string;
  title: string;
  color: string;
  dashed: boolean;
  width: number;
  lines: PackedLines;
}

export interface LabelLayer {
  title: string;
  places: Packed;
  texts: string[];
}

export interface SurfaceData {
  name: string;
  /** Size of one step of the numbers: of easting and northing, of elevation. */
  step: [number, number];
  vertices: Packed;
  triangles: Packed;
  /** Cut (below 0) and fill (above 0) at the vertices, in steps of elevation. */
  difference: Packed | null;
  lines: LineLayer[];
  labels: LabelLayer | null;
}

export interface UnitNames {
  horizontal: string;
  elevation: string;
}

/** A picture of the ground. */
export interface OrthoData {
  kind: "jpeg" | "png" | "webp";
  /** Whether it covers every vertex of the surfaces. */
  isWhole: boolean;
  /** Affine: from x and y of the page to the place from the left and from the top, 0 to 1. */
  place: [number, number, number, number, number, number];
  /** The file in base64. */
  data: string;
}

/** Colours of a theme. */
export interface ThemeColors {
  ground: string;
  ink: string;
  halo: string;
  curves: string[];
}

export interface Colors {
  themes: { light: ThemeColors; dark: ThemeColors };
  plain: string;
  contours: string;
  /** Edges of triangles, and points. */
  objects: string;
  measured: string;
}

/** A tileset beside the page. */
export interface TilesetData {
  /** Address of its JSON from the page. */
  address: string;
}

export interface Payload {
  colors: Colors;
  title: string;
  subtitle: string;
  /** What is to be told of the data. */
  notes: string;
  crs: string;
  units: UnitNames;
  /** What elevations are called. */
  elevationName: string;
  /** Easting, northing and elevation of the numbers 0, 0, 0 of all surfaces. */
  origin: [number, number, number];
  /** Units on the ground in one unit of easting and of northing. */
  scale: [number, number];
  /** How coordinates to the east and the north are written: by which name, and factor, 1 or -1. */
  axes: [[string, number], [string, number]];
  /** Whether eastings and northings are longitudes and latitudes. */
  geographic: boolean;
  /** Its half axis in metres, squared eccentricity, and radians of a unit; null on a map. */
  ellipsoid: [number, number, number] | null;
  /** Digits after the point: of eastings and northings, of elevations. */
  decimals: [number, number];
  /** Horizontal units in one unit of elevation. */
  elevationScale: number;
  exaggeration: number;
  /** Lowest and highest elevation of the tints. */
  elevations: [number, number];
  /** Lowest and highest but for those far off all others. */
  relief: [number, number];
  /** Colours and interval of contours (0: none) at the start. */
  tint: "elevation" | "slope" | "aspect" | "plain";
  interval: number;
  ramps: Record<"elevation" | "slope" | "aspect" | "difference", string[]>;
  /** How cut and fill were computed, in words. */
  basis: string;
  ortho: OrthoData | null;
  surfaces: SurfaceData[];
  /** In place of surfaces: then what is told of places is found when it is opened. */
  tileset: TilesetData | null;
}

/** Read the payload out of the page. */
export function readPayload(id: string): Payload {
  const element = document.getElementById(id);
  if (element === null) throw new Error(`the page has no element '${id}'`);
  return JSON.parse(element.textContent ?? "") as Payload;
}
