// Starts the page: puts the parts together, and says what keys and controls do.

function showHead(numbers, data, pixels, names) {
  const {settings} = numbers;
  byId("title").textContent = settings.scene;
  byId("subtitle").textContent = `${names.a} (a) against ${names.b} (b) · ${settings.width} × ${settings.height} pixels, ` +
    `${countText(settings.spp, "sample")} each, up to ${settings.depth} segments · tandem ${numbers.version}`;
  if (numbers.date) byId("run").append(`Run ${numbers.date}`, ...(numbers.command ? [": ", element("code", {}, numbers.command)] : []));
  byId("made").textContent = "This page is one file: it loads nothing and sends nothing.";
  const card = byId("verdict");
  card.classList.add(numbers.verdict);
  const words = {agree: "agree", explained: "differ for reasons that the scene owns", differ: "differ"};
  byId("verdict-sentence").append("The images ", element("strong", {className: "word"}, words[numbers.verdict]),
    `, in tier ${numbers.tier}: ${tierSentences[numbers.tier] ?? ""} ` +
    `${percentText(numbers.bit_equal)} of the pixels have the same bits.`);
  byId("verdict-reasons").append(...numbers.reasons.map((reason) => element("li", {}, reason)));
  byId("look-sentence").textContent = lookSentence(data, pixels, names);
  byId("look-button").hidden = pixels.ranked.length === 0;
  byId("differing").textContent = differingSentence(data, pixels);
  if (data.bytes < 4) {
    byId("precision").textContent = `The images are too large to be in this page to the last bit: values are shown to ${data.bytes === 3 ? 5 : 3} digits ` +
      `(≈) but at the ${countText(pixels.ranked.length, "pixel")} listed, where they are exact.`;
  }
}

const tierSentences = {
  exact: "every pixel must have the same bits.",
  tolerance: "the same picture but for rounding, and the few paths that rounding sends elsewhere.",
  statistical: "the same picture but for noise.",
};

function connectControls(viewer, pixels, data, shown) {
  const {view} = viewer;
  for (const [mode, name] of modes) {
    const input = element("input", {type: "radio", name: "mode", value: mode, id: `mode-${mode}`});
    input.addEventListener("change", () => viewer.setMode(mode));
    byId("modes").append(element("label", {htmlFor: input.id}, input, name));
  }
  const number = (id, change) => byId(id).addEventListener("input", (event) => change(Number(event.target.value)));
  number("exposure", (exposure) => viewer.set({exposure}));
  number("flicker-rate", (rate) => viewer.set({rate}));
  number("split", (percent) => viewer.set({split: percent / 100}));
  byId("error-kind").addEventListener("change", (event) => viewer.set({error: event.target.value}));
  byId("flicker-pause").addEventListener("click", () => viewer.set({paused: !view.paused}));
  byId("marks").addEventListener("change", (event) => viewer.set({marks: event.target.checked}));
  byId("zoom-in").addEventListener("click", () => viewer.zoom(1.5));
  byId("zoom-out").addEventListener("click", () => viewer.zoom(1 / 1.5));
  byId("zoom-fit").addEventListener("click", viewer.fit);
  byId("zoom-one").addEventListener("click", viewer.one);
  if (!pixels.flip) byId("error-kind").querySelector('[value="flip"]').remove();

  const listed = () => pixels.ranked.filter((pixel) => shown.has(pixel.class ?? unclassed));
  const placeOf = ({index}) => ({x: index % pixels.width, y: Math.floor(index / pixels.width)});
  const positionIn = (list) => list.findIndex((pixel) => {
    const place = placeOf(pixel);
    return place.x === view.selected?.x && place.y === view.selected?.y;
  });
  const showPosition = () => {
    const list = listed();
    const position = positionIn(list);
    byId("position").textContent = list.length === 0 ? "none" : position < 0 ? `of ${list.length.toLocaleString("en")}`
      : `${(position + 1).toLocaleString("en")} of ${list.length.toLocaleString("en")}`;
    byId("previous").disabled = byId("next").disabled = list.length === 0;
  };
  const show = (pixel) => {
    viewer.goTo(pixel, 14);
    viewer.select(pixel);
    announce(pixels, pixel);
  };
  const step = (by) => {
    const list = listed();
    if (list.length === 0) return;
    const position = positionIn(list);
    const next = position < 0 ? (by > 0 ? 0 : list.length - 1) : (position + by + list.length) % list.length;
    show(placeOf(list[next]));
  };
  byId("previous").addEventListener("click", () => step(-1));
  byId("next").addEventListener("click", () => step(1));
  byId("look-button").addEventListener("click", () => {
    show(placeOf(pixels.ranked[0]));
    byId("viewer").scrollIntoView({block: "start"});
    byId("stage").focus({preventScroll: true});
  });
  showClasses(data, pixels, shown, () => {
    viewer.forgetClasses();
    showPosition();
  });
  connectKeys(viewer, step, pixels);
  return {showPosition};
}

function connectKeys(viewer, step, pixels) {
  const actions = {
    "a": () => viewer.setMode("a"),
    "b": () => viewer.setMode("b"),
    "f": () => viewer.setMode("flicker"),
    "s": () => viewer.setMode("slider"),
    "d": () => viewer.setMode("sides"),
    "e": () => viewer.setMode("error"),
    "c": () => viewer.setMode("classes"),
    "n": () => step(1),
    "p": () => step(-1),
    "+": () => viewer.zoom(1.5),
    "=": () => viewer.zoom(1.5),
    "-": () => viewer.zoom(1 / 1.5),
    "0": viewer.fit,
    "1": viewer.one,
  };
  const stageActions = {
    " ": () => viewer.swap(),
    "Enter": () => viewer.view.pointed && viewer.select(viewer.view.pointed),
    "ArrowLeft": (far) => viewer.movePointed(-far, 0),
    "ArrowRight": (far) => viewer.movePointed(far, 0),
    "ArrowUp": (far) => viewer.movePointed(0, -far),
    "ArrowDown": (far) => viewer.movePointed(0, far),
  };
  document.addEventListener("keydown", (event) => {
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    if (event.target.matches?.("select, input[type=text]")) return;
    const onStage = event.target === byId("stage");
    const isFree = onStage || event.target === document.body;
    const action = (onStage && stageActions[event.key]) || (isFree && event.key === " " && stageActions[" "]) || actions[event.key.toLowerCase()];
    if (!action) return;
    event.preventDefault();
    action(event.shiftKey ? 10 : 1);
    if (onStage && event.key.startsWith("Arrow")) announce(pixels, viewer.view.pointed);
  });
}

/** Brings the controls in line with what the viewer shows. */
function reflect(view) {
  byId(`mode-${view.mode}`).checked = true;
  byId("flicker-controls").hidden = view.mode !== "flicker";
  byId("slider-controls").hidden = view.mode !== "slider";
  byId("error-controls").hidden = view.mode !== "error";
  byId("exposure-controls").hidden = view.mode === "error";
  byId("flicker-pause").setAttribute("aria-pressed", String(view.paused));
  byId("flicker-rate-value").textContent = `${view.rate}`;
  byId("exposure-value").textContent = `${view.exposure > 0 ? "+" : ""}${view.exposure} EV`;
  byId("split").value = 100 * view.split;
  byId("scale").replaceChildren(...(view.mode === "error" ? scaleParts(view.error) : []));
}

function scaleParts(kind) {
  const {stops, ticks} = errorKinds[kind];
  const ramp = element("div", {className: "ramp"});
  ramp.style.background = `linear-gradient(to right, ${stops.join(", ")})`;
  const labels = element("div", {className: "ticks"}, ...ticks.map((text) => element("span", {}, text)));
  const notes = kind === "flip" ? [] : [element("span", {}, "black: none; magenta: not finite")];
  return [element("div", {className: "bar"}, ramp, labels), ...notes];
}

async function start() {
  if (typeof DecompressionStream === "undefined") throw new Error("this page needs a browser of 2023 or later");
  const numbers = JSON.parse(byId("numbers").textContent);
  const data = JSON.parse(byId("data").textContent);
  const names = {a: numbers.device_a.name, b: numbers.device_b.name};
  if (numbers.trace_a !== numbers.trace_b) {
    names.a += ` (${numbers.trace_a})`;
    names.b += ` (${numbers.trace_b})`;
  }
  const pixels = await loadPixels(data);
  const found = data.classification ? await unpackedJson(data.classification.found) : {divergences: [], wrong_sums: []};
  const recorded = await unpackedJson(data.paths);
  const shown = new Set(Object.keys(classTable));

  showHead(numbers, data, pixels, names);
  const pathData = {scene: numbers.settings.scene, data, pixels, names, recorded, found};
  const viewer = createViewer(pixels, names, {
    isShown: (name) => shown.has(name),
    onPoint: (pixel) => showPointed(pixels, names, pixel ?? viewer.view.selected),
    onSelect: (pixel) => {
      showPointed(pixels, names, pixel);
      showPaths(pathData, pixel);
      controls.showPosition();
    },
    onChange: () => reflect(viewer.view),
  });
  const controls = connectControls(viewer, pixels, data, shown);
  showPointed(pixels, names, null);
  showPaths(pathData, null);
  controls.showPosition();
  showNumbers(numbers, (region) => {
    viewer.goTo({x: region.x + (region.width - 1) / 2, y: region.y + (region.height - 1) / 2}, 3);
    byId("viewer").scrollIntoView({block: "start"});
  });
  // As it was before it was made fit for a page.
  byId("raw").textContent = byId("numbers").textContent.trim().replace(/\\\\|\\u003c/g, (found) => (found.length === 2 ? found : "<"));
  viewer.setMode("slider");
  viewer.fit();
  return {viewer, pixels, numbers, data};
}

/** For tests: what the page is made of, once it is there. */
window.report = start().catch((error) => {
  byId("problem").textContent = `This page cannot be shown: ${error.message}`;
  byId("problem").hidden = false;
  throw error;
});
