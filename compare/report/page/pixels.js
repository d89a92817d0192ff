// The two images, to the last bit where the page has them so, and the list of pixels worth a look.

/** What C++ has packed: zlib in base64. */
async function unpacked(text) {
  const characters = atob(text);
  const bytes = new Uint8Array(characters.length);
  for (let i = 0; i < characters.length; ++i) bytes[i] = characters.charCodeAt(i);
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("deflate"));
  return new Uint8Array(await new Response(stream).arrayBuffer());
}

async function unpackedJson(text) {
  return JSON.parse(new TextDecoder().decode(await unpacked(text)));
}

async function unpackedWords(text) {
  return new Uint32Array((await unpacked(text)).buffer);
}

/** Words of red, green and blue of each pixel from planes of bytes, see compare/report/packed_images.hpp. */
function wordsFromPlanes(planes, count, bytes) {
  const words = new Uint32Array(3 * count);
  let next = 0;
  for (let byte = 0; byte < bytes; ++byte) {
    const shift = 24 - 8 * byte;
    for (let channel = 0; channel < 3; ++channel)
      for (let at = channel; at < words.length; at += 3) words[at] |= planes[next++] << shift;
  }
  return words;
}

/** The place of a float in the order of all floats: neighbours differ by 1, both zeros are at 0. */
function ordinal(bits) {
  const magnitude = bits & 0x7fffffff;
  return bits >>> 31 ? -magnitude : magnitude;
}

function ulpDistance(bitsA, bitsB) {
  return Math.abs(ordinal(bitsA) - ordinal(bitsB));
}

/**
 * width, height; wordsA, wordsB and valuesA, valuesB: three for each pixel; differs: 1 for each pixel that is not
 * bit-equal; ranked: {index, class} in the order in which to look at them, class null when there is none; flip: errors
 * of 255, or null; isExact(index): whether the values are those of the images to the last bit.
 */
async function loadPixels(data) {
  const count = data.width * data.height;
  const wordsA = wordsFromPlanes(await unpacked(data.a), count, data.bytes);
  const wordsB = wordsFromPlanes(await unpacked(data.exclusive_or), count, data.bytes);
  for (let i = 0; i < wordsB.length; ++i) wordsB[i] ^= wordsA[i];
  const indices = await unpackedWords(data.ranked);
  const classes = await unpacked(data.ranked_classes);
  const ranked = Array.from(indices, (index, i) => ({index, class: data.classes[classes[i]] ?? null}));
  const exact = new Set();
  if (data.ranked_values) {
    const values = await unpackedWords(data.ranked_values);
    ranked.forEach(({index}, i) => {
      exact.add(index);
      for (let channel = 0; channel < 3; ++channel) {
        wordsA[3 * index + channel] = values[6 * i + channel];
        wordsB[3 * index + channel] = values[6 * i + 3 + channel];
      }
    });
  }
  return {
    width: data.width,
    height: data.height,
    wordsA,
    wordsB,
    valuesA: new Float32Array(wordsA.buffer),
    valuesB: new Float32Array(wordsB.buffer),
    differs: await unpacked(data.differs),
    ranked,
    classOf: new Map(ranked.map((pixel) => [pixel.index, pixel.class])),
    flip: data.flip ? await unpacked(data.flip) : null,
    isExact: (index) => data.bytes === 4 || exact.has(index),
  };
}
