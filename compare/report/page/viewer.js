// The images: what is drawn where, zoom, pan, and which pixel is pointed at.

const modes = [
  ["a", "A"],
  ["b", "B"],
  ["flicker", "Flicker"],
  ["slider", "Slider"],
  ["sides", "Side by side"],
  ["error", "Error"],
  ["classes", "Classes"],
];
const largestScale = 96;

/**
 * @param pixels see loadPixels
 * @param names {a, b}: of the devices
 * @param isShown whether pixels of a class are ringed
 * @param onPoint called with {x, y} or null when another pixel is pointed at; onSelect with {x, y} when one is chosen;
 *   onChange when the viewer shows something else in another way
 */
function createViewer(pixels, names, {isShown, onPoint, onSelect, onChange}) {
  const stage = byId("stage");
  const panes = ["first", "second"].map((name) => ({canvas: byId(`canvas-${name}`), tag: byId(`tag-${name}`)}));
  const view = {
    mode: "slider",
    exposure: 0,
    error: "absolute",
    split: 0.5,
    rate: 2,
    paused: false,
    flickerShowsB: false,
    marks: true,
    scale: 1,
    x: pixels.width / 2,
    y: pixels.height / 2,
    pointed: null,
    selected: null,
  };
  const cache = new Map();
  let isFitted = true;
  let flickerTimer = 0;
  let frame = 0;

  /** A canvas of the pictures, made when it is first needed. */
  function source(kind) {
    const key = kind === "error" ? `error ${view.error}` : `${kind} ${view.exposure}`;
    if (!cache.has(key)) {
      if (cache.size > 8) cache.clear();
      if (kind === "a") cache.set(key, imageCanvas(pixels, pixels.valuesA, view.exposure));
      else if (kind === "b") cache.set(key, imageCanvas(pixels, pixels.valuesB, view.exposure));
      else if (kind === "error") cache.set(key, errorCanvas(pixels, view.error));
      else cache.set(key, classCanvas(pixels, isShown, view.exposure));
    }
    return cache.get(key);
  }

  function paneSize() {
    const box = panes[0].canvas.parentElement.getBoundingClientRect();
    return {width: Math.max(box.width, 1), height: Math.max(box.height, 1)};
  }

  function fit() {
    const {width, height} = paneSize();
    view.scale = Math.min(width / pixels.width, height / pixels.height, largestScale);
    view.x = pixels.width / 2;
    view.y = pixels.height / 2;
    isFitted = true;
    redraw();
  }

  /** Zooms so that what lies at a place of the pane, from its top left, stays there. */
  function zoom(factor, place = null) {
    const {width, height} = paneSize();
    const {x, y} = place ?? {x: width / 2, y: height / 2};
    const smallest = Math.min(width / pixels.width, height / pixels.height, 1) / 2;
    const scale = Math.min(Math.max(view.scale * factor, smallest), largestScale);
    view.x += (x - width / 2) * (1 / view.scale - 1 / scale);
    view.y += (y - height / 2) * (1 / view.scale - 1 / scale);
    view.scale = scale;
    isFitted = false;
    redraw();
  }

  function goTo(pixel, scale) {
    view.x = pixel.x + 0.5;
    view.y = pixel.y + 0.5;
    view.scale = Math.max(view.scale, scale);
    isFitted = false;
    redraw();
  }

  /** What each pane shows: a picture, or a picture beside another. */
  function contents() {
    switch (view.mode) {
      case "sides": return [["a"], ["b"]];
      case "slider": return [["a", "b"]];
      case "flicker": return [[view.flickerShowsB ? "b" : "a"]];
      default: return [[view.mode]];
    }
  }

  function tagText(kind) {
    if (kind === "error") return `error of ${names.b} against ${names.a}`;
    if (kind === "classes") return "why pixels differ";
    return `${kind}: ${names[kind]}`;
  }

  function draw() {
    frame = 0;
    const shown = contents();
    byId("pane-second").hidden = shown.length < 2;
    shown.forEach((kinds, i) => {
      panes[i].tag.textContent = kinds.map(tagText).join(" │ ");
      drawPane(panes[i].canvas, kinds);
    });
    byId("zoom-value").textContent = `${plainText((100 * view.scale).toPrecision(3))} %`;
  }

  function redraw() {
    if (!frame) frame = requestAnimationFrame(draw);
  }

  function drawPane(canvas, kinds) {
    const {width, height} = paneSize();
    const ratio = window.devicePixelRatio || 1;
    canvas.width = Math.round(width * ratio);
    canvas.height = Math.round(height * ratio);
    const context = canvas.getContext("2d");
    context.scale(ratio, ratio);
    const left = width / 2 - view.x * view.scale;
    const top = height / 2 - view.y * view.scale;
    const drawImage = (kind) => {
      context.imageSmoothingEnabled = view.scale * ratio < 1;
      context.imageSmoothingQuality = "high";
      context.drawImage(source(kind), left, top, pixels.width * view.scale, pixels.height * view.scale);
    };
    drawImage(kinds[0]);
    if (kinds.length > 1) {
      const at = view.split * width;
      context.save();
      context.beginPath();
      context.rect(at, 0, width - at, height);
      context.clip();
      drawImage(kinds[1]);
      context.restore();
      drawHandle(context, at, height);
    }
    const placeOf = (x, y) => ({x: left + x * view.scale, y: top + y * view.scale});
    if (view.marks) drawMarks(context, placeOf, width, height);
    if (view.pointed && view.scale >= 4) drawSquare(context, placeOf, view.pointed, "#ffffff", 1);
    if (view.selected) drawSelection(context, placeOf);
  }

  function drawHandle(context, x, height) {
    context.fillStyle = "#000000";
    context.fillRect(x - 2, 0, 4, height);
    context.fillStyle = "#ffffff";
    context.fillRect(x - 1, 0, 2, height);
    // Below the middle, which is where a pixel that was gone to is.
    const y = 0.8 * height;
    context.beginPath();
    context.arc(x, y, 13, 0, 2 * Math.PI);
    context.fill();
    context.fillStyle = "#222222";
    for (const side of [-1, 1]) {
      context.beginPath();
      context.moveTo(x + 9 * side, y);
      context.lineTo(x + 3 * side, y - 5);
      context.lineTo(x + 3 * side, y + 5);
      context.fill();
    }
  }

  function drawSquare(context, placeOf, pixel, color, width) {
    const place = placeOf(pixel.x, pixel.y);
    context.lineWidth = width + 2;
    context.strokeStyle = "#000000";
    context.strokeRect(place.x, place.y, view.scale, view.scale);
    context.lineWidth = width;
    context.strokeStyle = color;
    context.strokeRect(place.x, place.y, view.scale, view.scale);
  }

  /** Rings around pixels that would be too small to see, squares around others. None where they would cover all. */
  function drawMarks(context, placeOf, width, height) {
    const places = [];
    for (const pixel of pixels.ranked) {
      if (!isShown(pixel.class ?? unclassed)) continue;
      const x = pixel.index % pixels.width;
      const y = Math.floor(pixel.index / pixels.width);
      const place = placeOf(x + 0.5, y + 0.5);
      if (place.x > -9 && place.y > -9 && place.x < width + 9 && place.y < height + 9) places.push({pixel, x, y, place});
    }
    if (places.length > 600) return;
    for (const {pixel, x, y, place} of places) {
      const color = classTable[pixel.class ?? unclassed].color;
      if (view.scale >= 10) {
        drawSquare(context, placeOf, {x, y}, color, 2);
        continue;
      }
      for (const [style, thickness] of [["#000000", 4], [color, 2]]) {
        context.lineWidth = thickness;
        context.strokeStyle = style;
        context.beginPath();
        context.arc(place.x, place.y, 7, 0, 2 * Math.PI);
        context.stroke();
      }
    }
  }

  function drawSelection(context, placeOf) {
    const place = placeOf(view.selected.x + 0.5, view.selected.y + 0.5);
    const inner = Math.max(view.scale / 2 + 3, 11);
    for (const [style, thickness] of [["#000000", 5], ["#ffffff", 2.5]]) {
      context.lineWidth = thickness;
      context.strokeStyle = style;
      context.beginPath();
      for (const [dx, dy] of [[1, 0], [-1, 0], [0, 1], [0, -1]]) {
        context.moveTo(place.x + dx * inner, place.y + dy * inner);
        context.lineTo(place.x + dx * (inner + 12), place.y + dy * (inner + 12));
      }
      context.stroke();
    }
  }

  function setMode(mode) {
    const hadTwo = view.mode === "sides";
    view.mode = mode;
    clearTimeout(flickerTimer);
    view.flickerShowsB = false;
    if (mode === "flicker") scheduleFlicker();
    draw();
    if (isFitted && hadTwo !== (mode === "sides")) fit();
    onChange();
  }

  function scheduleFlicker() {
    clearTimeout(flickerTimer);
    if (view.mode !== "flicker" || view.paused) return;
    flickerTimer = setTimeout(() => {
      swap();
      scheduleFlicker();
    }, 1000 / view.rate);
  }

  /** The other image. */
  function swap() {
    if (view.mode === "flicker") {
      view.flickerShowsB = !view.flickerShowsB;
      draw();
    } else {
      setMode(view.mode === "a" ? "b" : "a");
    }
  }

  function set(changes) {
    Object.assign(view, changes);
    if ("rate" in changes || "paused" in changes) scheduleFlicker();
    redraw();
    onChange();
  }

  function select(pixel) {
    view.selected = pixel;
    redraw();
    onSelect(pixel);
  }

  function point(pixel) {
    if (pixel?.x === view.pointed?.x && pixel?.y === view.pointed?.y) return;
    view.pointed = pixel;
    redraw();
    onPoint(pixel);
  }

  /** Of an event: the place within its pane, and the pixel there or null. */
  function placeOfEvent(event) {
    const pane = panes.find(({canvas}) => canvas.parentElement.contains(event.target)) ?? panes[0];
    const box = pane.canvas.getBoundingClientRect();
    const place = {x: event.clientX - box.left, y: event.clientY - box.top, width: box.width};
    const x = Math.floor(view.x + (place.x - box.width / 2) / view.scale);
    const y = Math.floor(view.y + (place.y - box.height / 2) / view.scale);
    const isInside = x >= 0 && y >= 0 && x < pixels.width && y < pixels.height;
    return {...place, pixel: isInside ? {x, y} : null};
  }

  function movePointed(dx, dy) {
    const from = view.pointed ?? view.selected ?? {x: Math.floor(view.x), y: Math.floor(view.y)};
    const pixel = {
      x: Math.min(Math.max(from.x + dx, 0), pixels.width - 1),
      y: Math.min(Math.max(from.y + dy, 0), pixels.height - 1),
    };
    point(pixel);
    const {width, height} = paneSize();
    view.x = Math.min(Math.max(view.x, pixel.x + 1 - width / 2 / view.scale), pixel.x + width / 2 / view.scale);
    view.y = Math.min(Math.max(view.y, pixel.y + 1 - height / 2 / view.scale), pixel.y + height / 2 / view.scale);
    redraw();
  }

  let drag = null;
  stage.addEventListener("pointerdown", (event) => {
    const place = placeOfEvent(event);
    const onHandle = view.mode === "slider" && Math.abs(place.x - view.split * place.width) < 14;
    drag = {onHandle, x: event.clientX, y: event.clientY, moved: false, pixel: place.pixel};
    stage.setPointerCapture(event.pointerId);
  });
  stage.addEventListener("pointermove", (event) => {
    if (!drag) {
      const place = placeOfEvent(event);
      stage.style.cursor = view.mode === "slider" && Math.abs(place.x - view.split * place.width) < 14 ? "ew-resize" : "";
      point(place.pixel);
      return;
    }
    const dx = event.clientX - drag.x;
    const dy = event.clientY - drag.y;
    if (!drag.moved && Math.hypot(dx, dy) < 4) return;
    drag.moved = true;
    if (drag.onHandle) {
      const box = panes[0].canvas.getBoundingClientRect();
      set({split: Math.min(Math.max((event.clientX - box.left) / box.width, 0), 1)});
      return;
    }
    stage.classList.add("dragging");
    view.x -= dx / view.scale;
    view.y -= dy / view.scale;
    drag.x = event.clientX;
    drag.y = event.clientY;
    isFitted = false;
    redraw();
  });
  const endDrag = (event) => {
    if (event.type === "pointerup" && drag && !drag.moved && drag.pixel) {
      point(drag.pixel);
      select(drag.pixel);
    }
    drag = null;
    stage.classList.remove("dragging");
  };
  stage.addEventListener("pointerup", endDrag);
  stage.addEventListener("pointercancel", endDrag);
  stage.addEventListener("pointerleave", () => point(null));
  stage.addEventListener("wheel", (event) => {
    event.preventDefault();
    zoom(Math.exp(-event.deltaY * (event.deltaMode === 1 ? 0.05 : 0.0015)), placeOfEvent(event));
  }, {passive: false});
  new ResizeObserver(() => (isFitted ? fit() : redraw())).observe(stage);

  return {
    view, fit, zoom, goTo, setMode, swap, set, select, movePointed, draw,
    one: () => zoom(1 / view.scale),
    forgetClasses: () => {
      cache.clear();
      redraw();
    },
  };
}
