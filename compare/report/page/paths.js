// What happened along the paths of a pixel, on both devices.

function valueText(value) {
  return Array.isArray(value) ? value.map(valueText).join(", ") : value === null ? "none" : String(value);
}

/** Whether a field has other bits on the other device, or only one device has its event. */
function isDifferent(event, field) {
  return "only" in event || "b" in field;
}

/**
 * Names of the fields of an event: all; those that differ and that the path goes on with; those that differ in what
 * devices report of a hit, on which no result depends. @param observed "event/field" of the latter
 */
function sortFields(event, observed) {
  const all = Object.keys(event.fields);
  const differing = all.filter((name) => isDifferent(event, event.fields[name]));
  const isObserved = (name) => !("only" in event) && observed.includes(`${event.event}/${name}`);
  return {all, carried: differing.filter((name) => !isObserved(name)), reported: differing.filter(isObserved)};
}

/** The value on a device, or what it names in the scene; where b's is left out it is that of a. */
function fieldCell(event, field, side) {
  const isThere = !("only" in event) || event.only === side;
  const shown = side in field ? side : "a";
  const name = field[`name_${shown}`];
  return element("td", {className: "value"}, isThere ? (name ?? valueText(field[shown])) : "");
}

function eventNote(event, {all, carried, reported}) {
  if ("only" in event) return `only on ${event.only}`;
  if (carried.length > 0) return `${carried.length} of ${countText(all.length, "field")} ${carried.length === 1 ? "differs" : "differ"}`;
  return reported.length > 0 ? `the same, but for the digits of ${reported.join(" and ")}, on which no result depends` : "the same";
}

function eventRows(event, fields, isFirst, showsAll) {
  const className = `event${isFirst ? " first" : ""}${fields.carried.length > 0 ? " changed" : ""}`;
  const rows = [element("tr", {className}, element("th", {scope: "row"}, `segment ${event.segment}: ${event.event}`),
    element("td", {colSpan: 3}, eventNote(event, fields)))];
  for (const name of showsAll ? fields.all : fields.carried) {
    const field = event.fields[name];
    rows.push(element("tr", {className: `field${fields.carried.includes(name) ? " changed" : ""}`}, element("th", {scope: "row"}, name),
      fieldCell(event, field, "a"), fieldCell(event, field, "b"),
      element("td", {className: "value"}, "ulp" in field ? field.ulp.toLocaleString("en") : "")));
  }
  return rows;
}

/** One row for events that are the same, one after the other. */
function equalRow(events) {
  const first = events[0];
  const last = events[events.length - 1];
  const text = `segment ${first.segment}: ${first.event} to ${first.segment === last.segment ? "" : `segment ${last.segment}: `}${last.event}`;
  return element("tr", {className: "event"}, element("th", {scope: "row"}, text), element("td", {colSpan: 3}, `${events.length} events, the same`));
}

function eventTable(path, names, observed, showsAll) {
  const sorted = path.events.map((event) => sortFields(event, observed));
  const first = sorted.findIndex(({carried}) => carried.length > 0);
  const head = ["Event and field", `a: ${names.a}`, `b: ${names.b}`, "ULP"].map((text) => element("th", {scope: "col"}, text));
  const rows = [];
  for (let i = 0; i < path.events.length;) {
    let end = i;
    while (!showsAll && end < path.events.length && sorted[end].carried.length === 0) ++end;
    if (end - i > 1) {
      rows.push(equalRow(path.events.slice(i, end)));
      i = end;
    } else {
      rows.push(...eventRows(path.events[i], sorted[i], i === first, showsAll));
      ++i;
    }
  }
  return element("div", {className: "scroll"}, element("table", {className: "events"},
    element("thead", {}, element("tr", {}, ...head)), element("tbody", {}, ...rows)));
}

/**
 * Shows the paths of a pixel below the images.
 * @param scene its file
 * @param recorded paths with events: {x, y, sample, events}
 * @param found of the classification: {divergences, wrong_sums}
 */
function showPaths({scene, data, pixels, names, recorded, found}, pixel) {
  const heading = byId("paths-heading");
  const content = byId("path");
  if (!pixel) {
    heading.textContent = "Paths of a pixel";
    content.replaceChildren(element("p", {}, `Click a pixel, or go to the next one that differs. ${recordedSentence(data)}`));
    return;
  }
  heading.replaceChildren(`Paths of pixel ${pixel.x}, ${pixel.y} `, pixelState(pixels, pixel));
  const isHere = (other) => other.x === pixel.x && other.y === pixel.y;
  const children = [pixelTable(pixels, names, pixel)];
  for (const {device} of found.wrong_sums.filter(isHere))
    children.push(element("p", {className: "problem"}, `The picture of ${names[device]} is not the sum of the paths that it traces here.`));
  const divergences = found.divergences.filter(isHere);
  if (divergences.length > 0) {
    children.push(element("h3", {}, "Where they diverge"), element("ul", {className: "divergences"},
      ...divergences.map((divergence) => element("li", {}, classBadge(divergence.class), ` sample ${divergence.sample}, segment ${divergence.segment}: ${divergence.sentence}`))));
  }
  const paths = recorded.filter(isHere);
  if (paths.length === 0) children.push(element("p", {}, unrecordedSentence(data, pixels, pixel), ...commandHint(scene, pixel)));
  for (const path of paths) children.push(...pathBlock(path, names, data.observed));
  content.replaceChildren(...children);
}

function pathBlock(path, names, observed) {
  const box = element("input", {type: "checkbox"});
  const table = element("div", {}, eventTable(path, names, observed, false));
  box.addEventListener("change", () => table.replaceChildren(eventTable(path, names, observed, box.checked)));
  return [element("h3", {}, `Sample ${path.sample}, event by event`),
    element("label", {className: "check"}, box, " Show all events and fields"), table];
}

function recordedSentence(data) {
  if (data.path_count === 0) return "No path was recorded event by event.";
  return data.path_count < data.differing_pixels
    ? `Of ${countText(data.differing_pixels, "pixel")} that differ, a path of each of ${data.path_count} was recorded event by event: the worst, then others spread evenly.`
    : "A path of each pixel that differs was recorded event by event.";
}

function unrecordedSentence(data, pixels, pixel) {
  const differs = pixels.differs[pixel.y * pixels.width + pixel.x];
  const start = differs ? "The paths of this pixel were not recorded. " : "This pixel has the same bits on both devices, so its paths were not recorded. ";
  return start + recordedSentence(data);
}

function commandHint(scene, pixel) {
  return [" With the options of this comparison, ", element("code", {}, `tandem explain ${scene} --pixel ${pixel.x},${pixel.y}`), " shows them."];
}
