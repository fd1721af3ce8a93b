// Colour maps: viridis for magnitudes (Smith and van der Walt, CC0), blue over grey to red for signed values.

import { DataTexture, LinearFilter, RGBAFormat, SRGBColorSpace } from "three";

const VIRIDIS = ["440154", "482878", "3e4989", "31688e", "26828e", "1f9e89", "35b779", "6ece58", "b5de2b", "fde725"];
const DIVERGING = ["2166ac", "4393c3", "92c5de", "d1e5f0", "e8e8e8", "fddbc7", "f4a582", "d6604d", "b2182b"];

const rgb = (hex) => [0, 2, 4].map((at) => parseInt(hex.slice(at, at + 2), 16));
const STOPS = { magnitude: VIRIDIS.map(rgb), signed: DIVERGING.map(rgb) };

/** Red, green, blue from 0 to 255 at a part from 0 to 1 of a map. */
export function shade(map, part) {
  const stops = STOPS[map];
  const place = Math.min(Math.max(part, 0), 1) * (stops.length - 1);
  const k = Math.min(Math.floor(place), stops.length - 2);
  return stops[k].map((c, i) => c + (place - k) * (stops[k + 1][i] - c));
}

/** A map as a style of CSS, from its lowest value at the left. */
export function gradient(map) {
  const stops = STOPS[map].map((c) => `rgb(${c.join(",")})`);
  return `linear-gradient(to right, ${stops.join(",")})`;
}

/** A map as a texture. */
export function texture(map) {
  const data = new Uint8Array(256 * 4);
  for (let k = 0; k < 256; k += 1) data.set([...shade(map, k / 255), 255], 4 * k);
  const made = new DataTexture(data, 256, 1, RGBAFormat);
  made.colorSpace = SRGBColorSpace;
  made.minFilter = LinearFilter;
  made.magFilter = LinearFilter;
  made.needsUpdate = true;
  return made;
}
