// Controls and charts of the page of a device, over the grid of its computed states.
//
// Plain JavaScript and SVG: no dependency to embed, update or trust, and a few kilobytes on every page. The formulas are
// those of report/devices/grid.py and curves.py, which a test compares with them. Every text enters the page as text, never as HTML.
(() => {
"use strict";
const content = JSON.parse(document.getElementById("explorer-data").textContent);
const root = document.getElementById("explorer"), menu = document.getElementById("views");
const address = () => new URLSearchParams(location.hash.slice(1));

/** Controls, answers and charts of a view; returns a function that reads the state from the address. */
function opened(number) {
  const data = {...content, ...content.views[number]};
  const grid = data.grid;
  root.replaceChildren();
  const controls = [...grid.axes, grid.size, grid.share];
  const MISSING = "\u2013", Z95 = 1.959963984540054, DIGITS = 4, SAFE_DIGITS = 3, STEPS = 400, POINTS = 120;
  const SAME = 2e-6; // relative difference of sizes that rounding makes

  // Formulas

  /** Normal probability, by the series of Marsaglia (2004). */
  function probability(x) {
    if (Math.abs(x) > 8) return x > 0 ? 1 : 0;
    if (x < -3) { // a continued fraction has no cancellation in the lower tail
      let rest = -x;
      for (let k = 60; k > 0; k--) rest = -x + k / rest;
      return Math.exp(-x * x / 2) / Math.sqrt(2 * Math.PI) / rest;
    }
    let sum = x, term = x;
    for (let k = 3; Math.abs(term) > 1e-18; k += 2) sum += term *= x * x / k;
    return 0.5 + sum * Math.exp(-x * x / 2) / Math.sqrt(2 * Math.PI);
  }

  /** Normal score of a probability, by bisection. */
  function score(p) {
    let [low, high] = [-8, 8];
    for (let k = 0; k < 70; k++) {
      const middle = (low + high) / 2;
      if (probability(middle) < p) low = middle; else high = middle;
    }
    return (low + high) / 2;
  }

  const PLACES = {linear: value => value, log: Math.log, rest: value => -Math.log1p(-value), score};
  const VALUES = {linear: place => place, log: Math.exp, rest: place => -Math.expm1(-place), score: probability};

  /** Slope of a monotone cubic at its k-th place. */
  function slope(k, widths, secants) {
    const last = widths.length;
    if (last === 1) return secants[0];
    if (k === 0 || k === last) {
      const [i, j] = k === 0 ? [0, 1] : [last - 1, last - 2];
      const [w0, w1, d0, d1] = [widths[i], widths[j], secants[i], secants[j]];
      const found = ((2 * w0 + w1) * d0 - w0 * d1) / (w0 + w1);
      if (d0 * d1 < 0 && Math.abs(found) > Math.abs(3 * d0)) return 3 * d0;
      return found * d0 <= 0 ? 0 : found;
    }
    const [d0, d1] = [secants[k - 1], secants[k]];
    if (d0 * d1 <= 0) return 0;
    const [w0, w1] = [widths[k] * 2 + widths[k - 1], widths[k] + 2 * widths[k - 1]];
    return (w0 + w1) / (w0 / d0 + w1 / d1);
  }

  /** Monotone cubic through numbers at increasing places. */
  function monotone(places, values, at) {
    if (places.length === 1) return values[0];
    const widths = places.slice(1).map((place, k) => place - places[k]);
    const secants = widths.map((width, k) => (values[k + 1] - values[k]) / width);
    let k = 0;
    while (k < widths.length - 1 && places[k + 1] <= at) k++;
    return hermite(widths[k], (at - places[k]) / widths[k], values.slice(k, k + 2), [k, k + 1].map(j => slope(j, widths, secants)));
  }

  /** Cubic with values and slopes at both ends of an interval, at a part of its width. */
  function hermite(width, t, values, slopes) {
    const s = 1 - t, ends = values[0] * (1 + 2 * t) * s * s + values[1] * t * t * (3 - 2 * t);
    return ends + width * (slopes[0] * t * s * s - slopes[1] * t * t * s);
  }

  const placesOf = axis => axis.values.map(PLACES[axis.scale]);
  const known = new Map(controls.map(axis => [axis.key, placesOf(axis)]));

  /** Logarithms of nested numbers at a state, over their last dimension. */
  function at(values, state, axes = grid.axes) {
    if (!axes.length) return values.map(value => value === null ? NaN : Math.log(value));
    const [axis, ...others] = axes;
    if (!axis.between) return at(values[axis.values.indexOf(state[axis.key])], state, others);
    const parts = values.map(part => at(part, state, others)), place = PLACES[axis.scale](state[axis.key]);
    return parts[0].map((_, k) => monotone(known.get(axis.key), parts.map(part => part[k]), place));
  }

  function safeSize(state) {
    return Math.exp(monotone(known.get("share"), at(grid.safe, state), score(state.share)));
  }

  const noiseAt = state => Math.exp(monotone(known.get("share"), at(grid.noise, state, grid.axes.slice(1)), score(state.share)));

  /** Nested sizes of a packed array, null for those that are unknown. */
  function unpacked({low, step, shape, content}) {
    const bytes = atob(content), part = k => bytes.charCodeAt(k);
    let read = 0;
    const size = () => {
      const code = 65536 * part(read++) + 256 * part(read++) + part(read++);
      return code === 16777215 ? null : Math.exp(low + step * code);
    };
    const nested = ([count, ...others]) => Array.from({length: count}, () => others.length ? nested(others) : size());
    return nested(shape);
  }

  /** Layers of P(stuck) and the ends of its band at a state: sizes as v, and their scores. */
  const sign = grid.falls ? -1 : 1, levels = grid.levels && unpacked(grid.levels);
  function levelsOf(state) {
    const layers = levels.map((layer, n) => {
      const found = at(layer, state).map(value => sign * value), keep = found.map(Number.isFinite);
      const [known, scores] = [found, grid.scores].map(part => part.filter((_, k) => keep[k]));
      const rising = n === 1 ? known.map((_, k) => Math.max(...known.slice(0, k + 1))) : known.map((_, k) => Math.min(...known.slice(k)));
      return [rising, scores];
    });
    return {layers, first: grid.first ? sign * at(grid.first, state)[0] : NaN};
  }

  // Formulas of curves

  const chosen = (part, state) => grid.axes.slice(1).reduce((found, axis) => found[axis.values.indexOf(state[axis.key])], part);

  /** Value of a line of a state, not a number next to a point that could not be computed. */
  function onLine(name, state) {
    const places = known.get(grid.axes[0].key), at = PLACES[grid.axes[0].scale](state[grid.axes[0].key]);
    const [values, slopes] = chosen(grid.lines[name], state).map(part => part.map(one => one ?? NaN));
    let k = 0;
    while (k < places.length - 1 && places[k + 1] <= at) k++;
    if (places[k] === at) return values[k];
    const width = places[k + 1] - places[k];
    return hermite(width, (at - places[k]) / width, values.slice(k, k + 2), slopes.slice(k, k + 2));
  }

  /** Margin and size of a state, each with the ends of its band. */
  function sizes(state) {
    const margin = onLine("margin", state), reach = Z95 * onLine("error", state), sign = grid.falls ? -1 : 1;
    const parts = [0, -reach, reach];
    return [parts.map(part => margin + part), parts.map(part => grid.size.start * Math.exp(sign * margin + part))];
  }

  const stuckOn = state => ({share: onLine("stuck", state), low: onLine("low", state), high: onLine("high", state), beyond: 0});
  const suffices = state => chosen(grid.ranges, state).some(([low, high]) => low <= state[grid.axes[0].key] && state[grid.axes[0].key] <= high);

  function line(x, y, value) {
    if (value <= x[0]) return y[0];
    for (let k = 1; k < x.length; k++)
      if (value < x[k]) return y[k - 1] + (y[k] - y[k - 1]) * (value - x[k - 1]) / (x[k] - x[k - 1]);
    return y[y.length - 1];
  }

  /** Fractions of the layers at v; where an end has no levels, no more than that it is from 0 to 1. */
  const fractionsAt = (layers, v) => layers.map(([levels, scores], k) => {
    const isOpen = !levels.length || (k === 1 && v < levels[0] - SAME) || (k === 2 && v > levels[levels.length - 1] + SAME);
    return isOpen ? [NaN, 0, 1][k] : probability(line(levels, scores, v));
  });

  /** P(stuck) at a size. Where no simulated device sticks, its upper end alone is known. */
  function stuckAt(size, {layers, first}) {
    const v = sign * Math.log(size), [levels] = layers[0];
    const [share, low, high] = fractionsAt(layers, v);
    const beyond = levels.length ? (v > levels[levels.length - 1] + SAME) - (v < levels[0] - SAME) : 0;
    return !grid.first || v >= first ? {share, low, high, beyond} : {share, low: 0, high, beyond: -1};
  }

  // Texts

  function text(value, digits = 3) {
    if (!Number.isFinite(value)) return MISSING;
    const rounded = Number(value.toPrecision(digits)), size = Math.abs(rounded);
    return size >= 1e-4 && size < 1e6 || !size ? String(rounded) : value.toExponential(digits - 1);
  }
  const grouped = number => /^\d{5,}$/.test(number) ? number.replace(/\B(?=(\d{3})+$)/g, " ") : number;

  /** Text of a bound with some digits, never below it if up, else never above. The page knows two more digits, or `known` ones. */
  function bounding(value, digits, up, known = digits + 2) {
    if (!Number.isFinite(value) || !value) return text(value);
    const [mantissa, power] = value.toExponential(known - 1).split("e"), steps = Number(`${mantissa}e${digits - 1}`);
    return text(Number(`${up ? Math.ceil(steps) : Math.floor(steps)}e${Number(power) + 1 - digits}`), digits);
  }
  const safeText = size => bounding(size, SAFE_DIGITS, grid.falls, DIGITS + 2);
  const oneIn = share => `1 in ${grouped(text(1 / share))}`;

  /** Fraction in percent, or an end of a band, "low" or "high", rounded outwards, as in report/answer/words.py. */
  function percent(share, end) {
    if (share < 1e-5) return {low: "0 %", high: "0.001 %"}[end] ?? "less than 0.001 %";
    if (share > 0.999) return {low: "99.9 %", high: "100 %"}[end] ?? "more than 99.9 %";
    const power = 10 ** Math.ceil(Math.log10(share)), digits = end === "high" && 0.95 * power < share && power < 1 ? 1 : 2;
    if (end) return `${share > 0.99 ? Number((100 - bounding(100 * (1 - share), 2, end === "low")).toPrecision(4)) : bounding(100 * share, digits, end === "high")} %`;
    if (share > 0.99) return `${Number((100 - Number((100 * (1 - share)).toPrecision(2))).toPrecision(4))} %`;
    return `${Number((100 * share).toPrecision(2))} %`;
  }

  function stuckText({share, low, high, beyond}) {
    if (Number.isNaN(share)) return MISSING;
    const [most, mean] = [percent(high, "high"), percent(share)], more = share > high && mean !== most ? ` (95 % confidence; ${mean} on average, as many stick in the worst 5 %)` : "";
    if (beyond < 0) return high > 0.999 ? "0 to 100 %" : `at most ${most}${more}`;
    if (low > 0.999) return percent(low);
    if (beyond) return `at least ${percent(low, "low")}`;
    return `${percent(share)} (${percent(low, "low").replace(" %", "")} to ${percent(high, "high")})`;
  }

  const valueText = (axis, value) => axis.key === "humidity" && value === 0 ? "dry air" : `${text(value, DIGITS)}${axis.unit && ` ${axis.unit}`}`;

  // State

  const clamp = (value, low, high) => Math.min(Math.max(value, low), high);

  /** Nearest value of an axis with an answer. */
  function nearest(axis, value) {
    if (axis.between) return clamp(Number(value.toPrecision(DIGITS)), axis.values[0], axis.values[axis.values.length - 1]);
    return axis.values.reduce((best, one) => Math.abs(one - value) < Math.abs(best - value) ? one : best);
  }

  function fromAddress() {
    const asked = address(), found = {}, refused = {};
    for (const axis of controls) {
      const value = parseFloat(asked.get(axis.key) ?? "");
      found[axis.key] = Number.isFinite(value) ? nearest(axis, value) : axis.start;
      refused[axis.key] = Number.isFinite(value) && found[axis.key] !== Number(value.toPrecision(DIGITS)) ? value : null;
    }
    return [found, refused];
  }

  function toAddress() {
    const words = [`view=${number}`, ...controls.map(axis => `${axis.key}=${text(state[axis.key], DIGITS)}`)];
    try { history.replaceState(null, "", `#${words.join("&")}`); } catch { /* a frame of a report has no address */ }
  }

  // Page

  function make(parent, name, attributes = {}, content) {
    const svg = ["svg", "path", "line", "circle", "rect", "text", "g"].includes(name);
    const made = svg ? document.createElementNS("http://www.w3.org/2000/svg", name) : document.createElement(name);
    for (const [key, value] of Object.entries(attributes)) made.setAttribute(key, value);
    if (content !== undefined) made.textContent = content;
    parent.append(made);
    return made;
  }

  const rows = new Map();

  function control(parent, axis) {
    const row = make(parent, "div", {class: "control"}), id = `control-${axis.key}`, last = axis.values.length - 1;
    make(row, "label", {for: id}, axis.label);
    const range = make(row, "input", {type: "range", id, min: 0, max: axis.between ? STEPS : last, step: 1});
    const number = make(row, "input", {type: "number", step: "any", "aria-label": `${axis.label} as a number`});
    make(row, "span", {class: "unit"}, axis.unit);
    const note = make(row, "p", {class: "note", role: "status"});
    range.disabled = number.disabled = axis.values.length === 1;
    if (range.disabled) note.textContent = `Fixed: ${axis.reason}.`;
    const [low, high] = [known.get(axis.key)[0], known.get(axis.key)[last]];
    range.addEventListener("input", () => {
      const step = Number(range.value), place = low + (high - low) * step / STEPS;
      const value = step === STEPS ? axis.values[last] : step ? VALUES[axis.scale](place) : axis.values[0];
      change(axis, axis.between ? value : axis.values[step]);
    });
    number.addEventListener("change", () => change(axis, parseFloat(number.value)));
    rows.set(axis.key, {range, number, note, low, high});
  }

  function change(axis, value) {
    const found = nearest(axis, Number.isFinite(value) ? value : state[axis.key]);
    const refused = Number.isFinite(value) && axis.values.length > 1 && found !== nearest({between: true, values: [value, value]}, value);
    state[axis.key] = found;
    refresh({[axis.key]: refused && found !== Number(value.toPrecision(DIGITS)) ? value : null});
  }

  function refresh(refused) {
    for (const axis of controls) {
      const {range, number, note, low, high} = rows.get(axis.key), value = state[axis.key];
      range.value = axis.between ? STEPS * (PLACES[axis.scale](value) - low) / ((high - low) || 1) : axis.values.indexOf(value);
      range.setAttribute("aria-valuetext", valueText(axis, value));
      number.value = text(value, DIGITS);
      if (!range.disabled) note.textContent = refused[axis.key] == null ? "" : `${text(refused[axis.key], DIGITS)} is not shown: ${axis.reason}.`;
    }
    answer();
    for (const draw of charts) draw();
    toAddress();
  }

  let shown;

  function answer() {
    for (const [name, content] of Object.entries(answersOf())) shown[name].textContent = content;
  }

  /** Texts of the answers; the warning instead of all of them, if there is one. */
  const answersOf = data.forbidden ? () => ({forbidden: data.forbidden}) : grid.lines ? textsOfCurve : texts;

  function textsOfCurve() {
    const {words} = data, [quantity] = grid.axes, [[margin, ...ends], [size, ...band]] = sizes(state);
    const at = `${quantity.label[0].toUpperCase()}${quantity.label.slice(1)} ${valueText(quantity, state[quantity.key])}`;
    const between = ([low, high]) => `${text(low, DIGITS)} to ${text(high, DIGITS)}`, beyond = Math.abs(margin) >= grid.largest;
    const unknown = Number.isFinite(margin) ? "beyond a factor of 1000 of the required one" : "not computed here";
    const safe = grid.lines.safe ? `; ${safeText(grid.size.start * Math.exp((grid.falls ? -1 : 1) * onLine("safe", state)))} ${grid.size.unit} with 95 % confidence` : "";
    return {
      enough: `${at}: ${suffices(state) ? words.yes : words.no}`,
      size: `${words.size}: ${beyond || !Number.isFinite(margin) ? unknown : `${text(size, DIGITS)} ${grid.size.unit} (${between(band)} ${grid.size.unit})${safe}`}`,
      stuck: `${words.stick}: ${stuckText(stuckOn(state))}`,
      margin: `Margin, ln(${grid.falls ? "restoring force / force needed" : "length / required length"}): ${beyond || !Number.isFinite(margin) ? unknown : `${text(margin, DIGITS)} (${between(ends)})`}`,
    };
  }

  /** Note that a size to build is that for all stated airs: it is in the air that decides. */
  const together = ({humidity}) => Number(data.words.all_airs) === humidity ? ", stated airs together" : "";

  function texts() {
    const unit = grid.size.unit, words = data.words, levels = levelsOf(state);
    const safe = safeSize(state);
    return {
      stuck: `${words.stick}: ${stuckText(stuckAt(state[grid.size.key], levels))}`,
      safe: `${words.safe} for ${oneIn(state.share)}${together(state)}: ${Number.isFinite(safe) ? `${safeText(safe)} ${unit}` : words.none ?? `not known from ${grid.samples} devices`}`,
    };
  }

  // Charts

  const [WIDTH, HEIGHT, LEFT, BOTTOM, TOP, RIGHT] = [400, 280, 74, 46, 12, 12];

  function ticks(low, high) {
    const rough = (high - low) / 6, power = 10 ** Math.floor(Math.log10(rough));
    const step = [1, 2, 2.5, 5, 10].map(k => k * power).find(one => one >= rough), found = [];
    for (let k = Math.ceil(low / step - 1e-9); k * step <= high * (1 + 1e-9); k++) found.push(k * step);
    return found;
  }

  function axesOf(parent, title, [x0, x1], [y0, y1], labels, rules = ticks(y0, y1).map(tick => [tick, text(tick)])) {
    const figure = make(parent, "figure"), svg = make(figure, "svg", {viewBox: `0 0 ${WIDTH} ${HEIGHT}`, role: "img", "aria-label": title});
    const x = value => LEFT + (WIDTH - LEFT - RIGHT) * (value - x0) / (x1 - x0);
    const y = value => HEIGHT - BOTTOM - (HEIGHT - BOTTOM - TOP) * (value - y0) / (y1 - y0);
    for (const tick of ticks(x0, x1)) make(svg, "text", {x: x(tick), y: HEIGHT - BOTTOM + 18, "text-anchor": "middle"}, text(tick));
    for (const [tick, label] of rules) {
      make(svg, "line", {x1: LEFT, x2: WIDTH - RIGHT, y1: y(tick), y2: y(tick), class: "rule"});
      make(svg, "text", {x: LEFT - 8, y: y(tick) + 5, "text-anchor": "end"}, label);
    }
    make(svg, "text", {x: (LEFT + WIDTH - RIGHT) / 2, y: HEIGHT - 6, "text-anchor": "middle"}, labels[0]);
    make(svg, "text", {transform: `translate(14 ${(TOP + HEIGHT - BOTTOM) / 2}) rotate(-90)`, "text-anchor": "middle"}, labels[1]);
    return {svg, x, y, caption: make(figure, "figcaption", {class: "hover"})};
  }

  const path = points => points.map(([x, y], k) => `${k ? "L" : "M"}${x.toFixed(1)} ${y.toFixed(1)}`).join("");
  const spread = (low, high) => Array.from({length: POINTS + 1}, (_, k) => low + (high - low) * k / POINTS);

  /** Show the value under the pointer, or that of the state. */
  function hover({svg, caption}, [x0, x1], describe, here) {
    const show = value => { caption.textContent = describe(value); };
    svg.addEventListener("pointermove", event => {
      const box = svg.getBoundingClientRect(), place = (event.clientX - box.left) / box.width * WIDTH;
      show(clamp(x0 + (x1 - x0) * (place - LEFT) / (WIDTH - LEFT - RIGHT), x0, x1));
    });
    svg.addEventListener("pointerleave", () => show(here()));
    return () => show(here());
  }

  /** Range of a chart around the known levels, the bound and the present size. */
  function rangeOf(levels, bound) {
    const sizes = [state[grid.size.key], bound, ...levels.map(v => Math.exp(sign * v))].filter(Number.isFinite);
    return [0.95 * Math.min(...sizes), 1.05 * Math.max(...sizes)];
  }

  /** Ends of the axis of P(stuck), and its ticks. */
  const LEAST = -6, DECADES = [[0, "100 %"], [-1, "10 %"], [-2, "1 %"], [-3, "0.1 %"], [-4, "0.01 %"], [-5, "0.001 %"]];

  function stuckChart(parent) {
    const {size} = grid, unit = size.unit, share = data.words.share ?? "P(stuck)", place = make(parent, "div");
    return () => {
      const levels = levelsOf(state), bound = safeSize(state), ends = rangeOf(levels.layers[0][0], bound);
      place.replaceChildren();
      const chart = axesOf(place, `${share} against ${size.label}`, ends, [LEAST, 0], [`${size.label} [${unit}]`, share], DECADES);
      const height = share => chart.y(Math.max(Math.log10(share), LEAST));
      const known = levels.layers[0][0], within = v => v >= known[0] && v <= known[known.length - 1];
      const points = spread(...ends).map(value => [value, stuckAt(value, levels)]).filter(([, {share}]) => Number.isFinite(share));
      const line = (end, shown) => shown.map(([value, stuck]) => [chart.x(value), height(stuck[end])]);
      make(chart.svg, "path", {class: "band", d: path([...line("low", points), ...line("high", points).reverse()])});
      make(chart.svg, "path", {class: "curve", d: path(line("share", points.filter(([value]) => within(sign * Math.log(value)))))});
      if (Number.isFinite(bound)) make(chart.svg, "line", {class: "safe", x1: chart.x(bound), x2: chart.x(bound), y1: TOP, y2: HEIGHT - BOTTOM});
      // The dot is at the number that the words name: the end of the band where a bound alone is known, or where the few cases beyond it lift the mean.
      const {share: mean, low, high, beyond} = stuckAt(state[size.key], levels), above = points.some(([, stuck]) => stuck.share > stuck.high + SAME);
      if (Number.isFinite(mean)) make(chart.svg, "circle", {r: 6, class: "here", cx: chart.x(state[size.key]), cy: height(beyond < 0 ? high : clamp(mean, low, high))});
      const dashed = Number.isFinite(bound) ? ` Dashed: ${data.words.bound} for ${oneIn(state.share)}.` : "";
      const expected = `Line: expected${above ? ", above its band where many stick in the worst 5 %" : ""}. Band: 95 %.`;
      hover(chart, ends, value => `At ${text(value, DIGITS)} ${unit}: ${stuckText(stuckAt(value, levels))}. ${expected}${dashed}`, () => state[size.key])();
    };
  }

  const nameOf = axis => `${axis.label}${axis.unit && ` [${axis.unit}]`}`;

  /** Chart of a curve with its band, what suffices shaded, and the required size with the best value. */
  function curveChart(parent, title, top, at, describe) {
    const [axis] = grid.axes, ends = [axis.values[0], axis.values[axis.values.length - 1]], place = make(parent, "div");
    const along = value => at({...state, [axis.key]: value}), inside = value => clamp(value, 0, top());
    return (required) => {
      place.replaceChildren();
      const chart = axesOf(place, title, ends, [0, top()], [nameOf(axis), title]), bottom = HEIGHT - BOTTOM;
      for (const [low, high] of chosen(grid.ranges, state)) make(chart.svg, "rect", {class: "enough", x: chart.x(low), width: chart.x(high) - chart.x(low), y: TOP, height: bottom - TOP});
      const points = spread(...ends).map(value => [value, along(value).map(inside)]).filter(([, found]) => found.every(Number.isFinite));
      const side = k => points.map(([value, found]) => [chart.x(value), chart.y(found[k])]);
      make(chart.svg, "path", {class: "band", d: path([...side(1), ...side(2).reverse()])});
      make(chart.svg, "path", {class: "curve", d: path(side(0))});
      for (const value of axis.values) if (along(value)[0] <= top()) make(chart.svg, "circle", {r: 3, class: "mark", cx: chart.x(value), cy: chart.y(along(value)[0])});
      if (required) {
        make(chart.svg, "line", {class: "safe", x1: LEFT, x2: WIDTH - RIGHT, y1: chart.y(required), y2: chart.y(required)});
        if (grid.best) make(chart.svg, "line", {class: "best", x1: chart.x(grid.best[1]), x2: chart.x(grid.best[2]), y1: chart.y(required), y2: chart.y(required)});
        if (grid.best) make(chart.svg, "circle", {r: 5, class: "best", cx: chart.x(grid.best[0]), cy: chart.y(required)});
      }
      const here = along(state[axis.key])[0];
      if (here <= top()) make(chart.svg, "circle", {r: 6, class: "here", cx: chart.x(state[axis.key]), cy: chart.y(here)});
      hover(chart, ends, value => describe(nearest(axis, value)), () => state[axis.key])();
    };
  }

  function curveCharts(parent) {
    const [axis] = grid.axes, {size, best} = grid, at = value => `At ${valueText(axis, value)}`;
    const required = `${size.label} ${text(size.start)} ${size.unit}`;
    const largest = () => 1.05 * Math.max(size.start, ...axis.values.map(value => sizes({...state, [axis.key]: value})[1][2]).filter(one => one < 20 * size.start));
    const known = grid.falls ? "force needed" : "length", shaded = "Shaded: suffices with 95 % confidence.";
    const found = best ? ` Ring: best, ${text(best[0])} ${axis.unit} (${text(best[1])} to ${text(best[2])} ${axis.unit}).` : "";
    const sizeChart = curveChart(parent, `${data.words.size} [${size.unit}]`, largest, one => sizes(one)[1], value => {
      const [one, low, high] = sizes({...state, [axis.key]: value})[1];
      return `${at(value)}: ${known} ${text(one)} ${size.unit} (${text(low)} to ${text(high)}). Dashed: ${required}. ${shaded}${found}`;
    });
    const percents = one => { const {share, low, high} = stuckOn(one); return [share, low, high].map(part => 100 * part); };
    const stuck = curveChart(parent, "P(stuck) [%]", () => 100, percents, value => `${at(value)}: ${stuckText(stuckOn({...state, [axis.key]: value}))}. ${shaded}`);
    return [() => sizeChart(size.start), () => stuck()];
  }

  const all = values => (values ?? []).flat(Infinity).filter(value => value !== null);
  const allSafe = all(grid.safe);

  function safeChart(parent, axis) {
    const ends = [axis.values[0], axis.values[axis.values.length - 1]], unit = grid.size.unit;
    const top = 1.05 * Math.max(...allSafe) * (1 + Math.max(0, ...all(grid.noise)));
    const chart = axesOf(parent, `${data.words.safe} against ${axis.label}`, ends, [0, top], [nameOf(axis), `${data.words.safe} [${unit}]`]);
    const noise = () => axis === grid.axes[0] ? noiseAt(state) : NaN, ragged = make(chart.svg, "path", {class: "band"});
    const curve = make(chart.svg, "path", {class: "curve"}), marks = axis.values.map(() => make(chart.svg, "circle", {r: 3, class: "mark"}));
    const dot = make(chart.svg, "circle", {r: 6, class: "here"});
    const safe = value => safeSize({...state, [axis.key]: value});
    const describe = value => `At ${valueText(axis, value)}${together({...state, [axis.key]: value})}: ${data.words.bound} ${safeText(safe(value))} ${unit}. Small dots: simulated; sizes to build between stated airs are interpolated.${Number.isFinite(noise()) ? ` Band: error between them, ± ${text(100 * noise(), 2)} %.` : ""}`;
    const caption = hover(chart, ends, value => describe(nearest(axis, value)), () => state[axis.key]);
    return () => {
      const points = axis.between ? spread(...ends).map(value => [value, safe(value)]) : [];
      const along = factor => points.map(([value, one]) => [chart.x(value), chart.y(factor * one)]);
      curve.setAttribute("d", path(along(1)));
      ragged.setAttribute("d", Number.isFinite(noise()) ? path([...along(1 - noise()), ...along(1 + noise()).reverse()]) : "");
      axis.values.forEach((value, k) => {
        marks[k].setAttribute("cx", chart.x(value));
        marks[k].setAttribute("cy", chart.y(safe(value)));
      });
      dot.setAttribute("cx", chart.x(state[axis.key]));
      dot.setAttribute("cy", chart.y(safe(state[axis.key])));
      caption();
    };
  }

  // Study

  /** YAML of nested mappings; everything else as JSON, which YAML contains. */
  function yaml(value, indent = "") {
    return Object.entries(value).map(([key, part]) => {
      const isMapping = part !== null && typeof part === "object" && !Array.isArray(part) && Object.keys(part).length;
      return `${indent}${JSON.stringify(key)}:${isMapping ? `\n${yaml(part, `${indent}  `)}` : ` ${leaf(part)}\n`}`;
    }).join("");
  }

  /** Numbers such as 1e-7 need a point in YAML. */
  function leaf(value) {
    if (Array.isArray(value)) return `[${value.map(leaf).join(", ")}]`;
    if (typeof value === "number") return String(value).replace(/^(-?\d+)e/, "$1.0e");
    if (value !== null && typeof value === "object") return `{${Object.entries(value).map(([key, part]) => `${JSON.stringify(key)}: ${leaf(part)}`).join(", ")}}`;
    return JSON.stringify(value);
  }

  function study() {
    const section = {...data.section}, shares = data.study.design?.shares ?? grid.share.values, whole = structuredClone(data.study);
    for (const axis of controls) {
      const {setting, key} = axis, moved = state[key] !== axis.start || ["length_um", "humidity", "tilt_deg"].includes(key);
      if (!setting || setting === "shares" || !moved) continue;
      if (setting.includes(".")) {
        const path = setting.split("."), last = path.pop();
        path.reduce((part, name) => part[name] ??= {}, whole)[last] = state[key];
        continue;
      }
      section[setting] = ["humidities", "tilt_deg"].includes(setting) ? [state[key]] : state[key];
    }
    const all = [...new Set([...shares, state.share])].sort((a, b) => b - a);
    const design = grid.share.setting ? {design: {...data.study.design, shares: all}} : {};
    return yaml({...whole, ...design, devices: {[data.name]: section}});
  }

  function copied(place, status) {
    place.hidden = false;
    place.value = study();
    place.select();
    try { document.execCommand("copy"); } catch { /* the text is selected */ }
    navigator.clipboard?.writeText(place.value).catch(() => {});
    const note = data.words.copied && ` ${data.words.copied.replace("{value}", state[grid.axes[0].key])}.`;
    status.textContent = `Copied. Save it as mine.yaml and run: stiction run mine.yaml.${note || ""}`;
  }

  // Start

  const panel = make(root, "div", {class: "controls"});
  for (const axis of controls) control(panel, axis);
  const answers = make(panel, "div", {class: "answers", "aria-live": "polite"});
  shown = Object.fromEntries((data.forbidden ? ["forbidden"] : grid.lines ? ["enough", "size", "stuck", "margin"] : ["stuck", "safe"]).map(name => [name, make(answers, "p", {"data-answer": name})]));
  const buttons = make(panel, "p"), copy = make(buttons, "button", {type: "button"}, "Copy as YAML");
  const reset = make(buttons, "button", {type: "button"}, "Back to this device");
  const status = make(panel, "p", {class: "note", role: "status"});
  const place = make(panel, "textarea", {readonly: "", rows: 8, "aria-label": "study as YAML", hidden: ""});
  copy.addEventListener("click", () => copied(place, status));
  const figures = make(root, "div", {class: "charts"}), moving = grid.axes.filter(axis => axis.values.length > 1 && allSafe.length);
  const charts = data.forbidden ? [] : grid.lines ? curveCharts(figures) : [stuckChart(figures), ...moving.slice(0, 1).map(axis => safeChart(figures, axis))];
  let state, refused;
  const start = () => { [state, refused] = fromAddress(); refresh(refused); };
  reset.addEventListener("click", () => { state = Object.fromEntries(controls.map(axis => [axis.key, axis.start])); refresh({}); });
  return start;
}

// Views

let current, start;

function view(number) {
  if (number !== current) start = opened(current = number);
  menu.value = String(number);
  start();
}

function follow() {
  const asked = Number(address().get("view"));
  view(asked in content.views ? asked : 0);
}

content.views.forEach(({title}, number) => { menu.append(new Option(title, number)); });
menu.closest("p").hidden = content.views.length === 1;
menu.addEventListener("change", () => view(Number(menu.value)));
addEventListener("hashchange", () => { if (location.hash.includes("=")) follow(); });
addEventListener("beforeprint", () => document.querySelectorAll("details").forEach(part => { part.open = true; }));
document.getElementById("explore").hidden = false;
follow();
})();
