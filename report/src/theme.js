// Colours of the page, from the variables of its style, which follow the light or dark theme of the reader.

const NAMES = ["first", "second", "third", "fourth", "fifth", "sixth", "seventh", "eighth", "ninth", "tenth", "eleventh", "twelfth"];

/** A colour of the style by the name of its variable. */
export function colour(name) {
  return getComputedStyle(document.documentElement).getPropertyValue(`--${name}`).trim();
}

/** The colour of a curve, a body or a zone by its number. */
export function series(number) {
  return colour(NAMES[number % NAMES.length]);
}

/** Calls when the theme changes. */
export function onTheme(changed) {
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", changed);
}
