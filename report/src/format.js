// Numbers with units for people: three or four digits and the prefix that fits, as the tables of the page have them.

const PREFIXES = [
  [1e9, "G"],
  [1e6, "M"],
  [1e3, "k"],
  [1, ""],
  [1e-3, "m"],
  [1e-6, "µ"],
  [1e-9, "n"],
];

/** Units that take no prefix. */
const BARE = new Set(["", "1", "%"]);

/** Factor and prefix of a unit for values of this size. */
export function prefix(size, unit) {
  const [first] = unit.split(/[ /]/);
  if (BARE.has(unit) || /[²³]/.test(first) || first === "kg" || !(size > 0) || !Number.isFinite(size)) return [1, ""];
  return PREFIXES.find(([factor]) => size >= 0.9999 * factor) ?? PREFIXES.at(-1);
}

/** A number with this many digits, without a long row of zeros. */
export function digits(value, count = 4) {
  if (value === 0) return "0";
  if (!Number.isFinite(value)) return "–";
  const size = Math.abs(value);
  if (size >= 1e5 || size < 1e-3) {
    const [mantissa, power] = value.toExponential(count - 1).split("e");
    return `${mantissa.replace(/\.?0+$/, "")}e${Number(power)}`.replace("-", "−");
  }
  const text = value.toPrecision(count);
  return (text.includes(".") ? text.replace(/\.?0+$/, "") : text).replace("-", "−");
}

/** A quantity with its unit. */
export function quantity(value, unit, count = 4) {
  if (value === null || value === undefined || !Number.isFinite(value)) return "–";
  const [factor, sign] = prefix(Math.abs(value), unit);
  return `${digits(value / factor, count)} ${sign}${unit}`.trim();
}
