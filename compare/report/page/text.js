"use strict";
// Small helpers: elements, and numbers as text.

/** An element with properties, then children (nodes or strings). Strings become text, never markup. */
function element(name, properties = {}, ...children) {
  const result = document.createElement(name);
  for (const [key, value] of Object.entries(properties)) {
    if (key in result) result[key] = value;
    else result.setAttribute(key, value);
  }
  result.append(...children);
  return result;
}

function byId(id) {
  return document.getElementById(id);
}

/** A float of 32 bits with as few digits as tell it from every other one. */
function floatText(value) {
  if (!Number.isFinite(value)) return Number.isNaN(value) ? "NaN" : value > 0 ? "infinity" : "-infinity";
  if (value === 0) return Object.is(value, -0) ? "-0" : "0";
  for (let digits = 1; digits < 9; ++digits) {
    const text = value.toPrecision(digits);
    if (Math.fround(Number(text)) === value) return plainText(text);
  }
  return plainText(value.toPrecision(9));
}

/** Without the zeros that toPrecision adds: "1.500e-7" is "1.5e-7". */
function plainText(text) {
  return String(Number(text));
}

/** Few digits, for sentences. */
function shortText(value) {
  return Number.isFinite(value) ? plainText(value.toPrecision(3)) : String(value);
}

function countText(count, singular, plural = singular + "s") {
  return `${count.toLocaleString("en")} ${count === 1 ? singular : plural}`;
}

function percentText(fraction) {
  return `${plainText((100 * fraction).toPrecision(7))} %`;
}

/** "max_abs" for people. */
function label(key) {
  return key.replaceAll("_", " ");
}
