// The values of one pixel on both devices, and the list of those that differ.

/** A table of both values of each channel. */
function pixelTable(pixels, names, pixel) {
  const index = pixel.y * pixels.width + pixel.x;
  const isExact = pixels.isExact(index);
  const rows = ["R", "G", "B"].map((channel, i) => {
    const at = 3 * index + i;
    const a = pixels.valuesA[at];
    const b = pixels.valuesB[at];
    const isEqual = pixels.wordsA[at] === pixels.wordsB[at];
    const text = isExact ? floatText : (value) => `≈ ${shortText(value)}`;
    const ulp = isExact ? ulpDistance(pixels.wordsA[at], pixels.wordsB[at]).toLocaleString("en") : "?";
    return element("tr", {className: isEqual ? "" : "changed"}, element("th", {scope: "row"}, channel),
      ...[text(a), text(b), ulp].map((value) => element("td", {className: "number"}, value)));
  });
  const head = ["", `a: ${names.a}`, `b: ${names.b}`, "ULP"].map((text) => element("th", {scope: "col"}, text));
  return element("div", {className: "scroll"}, element("table", {className: "pixel"},
    element("thead", {}, element("tr", {}, ...head)), element("tbody", {}, ...rows)));
}

function classBadge(name) {
  const swatch = element("span", {className: "swatch"});
  swatch.style.background = classTable[name].color;
  return element("span", {className: "badge"}, swatch, name);
}

/** Bit-equal, or what class of difference. */
function pixelState(pixels, pixel) {
  const index = pixel.y * pixels.width + pixel.x;
  if (pixels.classOf.has(index)) return classBadge(pixels.classOf.get(index) ?? unclassed);
  return element("span", {className: "badge"}, pixels.differs[index] ? "differs" : "bit-equal");
}

function showPointed(pixels, names, pixel) {
  const panel = byId("pointed");
  if (!pixel) {
    panel.replaceChildren(element("p", {className: "hint"}, "Point at a pixel to see its values on both devices."));
    return;
  }
  panel.replaceChildren(
    element("p", {}, element("strong", {}, `${pixel.x}, ${pixel.y} `), pixelState(pixels, pixel)),
    pixelTable(pixels, names, pixel));
}

/** For who cannot see the panel. */
function announce(pixels, pixel) {
  const index = pixel.y * pixels.width + pixel.x;
  const values = (all) => [0, 1, 2].map((i) => floatText(all[3 * index + i])).join(", ");
  byId("announcement").textContent =
    `Pixel ${pixel.x}, ${pixel.y}: a ${values(pixels.valuesA)}; b ${values(pixels.valuesB)}`;
}

/** The classes with their counts, each of which can be left out. onChange is called when that changes. */
function showClasses(data, pixels, shown, onChange) {
  const counts = new Map();
  for (const {class: name} of pixels.ranked) counts.set(name ?? unclassed, (counts.get(name ?? unclassed) ?? 0) + 1);
  const classification = data.classification;
  if (classification) {
    for (const [name, count] of Object.entries(classification.pixels)) counts.set(name, Math.max(count, counts.get(name) ?? 0));
    counts.set(unclassed, data.differing_pixels - classification.classed_pixels);
  } else {
    counts.set(unclassed, data.differing_pixels);
  }
  for (const name of Object.keys(classTable)) {
    const count = counts.get(name) ?? 0;
    if (!classification && name !== unclassed) continue;
    if (classification && name === unclassed && count === 0) continue;
    const box = element("input", {type: "checkbox", checked: true, id: `class-${name.replaceAll(" ", "-")}`});
    box.addEventListener("change", () => {
      if (box.checked) shown.add(name);
      else shown.delete(name);
      onChange();
    });
    const swatch = element("span", {className: "swatch"});
    swatch.style.background = classTable[name].color;
    byId("classes").append(element("li", {className: count === 0 ? "none" : ""}, box,
      element("label", {htmlFor: box.id}, swatch, `${name} `, element("span", {className: "count"}, count.toLocaleString("en"))),
      element("p", {className: "why"}, classTable[name].why)));
  }
}

/** "17 of 262,144 pixels do not have the same bits", and what is not listed of them. */
function differingSentence(data, pixels) {
  const all = pixels.width * pixels.height;
  let text = `${data.differing_pixels.toLocaleString("en")} of ${countText(all, "pixel")} ` +
    `${data.differing_pixels === 1 ? "does" : "do"} not have the same bits.`;
  if (pixels.ranked.length < data.differing_pixels)
    text += ` The ${pixels.ranked.length.toLocaleString("en")} that matter most are ringed and listed.`;
  if (data.classification?.surveyed_pixels)
    text += ` Paths of ${countText(data.classification.surveyed_pixels, "other pixel")} all over the picture were compared too.`;
  return text;
}

/** What to look at first, in a sentence. */
function lookSentence(data, pixels, names) {
  const first = pixels.ranked[0];
  if (!first) {
    return data.classification
      ? "Nowhere: every pixel has the same bits on both devices, and the paths that were compared agree in all that a result depends on."
      : "Nowhere: every pixel has the same bits on both devices.";
  }
  const x = first.index % pixels.width;
  const y = Math.floor(first.index / pixels.width);
  let sentence = `At pixel ${x}, ${y}. `;
  if (!pixels.differs[first.index]) {
    sentence += "It has the same bits on both devices, but its path has not";
  } else {
    const [channel, a, b] = largestChannel(pixels, first.index);
    const relative = Math.abs(a - b) / Math.max(Math.abs(a), Math.abs(b));
    const apart = Number.isFinite(relative) ? `, ${shortText(100 * relative)} % apart` : "";
    const isOnly = pixels.ranked.length === 1;
    const rank = isOnly ? "the only pixel that differs" : `the largest difference${first.class ? " of its class" : ""}`;
    sentence += `Its ${channel} is ${floatText(a)} on ${names.a} and ${floatText(b)} on ${names.b}${apart}: ${rank}`;
  }
  if (first.class === "mismatch") return `${sentence}. No rounding explains it: one of the devices is wrong.`;
  return first.class ? `${sentence}. Class: ${first.class}. ${classTable[first.class].why}` : `${sentence}.`;
}

function largestChannel(pixels, index) {
  let largest = null;
  ["red", "green", "blue"].forEach((channel, i) => {
    const a = pixels.valuesA[3 * index + i];
    const b = pixels.valuesB[3 * index + i];
    const difference = Number.isFinite(a) && Number.isFinite(b) ? Math.abs(a - b) : Infinity;
    const isEqual = pixels.wordsA[3 * index + i] === pixels.wordsB[3 * index + i];
    if (!isEqual && (!largest || difference > largest[3])) largest = [channel, a, b, difference];
  });
  return largest ?? ["red", pixels.valuesA[3 * index], pixels.valuesB[3 * index], 0];
}
