// Arithmetic of stiction.estimate in JavaScript: the same steps in SI units, compared with Python in tests/estimate/test_page.py.
"use strict";
const SCORES = [0, -1, -2], LEAST = 2e-3, GAS = 8.31446261815324;
const sum = (values) => values.reduce((total, value) => total + value, 0);
const dot = (left, right) => sum(left.map((x, k) => x * right[k]));

// statistics
function momentsOf(corner, cutoff, slope) {
  const moment = (order) => {
    const power = order + 2 + slope, ratio = cutoff / corner;
    const beyond = Math.abs(power) < 1e-9 ? Math.log(ratio) : (ratio ** power - 1) / power;
    return corner ** (order + 2) * (1 / (order + 2) + beyond);
  };
  return [-1, 2, 4].map((order) => moment(order) / moment(0));
}
function heights(surface) {
  const {rms_nm, skewness, kurtosis, hurst, corner_rad_per_um, cutoff_rad_per_um} = surface;
  return {rms: rms_nm * 1e-9, skewness, kurtosis, moments: momentsOf(corner_rad_per_um * 1e6, cutoff_rad_per_um * 1e6, -2 * (1 + hurst))};
}
function added(one, other) {
  const rms = Math.hypot(one.rms, other.rms), both = [one, other];
  const weighted = (power, value) => sum(both.map((each) => (each.rms / rms) ** power * value(each)));
  return {rms, skewness: weighted(3, (each) => each.skewness), kurtosis: 3 + weighted(4, (each) => each.kurtosis - 3),
    moments: [0, 1, 2].map((k) => weighted(2, (each) => each.moments[k]))};
}

// state
const REFERENCE = 300, THINNEST = 3 * 2.8e-10;
function surfaceTension(temperature) {
  const tau = 1 - temperature / 647.096;
  return 0.2358 * tau ** 1.256 * (1 - 0.625 * tau);
}
function density(temperature) {
  const polynomial = (factors) => factors.reduceRight((total, factor) => factor + total * (temperature - 273.15), 0);
  return polynomial([999.83952, 16.945176, -7.9870401e-3, -46.170461e-6, 105.56302e-9, -280.54253e-12]) / polynomial([1, 16.879850e-3]);
}
function film(humidity, temperature, wetting, [tension, volume]) {
  const energy = tension * surfaceTension(temperature) / surfaceTension(REFERENCE) * wetting;
  const height = energy * volume * density(REFERENCE) / density(temperature) / (-GAS * temperature * Math.log(humidity));
  if (height < THINNEST) throw new NotLearnt("the film of water is too thin to be a liquid: state a higher humidity, or dry");
  return {height, energy};
}

// solids
const POLYSILICON = {modulus: 164e9, beamModulus: 164e9, throughWater: 9.75e-20, inDryAir: 1.865e-19, wetting: 2}, ROUNDING = 1e-9;
const OF_WATER = 37e-21, following = (throughWater) => (Math.sqrt(throughWater) + Math.sqrt(OF_WATER)) ** 2;
function besideWater({throughWater, inDryAir, modulus}, {energy}, [tension]) {
  const own = POLYSILICON, byWater = own.wetting * tension / energy, water = throughWater / own.throughWater * byWater;
  const air = inDryAir / own.inDryAir * byWater / (following(water * own.throughWater) / following(own.throughWater));
  return [water, air, modulus / own.modulus * byWater];
}
const CHANGES = ["attraction", "attraction_through_air", "stiffness"], OF_SOLIDS = [
  "attraction of the solids beside that of the water (from Hamaker constant and contact angles)",
  "attraction of the solids through air beside that through water (from Hamaker constants and contact angles)",
  "stiffness of the solids beside that of the water (from moduli and contact angles)"];
function onSolids(process, ratios, place, part) {
  const by = ratios.map(Math.log), changed = {...known(process, place, part.coordinates)};
  CHANGES.forEach((name, k) => {
    if (!by[k]) return;
    const byOne = known(part[name], [...place, ...by], [...part.coordinates, ...OF_SOLIDS]);
    for (const each of ["at_0", "at_1", "at_2"]) changed[each] += by[k] * byOne[each];
  });
  return changed;
}
const curvature = ({moments: [, second, fourth]}) => Math.sqrt(fourth / second);
const tensionOf = ({height, energy}) => energy / height;
function ofContact({heights, film, modulus, besideWater: [, , stiffness]}) {
  const [low, second, fourth] = heights.moments, slope = heights.rms * Math.sqrt(second);
  return [Math.log(heights.rms / film.height), Math.log(tensionOf(film) / (modulus / stiffness * slope)), Math.log(fourth / second ** 2),
    Math.log(low ** 2 * second), heights.skewness, heights.kurtosis];
}
const floodedSlope = (state) => (13.5 * state.film.energy / state.stiffness) ** 0.25;
function coordinates(state) {
  const summits = curvature(state.heights), slope = state.heights.rms * Math.sqrt(state.heights.moments[1]);
  return [...ofContact(state), Math.log(floodedSlope(state) / slope), Math.log(state.width * summits), Math.log(state.film.height), Math.log(summits)];
}
function ofPatch(patch) {
  const summits = curvature(patch.heights);
  return [...ofContact(patch), Math.log(patch.area * summits ** 2), Math.log(patch.film.height), Math.log(summits)];
}

// table
function at(process, all) {
  const known = process.columns.map((k) => all[k]);
  const standard = known.map((x, k) => (x - process.centre[k]) / process.scale[k]);
  const place = standard.map((x, k) => x / process.lengths[k]);
  const squares = process.nodes.map((node) => sum(place.map((x, k) => (x - node[k]) ** 2)));
  const near = squares.map((square) => Math.exp(-0.5 * square)), terms = [1, ...standard], of = {};
  for (const name in process.trend) of[name] = dot(process.trend[name], terms) + dot(process.weights[name], near);
  const outside = process.columns.filter((_, k) => !(process.low[k] <= known[k] && known[k] <= process.high[k]));
  return {of, distance: Math.sqrt(Math.min(...squares)), outside};
}

// length
class NotLearnt extends Error {}
function known(process, place, names) {
  const values = at(process, place);
  if (values.outside.length) {
    const [first] = values.outside, side = place[first] > process.centre[process.columns.indexOf(first)] ? "large" : "small";
    throw new NotLearnt(`${names[first]} is too ${side}, beyond what was learnt`);
  }
  if (values.distance > process.farthest) throw new NotLearnt("its numbers together are unlike all that was learnt: change the humidity or the rms");
  return values.of;
}
function falling(values, shift) {
  const first = values.at_0 + shift, second = Math.min(first - LEAST, values.at_1 + shift);
  const third = Math.min(second - LEAST, values.at_2 + shift);
  return {logarithms: [first, second, third], slope: Math.max(LEAST, values.slope)};
}
function onSummits(state, gap, table) {
  return falling(onSolids(table.tips, state.besideWater, coordinates(state), table), Math.log(1.5 * gap / floodedSlope(state)));
}
function lengthAt({logarithms: [first, second, third], slope}, score) {
  const [, b, c] = SCORES;
  if (score <= c) return Math.exp(third + slope * (score - c));
  const [low, step, start] = score <= b ? [third, second - third, c] : [second, first - second, b];
  return Math.exp(low + step * (score - start));
}
function change(state, found, gap, table) {
  const slope = 1.5 * gap / lengthAt(found, -2);
  const atSlope = coordinates({...state, stiffness: 13.5 * state.film.energy / slope ** 4});
  const ratio = Math.exp(known(table.full, atSlope, table.coordinates).ratio);
  const scatter = 4 * (found.logarithms[0] - found.logarithms[2]) / 2;
  const ofMeans = 1.17 * Math.sqrt(Math.expm1(scatter ** 2) * (1 / 7 + 1 / 63));
  return ratio * Math.exp(1.645 * Math.hypot(ofMeans, 0.1 * scatter * Math.max(3.09 - scatter, 0)));
}
function lengths(state, gap, table) {
  let found = onSummits(state, gap, table);
  for (let k = 0; k < 2; k++) {
    found = onSummits({...state, stiffness: state.stiffness / change(state, found, gap, table)}, gap, table);
  }
  return found;
}

// force: its reciprocal stands for a length
function reciprocals(patch, stoppers) {
  const place = ofPatch(patch), {ratio, power} = known(stoppers.full, place, stoppers.coordinates);
  const values = onSolids(stoppers.forces, patch.besideWater, place, stoppers);
  return changedBy(falling(values, -Math.log(tensionOf(patch.film) * patch.area)), ratio, Math.max(1, power));
}
function changedBy({logarithms, slope}, ratio, power) {
  const [median, , last] = logarithms, scatter = (median - last) / 2;
  const shift = median - ratio - (1 - power ** 2) * scatter ** 2 / 2;
  return {logarithms: logarithms.map((each) => shift + power * (each - median)), slope: power * slope};
}

// dry air
const AT_REST = (2 / 15) ** (1 / 6) * 2.09e-10;
const workOf = (constant) => constant / (16 * Math.PI * AT_REST ** 2), slopeOf = ({rms, moments}) => rms * Math.sqrt(moments[1]);
function ofDryContact({heights, constant, modulus}) {
  const [low, second, fourth] = heights.moments;
  return [Math.log(heights.rms), Math.log(workOf(constant) / (AT_REST * modulus * slopeOf(heights))), Math.log(fourth / second ** 2),
    Math.log(low ** 2 * second), heights.skewness, heights.kurtosis, Math.log(curvature(heights))];
}
const flatSlope = ({constant, stiffness}) => (13.5 * workOf(constant) / stiffness) ** 0.25;
function ofDryTip(tip) {
  return [...ofDryContact(tip), Math.log(flatSlope(tip) / slopeOf(tip.heights)), Math.log(tip.width * curvature(tip.heights))];
}
const ofDryPatch = (patch) => [...ofDryContact(patch), Math.log(patch.area * curvature(patch.heights) ** 2)];
function dryLengths(tip, gap, {tips, full, coordinates: names}) {
  const onSummits = (one) => falling(known(tips, ofDryTip(one), names), Math.log(1.5 * gap / flatSlope(one)));
  let found = onSummits(tip), power = 1;
  for (let k = 0; k < 2; k++) {
    const slope = 1.5 * gap / lengthAt(found, -2), scatter = 4 * (found.logarithms[0] - found.logarithms[2]) / 2;
    const change = known(full, ofDryTip({...tip, stiffness: 13.5 * workOf(tip.constant) / slope ** 4}), names);
    power = Math.max(1, change.power);
    found = onSummits({...tip, stiffness: tip.stiffness / Math.exp(change.ratio + (1 - power ** 2) * scatter ** 2 / 2)});
  }
  return scattered(found, power, 0);
}
function scattered({logarithms, slope}, power, shift) {
  const [median] = logarithms;
  return {logarithms: logarithms.map((each) => median + shift + power * (each - median)), slope: power * slope};
}
function dryReciprocals(patch, {forces, full, coordinates: names}) {
  const place = ofDryPatch(patch), change = known(full, place, names), power = Math.max(1, change.power);
  const found = falling(known(forces, place, names), -Math.log(workOf(patch.constant) / AT_REST * patch.area));
  const scatter = (found.logarithms[0] - found.logarithms[2]) / 2;
  return scattered(found, power, -change.ratio - (1 - power ** 2) * scatter ** 2 / 2);
}
function ofStopper({sides, force, added, solids = POLYSILICON}, {water: ofWater, stoppers, dry}) {
  const [one, other] = sides, {modulus} = solids;
  const areaOf = ({sides: [low, high]}) => {
    if (!sides.every((side) => low * 1e-6 <= side && side <= high * 1e-6)) throw new NotLearnt(`sides of a stopper must be from ${low} to ${high} µm`);
    return one * other;
  };
  return {
    lengths: (heights, water) =>
      reciprocals({heights, film: water, area: areaOf(stoppers), modulus, besideWater: besideWater(solids, water, ofWater)}, stoppers),
    inDryAir: (heights) => dryReciprocals({heights, constant: solids.inDryAir, area: areaOf(dry.stoppers), modulus}, dry.stoppers),
    closed: pulledBy(added || 0), errors: (part) => part.stoppers, stated: force && 1 / force,
    row: ({length, intervals}) => ({size: 1 / length, intervals: Object.fromEntries(Object.entries(intervals).map(([key, [low, high]]) => [key, [1 / high, 1 / low]]))}),
  };
}

// bridge: lengths without stress stand for those under it
const DIFFERENT = 0.03, UNITS = {um: 1e-6, MPa: 1e6};
function endStiffness(kl) {
  const mean = kl ? Math.tanh(kl / 2) / (kl / 2) : 1;
  const force = kl < DIFFERENT ? 12 / (1 - kl ** 2 / 10 + 17 * kl ** 4 / 1680) : kl ** 2 / (1 - mean);
  return [force, force * mean / 2];
}
function stretchedBy(stress, thickness, modulus, factor = 1) {
  const decay = Math.sqrt(12 * stress / modulus) / thickness, ends = (length) => endStiffness(decay * length / 2);
  const bare = (length) => { const [force, moment] = ends(length); return length * (864 / (force ** 2 * moment)) ** 0.125 / factor; };
  const under = (short) => {
    let length = short;
    for (let k = 0; k < 60; k++) length *= short / bare(length);
    return length;
  };
  return {bare, length: under, decay};
}
const heldBy = ({thickness, gap, modulus}) => 768 * (modulus * thickness ** 3) ** 2 * gap ** 3;
function floodedLength(state) {
  return (heldBy(state) / (state.film.energy ** 2 / state.film.height)) ** 0.125;
}
function contactOf(state) {
  return 8 * state.modulus * state.thickness ** 3 * state.gap / (floodedLength(state) ** 3 * tensionOf(state.film));
}
const middleOf = (state) => ({...state, area: state.width * contactOf(state), modulus: state.inContact});
function ofMiddle(state, {decay}) {
  const contact = contactOf(state);
  return [...ofPatch(middleOf(state)), Math.log(state.gap / state.film.height), decay * contact];
}
function lengthsOfBridge(state, closed, bridges) {
  const place = ofMiddle(state, closed), {shift, power} = known(bridges.full, place, bridges.coordinates);
  const values = onSolids(bridges.middle, state.besideWater, place, bridges);
  const {logarithms, slope} = falling(values, Math.log(floodedLength(state))), [median] = logarithms;
  const found = {logarithms: logarithms.map((each) => median + shift + power * (each - median)), slope: power * slope};
  const isUntested = Math.exp(found.logarithms[2]) / floodedLength(state) > bridges.longest;
  if (isUntested) throw new NotLearnt("it sticks so weakly that no bridge as long was tested");
  return found;
}
function pullOff(state, stoppers) {
  const [low, high] = stoppers.sides.map((side) => (side * 1e-6) ** 2), middle = middleOf(state);
  const patch = {...middle, area: Math.min(Math.max(middle.area, low), high)};
  return Math.exp(-reciprocals(patch, stoppers).logarithms[0]) / patch.area;
}
function shorterBy({logarithms: [median]}, held, pull, {energy, tension}) { // at a voltage
  return ((1 + energy / (held / (Math.exp(median) ** 8 * pull))) * (1 + tension / pull)) ** -0.125;
}
const DRY_AREA = 9e-12;
function dryLengthsOfBridge({thickness, gap, width, modulus}, patch, pull, {middle, coordinates: names}) {
  const rigidity = modulus * thickness ** 3, length = (heldBy({thickness, gap, modulus}) / (pull ** 2 * AT_REST)) ** 0.125;
  const area = width * 8 * rigidity * gap / (length ** 3 * pull);
  const place = [...ofDryPatch(patch).slice(0, 2), Math.log(area * curvature(patch.heights) ** 2)];
  return falling(known(middle, place, names), Math.log(length));
}
function ofBridge({thickness, gap, width, stress, length, added = 0, tension = 0, solids = POLYSILICON}, {water: ofWater, bridges, stoppers, dry}) {
  const modulus = solids.beamModulus, closed = stretchedBy(stress, thickness, modulus);
  const stateOf = (heights, water) => ({heights, film: water, thickness, gap, width, modulus, inContact: solids.modulus, besideWater: besideWater(solids, water, ofWater)});
  const dryPatch = (heights) => ({heights, constant: solids.inDryAir, area: DRY_AREA, modulus: solids.modulus});
  const dryPull = (heights) => Math.exp(-dryReciprocals(dryPatch(heights), dry.stoppers).logarithms[0]) / DRY_AREA;
  const refuse = () => {
    const sizes = {thickness, gap, width, stress};
    for (const [name, [low, high, unit]] of Object.entries(bridges.ranges)) {
      const outside = !(low * UNITS[unit] <= sizes[name] && sizes[name] <= high * UNITS[unit]), symbol = unit.replace("u", "µ");
      if (outside) throw new NotLearnt(`the ${name} of a bridge must be from ${low} to ${high} ${symbol}`);
    }
  };
  return {
    lengths: (heights, water) => { refuse(); return lengthsOfBridge(stateOf(heights, water), closed, bridges); },
    closedOn: (pairs, found, water) => {
      const pull = (heights) => water ? pullOff(stateOf(heights, water), stoppers) : dryPull(heights), held = heldBy({thickness, gap, modulus});
      const factors = pairs.map((heights, k) => tension ? shorterBy(found[k], held, pull(heights), {energy: added, tension}) : 1);
      return stretchedBy(stress, thickness, modulus, Math.min(...factors));
    },
    inDryAir: (heights) => {
      refuse();
      return dryLengthsOfBridge({thickness, gap, width, modulus}, dryPatch(heights), dryPull(heights), dry.bridges);
    },
    closed, errors: (part) => part.bridges, stated: length, row: ({length, intervals}) => ({size: length, intervals}),
  };
}
function ofCantilever({thickness, gap, width, length, added, solids = POLYSILICON}, table) {
  const stiffness = solids.beamModulus * thickness ** 3 / gap ** 2, {modulus} = solids;
  return {
    lengths: (heights, water) => lengths({heights, film: water, stiffness, width, modulus, besideWater: besideWater(solids, water, table.water)}, gap, table),
    inDryAir: (heights) => dryLengths({heights, constant: solids.inDryAir, stiffness, width, modulus}, gap, table.dry),
    closed: drivenBy(8 * (added || 0) / (3 * stiffness * gap ** 4)), errors: (part) => part, stated: length,
    row: ({length, intervals}) => {
      if (length <= Math.max(thickness, gap)) throw new NotLearnt("it sticks even at a length below its gap or thickness: change voltage or dielectric");
      return {size: length, intervals};
    },
  };
}

// bending: deflections with a curvature of one Legendre polynomial each
const POLYNOMIALS = 16, POINTS = 32, SETTLED = 1e-12, GOLDEN = (Math.sqrt(5) - 1) / 2, SLACK = 0.03, BASES = {};
function legendre(x, number) {
  const values = [1, x];
  for (let n = 1; n < number - 1; n++) values.push(((2 * n + 1) * x * values[n] - n * values[n - 1]) / (n + 1));
  return values;
}
function integral(series) {
  const total = [series[0], series[0], ...Array(series.length - 1).fill(0)];
  for (let n = 1; n < series.length; n++) { total[n + 1] += series[n] / (2 * n + 1); total[n - 1] -= series[n] / (2 * n + 1); }
  return total;
}
function gauss(number) {
  return Array.from({length: number}, (_, k) => {
    let x = Math.cos(Math.PI * (k + 0.75) / (number + 0.5)), slope;
    for (let step = 0; step < 8; step++) {
      const values = legendre(x, number + 1);
      slope = number * (values[number - 1] - x * values[number]) / (1 - x * x);
      x -= values[number] / slope;
    }
    return [(1 + x) / 2, 1 / ((1 - x * x) * slope ** 2)];
  });
}
function basisOf(clamps) {
  if (BASES[clamps]) return BASES[clamps];
  const orders = Array.from({length: POLYNOMIALS}, (_, k) => clamps === 1 ? k : 2 * k + 2);
  const slopes = orders.map((order) => integral([...Array(order).fill(0), 1])), series = slopes.map(integral), areas = series.map(integral);
  const valuesOf = (rows, scale) => (x) => { const at = legendre(2 * x - 1, rows[POLYNOMIALS - 1].length); return rows.map((row) => dot(row, at) / scale); };
  const deflections = valuesOf(series, 4), rule = gauss(POINTS), at = rule.map(([x]) => deflections(x / clamps));
  const over = (one, other) => sum(one.map((x, n) => x * other[n] / (4 * (2 * n + 1))));
  return BASES[clamps] = {at, deflections, areas: valuesOf(areas, 8), end: deflections(1 / clamps), bending: orders.map((order) => 1 / (2 * order + 1)),
    weighted: orders.map((_, k) => rule.map(([, weight], p) => weight * at[p][k])), slope: slopes.map((row) => over(row, row)),
    coupling: slopes.slice(1).map((row, k) => over(slopes[k], row))};
}
function bentBy(clamps, tension, forces) {
  const {bending, slope, coupling} = basisOf(clamps), bent = [...forces], last = POLYNOMIALS - 1;
  const stiffness = bending.map((each, k) => each + tension * slope[k]), couplings = coupling.map((each) => tension * each);
  for (let k = 0; k < last; k++) {
    const ratio = couplings[k] / stiffness[k];
    stiffness[k + 1] -= ratio * couplings[k];
    bent[k + 1] -= ratio * bent[k];
  }
  bent[last] /= stiffness[last];
  for (let k = last - 1; k >= 0; k--) bent[k] = (bent[k] - couplings[k] * bent[k + 1]) / stiffness[k];
  return bent;
}
function largest(value, upper) {
  let low = 0.02 * upper, high = 0.98 * upper, left = high - GOLDEN * (high - low), right = low + GOLDEN * (high - low);
  let [atLeft, atRight] = [left, right].map(value);
  for (let k = 0; k < 26; k++) {
    if (atLeft > atRight) { [high, right, atRight] = [right, left, atLeft]; left = high - GOLDEN * (high - low); atLeft = value(left); }
    else { [low, left, atLeft] = [left, right, atRight]; right = low + GOLDEN * (high - low); atRight = value(right); }
  }
  return Math.max(atLeft, atRight);
}
function settled(step, start) {
  for (let k = 0, before = start; k < 500; k++) {
    const numbers = step(before);
    if (Math.max(...numbers.map((x, n) => Math.abs(x - before[n]))) < SETTLED) return numbers;
    before = numbers;
  }
  throw new Error("the deflection or length of a beam does not settle");
}
const settledLength = (step, start) => Math.exp(settled(([logarithm]) => [Math.log(step(Math.exp(logarithm)))], [Math.log(start)])[0]);

// life: lengths of beams that dry, and shock
const HALF_SINE = 1.7685, OF_CANTILEVER = 1.0290535885833705, DENSITY = 2330, MODES = 24;
const tensionAt = ({stress = 0, modulus, thickness}, length) => 12 * stress / modulus * (length / thickness) ** 2;
const scaleOf = ({modulus, thickness, gap}, liquid) => modulus * thickness ** 3 * gap ** 2 / (24 * liquid);
function standingEach(beam, liquid) {
  const {clamps, gap, width} = beam, scale = scaleOf(beam, liquid), unit = gap / 2, {at, end, weighted} = basisOf(clamps);
  const along = (u) => { const ratio = width / (gap * (1 - u)); return (ratio + Math.hypot(ratio, 2)) * unit / width; };
  const lengthOf = (logarithm) => (Math.exp(logarithm) * scale) ** 0.25;
  const balance = (deflection) => lengthOf(settled(([logarithm, ...factors]) => {
    const length = lengthOf(logarithm), loads = at.map((row) => along(dot(row, factors))), atEnd = clamps === 1 ? unit / length : 0;
    const bent = bentBy(clamps, tensionAt(beam, length), weighted.map((row, k) => dot(row, loads) + atEnd * end[k])), factor = deflection / dot(end, bent);
    return [Math.log(factor), ...bent.map((each) => factor * each)];
  }, Array(1 + POLYNOMIALS).fill(0))[0]);
  return largest(balance, 1);
}
function standing(beam, liquid) {
  const {clamps} = beam, scale = scaleOf(beam, liquid), {areas, deflections} = basisOf(clamps);
  return settledLength((length) => {
    const tension = tensionAt(beam, length);
    const pull = (begin) => {
      const before = areas(begin), forces = areas(clamps === 1 ? 1 : 1 - begin).map((area, k) => area - before[k]);
      return dot(bentBy(clamps, tension, forces), deflections(begin));
    };
    return (scale / (4 * largest(pull, 1 / clamps))) ** 0.25;
  }, scale ** 0.25);
}
function released(beam, liquid) {
  const {clamps} = beam;
  const crack = arrested(beam, 2 * liquid);
  return clamps === 1 ? crack / Math.SQRT2 : 2 * crack;
}
function arrested(beam, energy) {
  const {modulus, thickness, gap} = beam;
  const pull = Math.sqrt(24 * energy / (modulus * thickness ** 3)) / gap, decay = Math.sqrt(tensionAt(beam, 1));
  return settledLength((crack) => Math.sqrt(endStiffness(decay * crack)[1] / pull), Math.sqrt(6 / pull));
}
function byMode(number, tension) {
  let low = (2 * number - 1) * Math.PI, high = 2 * number * Math.PI;
  const other = (a) => Math.sqrt(a * a + tension), slope = (a) => a * Math.tan(a / 2) + other(a) * Math.tanh(other(a) / 2);
  for (let k = 0; k < 60; k++) {
    const middle = 0.5 * (low + high);
    if (slope(middle) < 0) low = middle; else high = middle;
  }
  const a = 0.5 * (low + high), b = other(a), byA = Math.tan(a / 2) / a, byB = Math.tanh(b / 2) / b;
  const square = 1 / (2 * Math.cos(a / 2) ** 2) + byA + 1 / (2 * Math.cosh(b / 2) ** 2) + byB;
  return (1 / Math.cos(a / 2) - 1 / Math.cosh(b / 2)) * 2 * (byA - byB) / ((a * b) ** 2 * square);
}
function halfSineShock(beam, length) {
  const {clamps, modulus, thickness, gap} = beam, tension = tensionAt(beam, length), k = Math.sqrt(tension);
  const byUnit = clamps === 1 ? 1 / 8 : k < SLACK ? 1 / 384 - k ** 2 / 15360 : (1 / 8 - Math.tanh(k / 4) / (2 * k)) / k ** 2;
  const modes = Array.from({length: MODES}, (_, n) => clamps === 1 ? 0 : Math.abs(byMode(n + 1, tension)));
  const overshoot = clamps === 1 ? OF_CANTILEVER : sum(modes) / byUnit;
  return modulus * thickness ** 2 * gap / (12 * DENSITY * length ** 4 * byUnit) / (HALF_SINE * overshoot);
}
const beamOf = ({stress, thickness, gap, width, solids = POLYSILICON}) =>
  ({clamps: stress === undefined ? 1 : 2, stress, thickness, gap, width, modulus: solids.beamModulus});
function lifeOf(question) {
  const beam = beamOf(question), {liquid, length} = question;
  const dried = liquid ? [standingEach, standing, released].map((of) => of(beam, liquid)) : null;
  return {dried, shock: halfSineShock(beam, length)};
}

// flats: surfaces in contact, with water in all gaps where it condenses
const EDGE = 0.1e-6, WAVELENGTH = 100e-9, RANGE = 0.97 * 2 ** (1 / 6) * 2.09e-10, SHORTER = Math.log(0.98), SLOPES = 64;
function workAcross(constant, gap) {
  const near = AT_REST / (AT_REST + gap);
  return workOf(constant) * 4 / 3 * (near ** 2 / (1 + 5.32 * gap / WAVELENGTH) - near ** 8 / 4);
}
function attractionsOf({throughWater, inDryAir}, film) {
  const farthest = inDryAir / (6 * Math.PI * AT_REST ** 3) * 2 / Math.sqrt(27), work = workOf(film ? throughWater : inDryAir);
  const beyond = film ? workAcross(inDryAir, film.height) - workAcross(throughWater, film.height) : 0;
  const solids = {energy: work + beyond, most: work / RANGE + farthest};
  return film ? [solids, {energy: film.energy, most: tensionOf(film)}] : [solids];
}
function onFlats(question, attractions) {
  const [energy, most] = ["energy", "most"].map((name) => sum(attractions.map((each) => each[name])));
  if (question.sides) return {size: most * question.sides[0] * question.sides[1]};
  const beam = beamOf(question), crack = arrested(beam, energy);
  return beam.clamps === 1 ? {size: crack, tip: atTip(beam, crack, attractions)} : {size: ofFlatMiddle(beam, crack, energy, most)};
}
function atTip({modulus, thickness, gap}, crack, attractions) {
  const sharp = 1.5 * gap / crack * Math.SQRT2, bending = 2 / 27 * modulus * thickness ** 3 / gap ** 2;
  const onEdge = ({energy, most}, slope) => {
    const edge = Math.sqrt(2 * EDGE * energy * most);
    return slope ** 2 * EDGE / 2 < energy / most ? energy / slope + most * slope * EDGE / 2 + edge : 2 * edge;
  };
  const excess = (slope) => Math.log(sum(attractions.map((each) => onEdge(each, slope))) / (bending * slope ** 3));
  const ratio = 4 * Math.exp(excess(sharp) / 3), slopes = Array.from({length: SLOPES + 1}, (_, k) => sharp / 2 * ratio ** (k / SLOPES));
  const held = slopes.findLastIndex((slope) => excess(slope) >= 0), [below, above] = [0, 1].map((k) => excess(slopes[held + k]));
  return 1.5 * gap / (slopes[held] * (slopes[held + 1] / slopes[held]) ** (below / (below - above)));
}
function ofFlatMiddle(beam, crack, energy, most) {
  const {modulus, thickness, gap, width} = beam, stiffness = modulus * width * thickness ** 3 / 12;
  const excess = (logarithm) => {
    const half = Math.exp(logarithm) / 2, [force, moment] = endStiffness(Math.sqrt(tensionAt(beam, half)));
    const pull = 2 * force * stiffness * gap / half ** 3, part = pull / (2 * width * most);
    return moment * gap / half ** 2 * part ** 2 / 2 - 7 / 48 * pull * part ** 3 / stiffness - energy / most;
  };
  for (let longer = Math.log(2 * crack); longer > Math.log(thickness); longer += SHORTER) {
    if (excess(longer + SHORTER) <= 0) continue;
    let low = longer + SHORTER, high = longer;
    for (let k = 0; k < 60; k++) {
      const middle = 0.5 * (low + high);
      if (excess(middle) > 0) low = middle; else high = middle;
    }
    return Math.exp(low);
  }
  return 0;
}
function worstOnFlats(question, films) {
  const bounds = films.map((film) => onFlats(question, attractionsOf(question.solids || POLYSILICON, film)));
  const worst = question.sides ? Math.max : Math.min;
  return {size: worst(...bounds.map(({size}) => size)), tip: Math.min(...bounds.map(({tip}) => tip)), isHumid: films.some(Boolean)};
}

// normal distribution: continued fraction and series of erfc
function fractionOf(score) {
  const x = Math.abs(score) / Math.SQRT2, square = x * x;
  let tail;
  if (x < 2.5) {
    let term = x, total = x;
    for (let n = 1; n < 80; n++) { term *= -square / n; total += term / (2 * n + 1); }
    tail = 1 - 2 / Math.sqrt(Math.PI) * total;
  } else {
    let below = 0;
    for (let n = 60; n > 0; n--) below = n / 2 / (x + below);
    tail = Math.exp(-square) / Math.sqrt(Math.PI) / (x + below);
  }
  return score < 0 ? 0.5 * tail : 1 - 0.5 * tail;
}
function normalScore(fraction) {
  let low = -9, high = 9;
  for (let k = 0; k < 60; k++) {
    const middle = 0.5 * (low + high);
    if (fractionOf(middle) < fraction) low = middle; else high = middle;
  }
  return 0.5 * (low + high);
}

// voltage
const PERMITTIVITY = 8.8541878128e-12;
function energyOf(potential, distance, gap) { return PERMITTIVITY * potential ** 2 / 2 * (1 / distance - 1 / (distance + gap)); }
function atVoltage(length, drive) {
  const bare = 1 / length;
  let inverse = bare + drive ** 0.25;
  for (let n = 0; n < 8; n++) inverse -= (inverse ** 4 - bare ** 3 * inverse - drive) / (4 * inverse ** 3 - bare ** 3);
  return 1 / inverse;
}
function withoutVoltage(length, drive) {
  const cube = length ** -3 - drive * length;
  return cube > 0 ? cube ** (-1 / 3) : Infinity;
}
const drivenBy = (drive) => ({length: (bare) => drive ? atVoltage(bare, drive) : bare, bare: (length) => withoutVoltage(length, drive)});
const pulledBy = (added) => ({length: (bare) => bare / (1 + added * bare), bare: (length) => added * length < 1 ? length / (1 - added * length) : Infinity});

// answer
const FRACTIONS = [1e-1, 1e-2, 1e-3, 1e-4, 1e-5, 1e-6], STUDENT = {90: 2.353363, 95: 3.182446};
const MARGINS = {90: ["to_use", "90"], 95: ["95", "95"]}; // margins on the unsafe side and on the other one
function margin(errors, key, score, slope) {
  return errors.margins[key] * Math.hypot(slope, errors.rest) * Math.max(1, score / errors.tested_score);
}
function centre(one, score) {
  if (!one.members.length) return [Math.log(lengthAt(one.stated, score)), 0];
  const values = one.members.map((each) => Math.log(lengthAt(each, score))), m = values.length, mean = sum(values) / m;
  return [mean, Math.sqrt(sum(values.map((value) => (value - mean) ** 2)) / (m - 1)) * Math.sqrt(1 + 1 / m)];
}
function answer(question, table) {
  const kind = question.sides ? ofStopper : "stress" in question ? ofBridge : ofCantilever;
  const {lengths, inDryAir, closed, closedOn, errors, stated, row} = kind(question, table), pairs = [question.stated, ...question.members];
  const solids = question.solids || POLYSILICON, {wetting} = solids, temperature = question.temperature || REFERENCE;
  const isOfPolysilicon = temperature === REFERENCE && Object.keys(POLYSILICON).every((key) => solids[key] === POLYSILICON[key]);
  const errorsOf = (part) => isOfPolysilicon || !part.margins_of_other_solids ? part : {...part, margins: part.margins_of_other_solids};
  const airs = question.humidities.map((air) => {
    const isHumid = air > 0 && wetting > ROUNDING, water = isHumid ? film(air, temperature, wetting, table.water) : null;
    const found = pairs.map((each) => isHumid ? lengths(each, water) : inDryAir(each));
    return {water, stated: found[0], members: found.slice(1), errors: errorsOf(errors(isHumid ? table : table.dry)), closed: closedOn ? closedOn(pairs, found, water) : closed};
  });
  const once = (p) => -Math.expm1(Math.log1p(-p) / question.touchdowns);
  const rows = FRACTIONS.map((fraction) => {
    const score = normalScore(once(fraction)), ends = {};
    for (const confidence of ["90", "95"]) {
      const both = airs.map((one) => endsOf(one, score, confidence).map((end) => one.closed.length(Math.exp(end))));
      ends[confidence] = [0, 1].map((side) => Math.min(...both.map((each) => each[side])));
    }
    const length = (one) => one.closed.length(Math.exp(logarithmOf(one, score, question.averaged)));
    return {fraction, ...row({length: Math.min(...airs.map(length)), intervals: ends})};
  });
  return {rows, stuck: stated ? stuck(question, airs, stated) : null, life: question.sides ? null : lifeOf(question),
    flat: worstOnFlats(question, airs.map(({water}) => water))};
}
const logarithmOf = (one, score, averaged) => averaged ? centre(one, score)[0] : Math.log(lengthAt(one.stated, score));
function endsOf(one, score, confidence) {
  const [mean, scatter] = centre(one, score);
  const [below, above] = MARGINS[confidence].map((key) => Math.hypot(margin(one.errors, key, score, one.stated.slope), STUDENT[confidence] * scatter));
  return [mean - below, mean + above];
}
function scoreAt(logarithm, value) {
  let low = -9, high = SCORES[0];
  for (let k = 0; k < 60; k++) {
    const middle = 0.5 * (low + high);
    if (logarithm(middle) < value) low = middle; else high = middle;
  }
  return high;
}
const after = (score, touchdowns) => -Math.expm1(touchdowns * Math.log1p(-fractionOf(score)));
function stuck(question, airs, stated) {
  const found = airs.map((one) => {
    const value = Math.log(one.closed.bare(stated)), lines = [(score) => logarithmOf(one, score, question.averaged), ...[1, 0].map((k) => (score) => endsOf(one, score, "95")[k])];
    return lines.map((line) => after(scoreAt(line, value), question.touchdowns));
  });
  return [0, 1, 2].map((k) => Math.max(...found.map((each) => each[k])));
}
