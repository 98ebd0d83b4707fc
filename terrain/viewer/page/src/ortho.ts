/** The picture that is draped over the surfaces. */

import { LinearFilter, LinearMipmapLinearFilter, SRGBColorSpace, Texture } from "three";

import type { OrthoData } from "./payload";
import { decodeBase64 } from "./unpacking";

export async function decodeOrtho(data: OrthoData): Promise<ImageBitmap> {
  const file = new Blob([decodeBase64(data.data)], { type: `image/${data.kind}` });
  return createImageBitmap(file, { imageOrientation: "none", premultiplyAlpha: "premultiply" });
}

/** Return a texture whose first row is the upper one, its colours multiplied by their opacity. */
export function makeOrthoTexture(picture: ImageBitmap, anisotropy: number): Texture {
  const texture = new Texture(picture);
  Object.assign(texture, {
    flipY: false,
    premultiplyAlpha: true,
    colorSpace: SRGBColorSpace,
    minFilter: LinearMipmapLinearFilter,
    magFilter: LinearFilter,
    anisotropy,
    needsUpdate: true,
  });
  return texture;
}
