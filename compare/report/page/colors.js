// From numbers to colours: the images, the maps of their error, the classes.

const unclassed = "not classed";

/** What each class is drawn in, and means. The worst first. Colours differ in lightness too, for the colour-blind. */
const classTable = {
  "mismatch": {
    color: "#ff3b30",
    why: "None of the reasons below: one of the devices is wrong. Look at these first.",
  },
  "coincident geometry": {
    color: "#d891c0",
    why: "Two primitives lie at the same distance, and the devices report different ones. The scene leaves the choice open.",
  },
  "flipped decision": {
    color: "#f0a020",
    why: "A random choice lies within rounding of its threshold, and the devices decide differently; then the paths diverge. Harmless.",
  },
  "grazing visibility": {
    color: "#f4e84a",
    why: "A shadow ray grazes an occluder within rounding. Harmless.",
  },
  "edge or vertex tie": {
    color: "#2fc28d",
    why: "A ray passes an edge or a vertex so closely that either of the primitives there is right. Harmless.",
  },
  "rounding": {
    color: "#6db9f2",
    why: "The last digits of a value differ, but decide nothing. Harmless.",
  },
  [unclassed]: {
    color: "#b9bec6",
    why: "The paths of these pixels were not compared; --classify compares up to --classify-pixels of them.",
  },
};

const encodeSteps = 16384;
const encodeTable = Uint8Array.from({length: encodeSteps + 1}, (_, i) => {
  const linear = i / encodeSteps;
  return Math.round(255 * (linear <= 0.0031308 ? 12.92 * linear : 1.055 * linear ** (1 / 2.4) - 0.055));
});

/** sRGB (IEC 61966-2-1) of linear radiance, clamped; NaN is black. */
function encoded(linear) {
  return linear >= 1 ? 255 : linear > 0 ? encodeTable[Math.round(linear * encodeSteps)] : 0;
}

function makeCanvas(width, height, fill) {
  const canvas = element("canvas", {width, height});
  const context = canvas.getContext("2d");
  const image = context.createImageData(width, height);
  fill(image.data);
  context.putImageData(image, 0, 0);
  return canvas;
}

function imageCanvas(pixels, values, exposure) {
  const factor = 2 ** exposure;
  return makeCanvas(pixels.width, pixels.height, (bytes) => {
    for (let from = 0, to = 0; from < values.length; from += 3, to += 4) {
      bytes[to] = encoded(values[from] * factor);
      bytes[to + 1] = encoded(values[from + 1] * factor);
      bytes[to + 2] = encoded(values[from + 2] * factor);
      bytes[to + 3] = 255;
    }
  });
}

const heatStops = ["#050528", "#0033e0", "#00b3c8", "#22d022", "#ffe600", "#ff2a00", "#ffffff"];
const flipStops = ["#000004", "#3b0f70", "#8c2981", "#de4968", "#fe9f6d", "#fcfdbf"];
const notFinite = [255, 0, 255];

function rgb(hex) {
  return [1, 3, 5].map((at) => parseInt(hex.slice(at, at + 2), 16));
}

/** Colours between stops, at 0 to 1. */
function rampOf(stops) {
  const colors = stops.map(rgb);
  return (position) => {
    const place = Math.min(Math.max(position, 0), 1) * (colors.length - 1);
    const below = Math.min(Math.floor(place), colors.length - 2);
    return colors[below].map((value, i) => value + (place - below) * (colors[below + 1][i] - value));
  };
}

/** Error maps. position(pixels, index): where in the ramp, null for no difference, NaN where it is no number. */
const errorKinds = {
  absolute: {
    stops: heatStops,
    ticks: ["≤ 1e-6", "1e-5", "1e-4", "1e-3", "1e-2", "0.1", "≥ 1"],
    position: (pixels, index) => {
      const largest = largestOf(pixels, index, (a, b) => Math.abs(a - b));
      return largest === 0 ? null : (Math.log10(largest) + 6) / 6;
    },
  },
  relative: {
    stops: heatStops,
    ticks: ["≤ 1e-6", "1e-5", "1e-4", "1e-3", "1e-2", "0.1", "1"],
    position: (pixels, index) => {
      const largest = largestOf(pixels, index, (a, b) => (a === b ? 0 : Math.abs(a - b) / Math.max(Math.abs(a), Math.abs(b))));
      return largest === 0 ? null : (Math.log10(largest) + 6) / 6;
    },
  },
  ulp: {
    stops: heatStops,
    ticks: ["1", "16", "256", "4,096", "65,536", "1,048,576", "≥ 16,777,216"],
    position: (pixels, index) => {
      const largest = largestUlp(pixels, index);
      return largest === 0 ? null : Math.log2(largest) / 24;
    },
  },
  flip: {
    stops: flipStops,
    ticks: ["0", "0.2", "0.4", "0.6", "0.8", "1"],
    position: (pixels, index) => pixels.flip[index] / 255,
  },
};

function largestOf(pixels, index, difference) {
  let largest = 0;
  for (let at = 3 * index; at < 3 * index + 3; ++at) {
    const value = difference(pixels.valuesA[at], pixels.valuesB[at]);
    if (!Number.isFinite(value) || !Number.isFinite(pixels.valuesA[at])) return NaN;
    largest = Math.max(largest, value);
  }
  return largest;
}

function largestUlp(pixels, index) {
  let largest = 0;
  for (let at = 3 * index; at < 3 * index + 3; ++at)
    largest = Math.max(largest, ulpDistance(pixels.wordsA[at], pixels.wordsB[at]));
  return largest;
}

function errorCanvas(pixels, kind) {
  const {stops, position} = errorKinds[kind];
  const ramp = rampOf(stops);
  return makeCanvas(pixels.width, pixels.height, (bytes) => {
    for (let index = 0; index < pixels.width * pixels.height; ++index) {
      const place = position(pixels, index);
      const color = place === null ? [0, 0, 0] : Number.isNaN(place) ? notFinite : ramp(place);
      for (let i = 0; i < 3; ++i) bytes[4 * index + i] = color[i];
      bytes[4 * index + 3] = 255;
    }
  });
}

/** Pixels that differ in the colour of their class, on a faint grey image of a. */
function classCanvas(pixels, isShown, exposure) {
  const factor = 2 ** exposure;
  return makeCanvas(pixels.width, pixels.height, (bytes) => {
    for (let index = 0; index < pixels.width * pixels.height; ++index) {
      const [r, g, b] = pixels.valuesA.subarray(3 * index, 3 * index + 3);
      const grey = 12 + 0.3 * encoded((0.2126 * r + 0.7152 * g + 0.0722 * b) * factor);
      const name = pixels.classOf.get(index) ?? unclassed;
      const differs = pixels.differs[index] || pixels.classOf.has(index);
      const color = differs && isShown(name) ? rgb(classTable[name].color) : [grey, grey, grey];
      for (let i = 0; i < 3; ++i) bytes[4 * index + i] = color[i];
      bytes[4 * index + 3] = 255;
    }
  });
}
