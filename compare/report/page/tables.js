// The numbers of `tandem diff --json` as tables. A cell that shows one has its place in the JSON as data-key.

/** As people read it: six digits of numbers that are not whole. */
function valueWords(value) {
  if (value === null) return "none";
  if (Array.isArray(value)) return value.map(valueWords).join(", ");
  if (typeof value === "object") return JSON.stringify(value);
  return typeof value === "number" && !Number.isInteger(value) ? plainText(value.toPrecision(6)) : String(value);
}

/** The value, and in full where the pointer rests on it. */
function cell(key, value) {
  const text = valueWords(value);
  const result = element("td", {className: text.length > 24 ? "value long" : "value"}, text);
  const whole = typeof value === "object" ? JSON.stringify(value) : String(value);
  if (text !== whole && value !== null) result.title = whole;
  result.dataset.key = key;
  return result;
}

function table(head, rows, caption) {
  const parts = [];
  if (caption) parts.push(element("caption", {}, caption));
  if (head) parts.push(element("thead", {}, element("tr", {}, ...head.map((text) => element("th", {scope: "col"}, text)))));
  parts.push(element("tbody", {}, ...rows));
  return element("div", {className: "scroll"}, element("table", {}, ...parts));
}

function row(name, ...cells) {
  return element("tr", {}, element("th", {scope: "row"}, name), ...cells);
}

const isScalar = (value) => value === null || typeof value !== "object";
const isSimple = (value) => isScalar(value) || (Array.isArray(value) && value.every(isScalar));
const mostRows = 20;

/** Tables of whatever there is under a key: scalars, then what is nested. */
function anything(key, value) {
  if (isSimple(value)) return [table(null, [element("tr", {}, cell(key, value))])];
  if (Array.isArray(value)) return arrayTables(key, value);
  const entries = Object.entries(value);
  const simple = entries.filter(([, member]) => isSimple(member) && !isSentences(member));
  const result = simple.length === 0 ? [] : [table(null, simple.map(([name, member]) => row(label(name), cell(`${key}.${name}`, member))))];
  for (const [name, member] of entries) {
    if (isSentences(member)) {
      result.push(element("ul", {}, ...member.map((sentence) => element("li", {}, sentence))));
    } else if (!isSimple(member) && Object.keys(member).length > 0) {
      result.push(element("h3", {}, label(name)), ...anything(`${key}.${name}`, member));
    }
  }
  return result;
}

function isSentences(value) {
  return Array.isArray(value) && value.length > 0 && value.every((item) => typeof item === "string" && item.includes(" "));
}

/** Objects as the rows of one table. */
function arrayTables(key, items) {
  // A sentence has a row of its own, below the others.
  const isLong = (name) => items.some((item) => !isScalar(item) && typeof item[name] === "string" && item[name].length > 40);
  const all = [...new Set(items.flatMap((item) => (isScalar(item) ? [] : Object.keys(item))))];
  const names = all.filter((name) => !isLong(name));
  const rows = items.slice(0, mostRows).flatMap((item, i) => {
    if (isScalar(item)) return [element("tr", {}, cell(`${key}.${i}`, item))];
    const cells = names.map((name) => (name in item ? cell(`${key}.${i}.${name}`, item[name]) : element("td")));
    const sentences = all.filter((name) => isLong(name) && name in item).map((name) => {
      const sentence = cell(`${key}.${i}.${name}`, item[name]);
      sentence.colSpan = names.length;
      sentence.className = "sentence";
      return element("tr", {}, sentence);
    });
    return [element("tr", {className: sentences.length > 0 ? "above" : ""}, ...cells), ...sentences];
  });
  const rest = items.length - rows.length;
  const note = rest > 0 ? [element("p", {className: "hint"}, `${countText(rest, "more row")} in the JSON below.`)] : [];
  return [table(names.length > 0 ? names.map(label) : null, rows), ...note];
}

function addSection(title, children, className = "") {
  byId("report").append(element("section", {className, ariaLabel: title}, element("h2", {}, title), ...children));
}

/** What is said of each number; of a fraction also how many pixels it is. */
const metricRows = [
  ["bit_equal", "bit-equal", "pixels whose three channels have the same bits"],
  ["within_1e5", "within 1e-5", "pixels that agree to five digits in each channel"],
  ["within_1e3", "within 1e-3", "pixels that agree to three digits in each channel"],
  ["max_abs", "max |a − b|", "the largest difference of any channel"],
  ["mean_abs", "mean |a − b|", "over pixels and channels"],
  ["rmse", "RMSE", "root of the mean squared difference"],
  ["psnr", "PSNR", "dB; none when there is no difference"],
  ["peak", "peak", "the largest |value| of either image, which PSNR refers to"],
  ["mean_a", "mean of a", "over pixels and channels"],
  ["mean_b", "mean of b", "over pixels and channels"],
  ["non_finite_a", "non-finite in a", "pixels with a NaN or an infinity"],
  ["non_finite_b", "non-finite in b", "pixels with a NaN or an infinity"],
];
const detailedRows = [
  ["rel_mse", "relMSE", "mean of the squared relative difference"],
  ["ssim", "SSIM", "structural similarity, 1 when equal"],
  ["flip.mean", "FLIP, mean", "what an eye sees of the difference, 0 to 1"],
  ["flip.max", "FLIP, largest", "of any pixel"],
  ["hdr_flip.mean", "HDR-FLIP, mean", "the same over exposures"],
  ["hdr_flip.max", "HDR-FLIP, largest", "of any pixel"],
  ["relative_error.p50", "relative error, median", "half of all values differ by no more"],
  ["relative_error.p90", "relative error, 90 %", "90 % of all values differ by no more"],
  ["relative_error.p99", "relative error, 99 %", "99 % of all values differ by no more"],
  ["relative_error.p99_9", "relative error, 99.9 %", "99.9 % of all values differ by no more"],
  ["relative_error.max", "relative error, largest", "of any value"],
];

function at(value, path) {
  return path.split(".").reduce((inner, name) => inner?.[name], value);
}

function addMetrics(numbers) {
  const explained = (key, name, why) => {
    const value = at(numbers, key);
    const isFraction = ["bit_equal", "within_1e5", "within_1e3"].includes(key);
    const count = isFraction ? `${percentText(value)}: ${countText(Math.round(value * numbers.pixels), "pixel")}; ` : "";
    return row(name, cell(key, value), element("td", {}, count + why));
  };
  const rows = [row("pixels", cell("pixels", numbers.pixels), element("td", {}, "that were compared"))];
  for (const [key, name, why] of metricRows) rows.push(explained(key, name, why));
  for (const [key, name, why] of detailedRows)
    if (at(numbers.metrics, key) !== undefined) rows.push(explained(`metrics.${key}`, name, why));
  addSection("Metrics", [table(["", "value", ""], rows, "Of linear radiance; a is the reference.")]);
}

function addDevices(numbers) {
  const rows = [];
  const both = (name, keyA, keyB) => rows.push(row(name, cell(keyA, at(numbers, keyA)), cell(keyB, at(numbers, keyB))));
  for (const name of Object.keys(numbers.device_a)) both(label(name), `device_a.${name}`, `device_b.${name}`);
  both("rays are traced by", "trace_a", "trace_b");
  both("rendering, ms", "ms_a", "ms_b");
  both("building structures, ms", "build_ms_a", "build_ms_b");
  both("compiling shaders, ms", "compile_ms_a", "compile_ms_b");
  both("rays", "rays_a", "rays_b");
  both("millions of rays a second", "mrays_a", "mrays_b");
  addSection("Devices and time", [table(["", "a", "b"], rows)]);
}

function addThresholds(numbers) {
  const rows = Object.entries(numbers.thresholds).map(([name, rule]) =>
    row(label(name), cell(`thresholds.${name}.limit`, rule.limit), element("td", {}, rule.reason)));
  addSection("Rules of the verdict", [table(["metric", "limit", "reason"], rows, `Tier ${numbers.tier}.`)]);
}

/** Distances in ULP as columns on a logarithmic scale of counts. */
function histogram(bins) {
  const [width, height, left, bottom, top] = [720, 230, 8, 34, 24];
  const svg = (name, attributes, ...children) => {
    const node = document.createElementNS("http://www.w3.org/2000/svg", name);
    for (const [key, value] of Object.entries(attributes)) node.setAttribute(key, value);
    node.append(...children);
    return node;
  };
  const most = Math.log10(Math.max(...bins.map((bin) => bin.values)) + 1);
  const step = (width - 2 * left) / bins.length;
  const every = Math.ceil(bins.length / 14);
  const children = [svg("line", {x1: left, x2: width - left, y1: height - bottom, y2: height - bottom})];
  bins.forEach((bin, i) => {
    const range = bin.least === bin.most ? `${bin.least}` : `${bin.least} to ${bin.most}`;
    const size = bin.values === 0 ? 0 : Math.max((Math.log10(bin.values + 1) / most) * (height - bottom - top), 2);
    const x = left + i * step;
    children.push(svg("rect", {class: "column", x: x + 1, width: Math.max(step - 2, 1), y: height - bottom - size, height: size},
      svg("title", {}, `${countText(bin.values, "value")} ${range} ULP apart`)));
    const middle = {x: x + step / 2, "text-anchor": "middle"};
    if (i % every === 0) children.push(svg("text", {...middle, y: height - bottom + 15}, compactText(bin.least)));
    if (bin.values > 0 && bins.length <= 28) children.push(svg("text", {...middle, y: height - bottom - size - 5}, compactText(bin.values)));
  });
  children.push(svg("text", {x: width / 2, y: height - 3, "text-anchor": "middle"}, "units in the last place between a and b (the least of each column)"));
  return svg("svg", {class: "histogram", viewBox: `0 0 ${width} ${height}`, role: "img", "aria-label": "Histogram of distances in units in the last place; the table below has its numbers"}, ...children);
}

function compactText(count) {
  return count.toLocaleString("en", {notation: "compact"});
}

function addHistogram(numbers) {
  const {bins, largest} = numbers.metrics.ulp;
  if (bins.length === 0) return;
  const rows = bins.map((bin, i) => ({bin, i})).filter(({bin}) => bin.values > 0).map(({bin, i}) => element("tr", {},
    ...["least", "most", "values"].map((name) => cell(`metrics.ulp.bins.${i}.${name}`, bin[name]))));
  const details = element("details", {}, element("summary", {}, "As a table"), table(["from, ULP", "to, ULP", "values"], rows));
  addSection("How far values are apart", [element("p", {}, largest === 0
    ? "All finite values are equal."
    : `Counts are on a logarithmic scale. The largest distance is ${largest.toLocaleString("en")} ULP.`), histogram(bins), details]);
}

function addRegions(numbers, goToRegion) {
  const names = ["bit_equal", "rmse", "max_abs", "flip"].filter((name) => name in numbers.metrics.regions[0]);
  const rows = numbers.metrics.regions.map((region, i) => {
    const button = element("button", {type: "button"}, "Show");
    button.addEventListener("click", () => goToRegion(region));
    const place = `row ${region.row + 1}, column ${region.column + 1}`;
    button.setAttribute("aria-label", `Show ${place}`);
    const result = row(place, element("td", {}, `${region.x},${region.y} to ${region.x + region.width - 1},${region.y + region.height - 1}`),
      ...names.map((name) => cell(`metrics.regions.${i}.${name}`, region[name])), element("td", {}, button));
    if (i === numbers.metrics.worst_region) result.className = "changed";
    return result;
  });
  const caption = numbers.metrics.worst_region === null ? "All regions are bit-equal." : "The worst region is marked.";
  addSection("Regions", [table(["", "pixels", ...names.map(label), ""], rows, caption)], "wide");
}

/** What has its own table above, or stands at the top of the page. */
const shownElsewhere = new Set(["verdict", "tier", "reasons", "pixels", "thresholds", "metrics", "settings", "version", "date", "command", "format", "device_a", "device_b",
  ...metricRows.map(([key]) => key), ...["ms", "build_ms", "compile_ms", "rays", "mrays", "trace"].flatMap((name) => [`${name}_a`, `${name}_b`])]);

function showNumbers(numbers, goToRegion) {
  addMetrics(numbers);
  addDevices(numbers);
  if (numbers.metrics?.ulp) addHistogram(numbers);
  if (numbers.metrics?.regions?.length > 0) addRegions(numbers, goToRegion);
  for (const [key, value] of Object.entries(numbers)) {
    if (shownElsewhere.has(key) || value === null) continue;
    const title = label(key);
    addSection(title[0].toUpperCase() + title.slice(1), anything(key, value));
  }
  addThresholds(numbers);
  addSection("Settings", anything("settings", numbers.settings));
}
