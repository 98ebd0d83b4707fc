/** From the coordinates of a tileset, in doubles, to those of the page.
 *
 *  A tileset that lies on the globe (EPSG:4978) is shown by longitude, latitude and height above the
 *  ellipsoid, in metres of its middle as every surface in degrees is; any other as it stands, Z up.
 */

import type { Vector } from "../surface";

/** Column by column, 4 by 4. */
export type Matrix = readonly number[];

export const IDENTITY: Matrix = [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1];
export const MAJOR = 6_378_137;
const FLATTENING = 1 / 298.257223563;
export const SQUARED = FLATTENING * (2 - FLATTENING);
const MINOR = MAJOR * (1 - FLATTENING);
export const RADIANS = Math.PI / 180;
/** Distances from the middle of the Earth that are taken for places on the globe. */
const [LEAST_RADIUS, MOST_RADIUS] = [6_300_000, 6_500_000];

export function multiply(a: Matrix, b: Matrix): Matrix {
  const product = new Array<number>(16).fill(0);
  for (let column = 0; column < 4; column += 1)
    for (let row = 0; row < 4; row += 1)
      for (let k = 0; k < 4; k += 1) product[4 * column + row] += a[4 * k + row] * b[4 * column + k];
  return product;
}

export function transform(m: Matrix, [x, y, z]: Vector): Vector {
  return [
    m[0] * x + m[4] * y + m[8] * z + m[12],
    m[1] * x + m[5] * y + m[9] * z + m[13],
    m[2] * x + m[6] * y + m[10] * z + m[14],
  ];
}

/** Return longitude, latitude (degrees) and height above WGS 84 of a place in EPSG:4978.
 *  Bowring, "Transformation from spatial to geographical coordinates" (1976), with a second step. */
export function toGeodetic([x, y, z]: Vector): Vector {
  const across = Math.hypot(x, y);
  let reduced = Math.atan2(z * MAJOR, across * MINOR);
  let latitude = 0;
  for (let step = 0; step < 2; step += 1) {
    latitude = Math.atan2(
      z + ((MAJOR ** 2 - MINOR ** 2) / MINOR) * Math.sin(reduced) ** 3,
      across - SQUARED * MAJOR * Math.cos(reduced) ** 3,
    );
    reduced = Math.atan2(MINOR * Math.sin(latitude), MAJOR * Math.cos(latitude));
  }
  const [sine, cosine] = [Math.sin(latitude), Math.cos(latitude)];
  const height = across * cosine + z * sine - MAJOR * Math.sqrt(1 - SQUARED * sine * sine);
  return [Math.atan2(y, x) / RADIANS, latitude / RADIANS, height];
}

/** How places of a tileset become places of the page. */
export class Mapping {
  readonly origin: Vector;
  /** Metres in a unit of the origin's coordinates. */
  readonly scale: [number, number] = [1, 1];

  /** `middle` is that of the whole: on the globe in EPSG:4978, or as longitude, latitude, height. */
  constructor(
    middle: Vector,
    readonly isGlobe: boolean,
    isGeodetic = false,
  ) {
    const place = isGlobe && !isGeodetic ? toGeodetic(middle) : middle;
    const short = place.map((value, k) => Number(value.toFixed(isGlobe && k < 2 ? 6 : 1)));
    this.origin = short as Vector;
    if (!isGlobe) return;
    const sine = Math.sin(this.origin[1] * RADIANS);
    const bulge = 1 - SQUARED * sine * sine;
    const primeVertical = MAJOR / Math.sqrt(bulge);
    this.scale[0] = primeVertical * Math.cos(this.origin[1] * RADIANS) * RADIANS;
    this.scale[1] = ((primeVertical * (1 - SQUARED)) / bulge) * RADIANS;
  }

  /** Return that of a place on the globe, given by longitude, latitude and height. */
  static around(place: Vector): Mapping {
    return new Mapping(place, true, true);
  }

  place(point: Vector): Vector {
    const { origin, scale } = this;
    if (!this.isGlobe) return [point[0] - origin[0], point[1] - origin[1], point[2] - origin[2]];
    const [longitude, latitude, height] = toGeodetic(point);
    return this.placeGeodetic(longitude, latitude, height, scale);
  }

  placeGeodetic(longitude: number, latitude: number, height: number, scale = this.scale): Vector {
    const { origin } = this;
    let turn = longitude - origin[0];
    if (turn > 180) turn -= 360;
    else if (turn < -180) turn += 360;
    return [turn * scale[0], (latitude - origin[1]) * scale[1], height - origin[2]];
  }
}

/** Whether a place is at the distance of the ground from the middle of the Earth. */
export function isOnGlobe(place: Vector): boolean {
  const radius = Math.hypot(...place);
  return radius > LEAST_RADIUS && radius < MOST_RADIUS;
}
