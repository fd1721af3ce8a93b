// The data of the page: a JSON head, and one block of compressed arrays that it refers to. The layout is documented in
// crates/pages/src/page/schema.rs.

export const SCHEMA = 4;

/** The head of the page; null on a page that has none. */
export function head() {
  const element = document.getElementById("carom-page");
  return element ? JSON.parse(element.textContent) : null;
}

/** The uncompressed block of arrays. */
export async function block() {
  const element = document.getElementById("carom-data");
  const text = atob(element.textContent.trim());
  const bytes = Uint8Array.from(text, (c) => c.charCodeAt(0));
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("deflate-raw"));
  return new Uint8Array(await new Response(stream).arrayBuffer());
}

const SIZES = { f32: 4, u32: 4, u16: 2, u8: 1 };

/** Bytes in planes, the lowest first, joined to unsigned numbers; of integers the sums of differences. */
function words(bytes, array, size) {
  const { at, count } = array;
  const out = size === 4 ? new Uint32Array(count) : size === 2 ? new Uint16Array(count) : new Uint8Array(count);
  for (let plane = 0; plane < size; plane += 1) {
    const from = at + plane * count;
    for (let k = 0; k < count; k += 1) out[k] |= bytes[from + k] << (8 * plane);
  }
  if (array.type === "f32") return new Float32Array(out.buffer);
  if (array.type === "u8") return out;
  for (let k = 1; k < count; k += 1) out[k] += out[k - 1];
  return out;
}

/** An array of the block as typed numbers; one with a range as floats in it. */
export function numbers(bytes, array) {
  const found = words(bytes, array, SIZES[array.type]);
  if (array.low === undefined) return found;
  const step = (array.high - array.low) / array.most;
  return Float32Array.from(found, (q) => array.low + q * step);
}
