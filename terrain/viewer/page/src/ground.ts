/** How long a unit of the page's coordinates is: the same everywhere, but for degrees. */

import type { Payload } from "./payload";

export type Factors = [east: number, north: number];

/** Return factors from lengths on the page at a northing (of the page) to lengths on the ground.
 *  Degrees of longitude get shorter towards the poles; the page draws them as in its middle. */
export function makeGround(payload: Payload): (y: number) => Factors {
  const { ellipsoid, origin, scale } = payload;
  if (ellipsoid === null) return () => [1, 1];
  const [major, squared, radians] = ellipsoid;
  return (y) => {
    const latitude = (y / scale[1] + origin[1]) * radians;
    const bulge = 1 - squared * Math.sin(latitude) ** 2;
    const primeVertical = major / Math.sqrt(bulge);
    const meridian = (primeVertical * (1 - squared)) / bulge;
    return [
      (primeVertical * Math.cos(latitude) * radians) / scale[0],
      (meridian * radians) / scale[1],
    ];
  };
}
