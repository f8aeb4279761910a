// Sliders, table and file of the page. The arithmetic is in estimate.js.
const [TABLE, PROMISES] = ["content", "promises"].map((id) => JSON.parse(document.getElementById(id).textContent));
const CANTILEVER = "cantilever", BRIDGE = "bridge", STOPPER = "stopper";
const INPUTS = [
  ["kind", "Device", [CANTILEVER, BRIDGE, STOPPER], CANTILEVER],
  ["thickness_um", "thickness of the beam [µm]", 1, 6, 0.1, 2.6],
  ["gap_um", "gap [µm]", 2, 30, 0.5, 20],
  ["below_um", "gap [µm]", 0.5, 6, 0.1, 2],
  ["width_um", "width of the beam [µm]", 8, 40, 1, 30],
  ["length_um", "length of the beam [µm]", 50, 600, 5, 250],
  ["stress_MPa", "tensile stress [MPa]", 0, 200, 5, 50],
  ["side_um", "one side of the area in contact [µm]", 1, 6, 0.1, 3],
  ["other_um", "other side [µm]", 1, 6, 0.1, 3],
  ["force_uN", "restoring force [µN]", 1, 500, 1, 100],
  ["like", "Typical surface for what you do not know", Object.keys(TABLE.library), "B2"],
  ["rms_nm", "rms of the underside [nm]", 1, 8, 0.1, 3],
  ["substrate", "opposite surface", Object.keys(TABLE.library), "Sub1"],
  ["humidity", "relative humidity", 0.34, 0.92, 0.01, 0.6], // its lowest stop is dry air
  ["touchdowns", "touchdowns", 1, 1000, 1, 1],
  ["voltage_V", "voltage in contact [V]", 0, 50, 0.5, 0],
  ["dielectric_nm", "dielectric, thickness over permittivity [nm]", 10, 1000, 10, 100],
  ["tension_mN_per_m", "surface tension of a liquid that dries, 0 without one [mN/m]", 0, 75, 0.1, 0],
];
const OF_SURFACE = [
  ["hurst", "Hurst exponent", 0.3, 1, 0.05, null],
  ["corner_rad_per_um", "corner of the spectrum [rad/µm]", 8, 60, 1, null],
  ["cutoff_rad_per_um", "cut-off of the spectrum [rad/µm]", 100, 290, 5, null],
  ["skewness", "skewness", -1.2, 0, 0.02, null],
  ["kurtosis", "kurtosis", 3, 6, 0.05, null],
];
const OF_MATERIAL = [
  ["modulus_GPa", "Young's modulus [GPa]", 60, 400, 2, 164],
  ["temperature_K", "temperature of the water [K]", 274, 372, 2, 300],
  ["angle_deg", "contact angle of the underside [°]", 0, 180, 5, 0],
  ["opposite_deg", "contact angle of the opposite surface [°]", 0, 180, 5, 0],
  ["water_zJ", "Hamaker constant through water [zJ]", 2.5, 260, 2.5, 97.5],
  ["dry_zJ", "Hamaker constant through dry air [zJ]", 60, 480, 0.5, 186.5],
];
const OWN = {[CANTILEVER]: ["thickness_um", "gap_um", "width_um", "length_um", "voltage_V", "dielectric_nm", "tension_mN_per_m"],
  [BRIDGE]: ["thickness_um", "below_um", "width_um", "length_um", "stress_MPa", "voltage_V", "dielectric_nm", "tension_mN_per_m"], [STOPPER]: ["side_um", "other_um", "force_uN", "voltage_V", "dielectric_nm"]};
const DRY = "dry", DRIEST = 0.345, airOf = (value) => value("humidity") < DRIEST ? DRY : value("humidity");
const PAIR = ["known_skewness", "known_kurtosis"]; // a file states both or neither
const OPEN = OF_SURFACE.map(([key]) => key), byId = (id) => document.getElementById(id);

function slider([key, words, low, high, step, start]) {
  if (Array.isArray(low)) {
    const options = low.map((name) => `<option${name === high ? " selected" : ""}>${name}</option>`).join("");
    return `<label for="${key}">${words}<select id="${key}">${options}</select></label>`;
  }
  const known = OPEN.includes(key) ? `<label for="known_${key}">${words} is known<input type="checkbox" id="known_${key}"></label>` : "";
  return `${known}<label for="${key}">${words}<output id="of_${key}"></output>
    <input type="range" id="${key}" min="${low}" max="${high}" step="${step}" value="${start ?? typical("B2")[key]}"></label>`;
}
function typical(name) {
  const entry = TABLE.library[name], psd = entry.published_psd;
  const slope = Math.log(psd.floor_nm4 / psd.plateau_nm4) / Math.log(psd.cutoff_rad_per_um / psd.corner_rad_per_um);
  return {...psd, skewness: entry.skewness, kurtosis: entry.kurtosis, rms_nm: entry.rms_nm, hurst: -slope / 2 - 1};
}
function stated() {
  const value = (key) => Number(byId(key).value), known = OPEN.filter((key) => byId("known_" + key).checked);
  const own = Object.fromEntries(["rms_nm", ...known].map((key) => [key, value(key)]));
  return {own, kind: byId("kind").value, like: byId("like").value, substrate: byId("substrate").value, value, open: known.length < OPEN.length};
}
function questionOf({own, kind, like, substrate, value, open}) {
  const of = (name) => added(heights({...typical(name), ...own}), heights(typical(substrate)));
  const asked = {stated: of(like), members: open ? Object.keys(TABLE.library).map(of) : [], averaged: false,
    humidities: [airOf(value) === DRY ? 0 : airOf(value)], touchdowns: value("touchdowns")};
  Object.assign(asked, {solids: solidsOf(value), temperature: value("temperature_K")});
  const potential = value("voltage_V"), distance = value("dielectric_nm") * 1e-9, tension = PERMITTIVITY * (potential / distance) ** 2 / 2;
  if (kind === STOPPER) {
    const sides = ["side_um", "other_um"].map((key) => value(key) * 1e-6);
    return {...asked, sides, force: value("force_uN") * 1e-6, added: tension * sides[0] * sides[1]};
  }
  const beam = {...asked, thickness: value("thickness_um") * 1e-6, width: value("width_um") * 1e-6, length: value("length_um") * 1e-6, liquid: value("tension_mN_per_m") * 1e-3};
  const gap = value(kind === BRIDGE ? "below_um" : "gap_um") * 1e-6, driven = {...beam, added: energyOf(potential, distance, gap), gap};
  return kind === BRIDGE ? {...driven, tension, stress: value("stress_MPa") * 1e6} : driven;
}
function solidsOf(value) {
  const modulus = value("modulus_GPa") * 1e9, cosine = (key) => Math.cos(value(key) * Math.PI / 180);
  return {modulus, beamModulus: modulus, throughWater: value("water_zJ") / 97.5 * POLYSILICON.throughWater,
    inDryAir: value("dry_zJ") / 186.5 * POLYSILICON.inDryAir, wetting: cosine("angle_deg") + cosine("opposite_deg")};
}
const RAREST = 1e-6, NEARLY_ALL = 0.99; // fractions that are shown
const WORDS = {[CANTILEVER]: ["length", "µm", "length_um"], [BRIDGE]: ["length", "µm", "length_um"], [STOPPER]: ["force", "µN", "force_uN"]};
const grouped = (number) => number < 10000 ? `${number}` : `${number}`.replace(/\B(?=(\d{3})+$)/g, "\u00a0");
const micro = (size) => Number((size * 1e6).toPrecision(3)).toString();
const outward = (ends) => ends.map((end, side) => bound(end * 1e6, side === 1).toString());
function percent(part, touchdowns) {
  if (part < RAREST) return `less than ${(100 * RAREST).toFixed(4)} %`;
  return `${part >= after(SCORES[0], touchdowns) ? "at least " : ""}${Number((100 * Math.min(part, NEARLY_ALL)).toPrecision(2))} %`;
}
function show() {
  for (const [key, , low] of [...INPUTS, ...OF_SURFACE, ...OF_MATERIAL]) if (!Array.isArray(low)) byId("of_" + key).textContent = byId(key).value;
  const given = stated();
  byId("of_humidity").textContent = airOf(given.value);
  for (const key of Object.values(OWN).flat()) byId(key).closest("label").hidden = !OWN[given.kind].includes(key);
  for (const key of OPEN) {
    byId(key).disabled = !(key in given.own);
    if (byId(key).disabled) byId("of_" + key).textContent = `as ${given.like}`;
  }
  if (Object.keys(given.own).some((key) => OPEN.includes(key))) byId("surface").open = true;
  byId("yaml").textContent = yamlOf(given);
  try { write(answer(questionOf(given), TABLE), given); }
  catch (reason) { if (!(reason instanceof NotLearnt)) throw reason; refuse(reason); }
  draw(given);
}
function write(found, {kind, value}) {
  const [name, symbol, key] = WORDS[kind];
  const isForce = kind === STOPPER, toUse = (end, side) => side === Number(isForce) ? `<strong>${end}</strong>` : end;
  const row = ({fraction, size, intervals}) => `<tr><th scope="row">1 in ${grouped(Math.round(1 / fraction))}</th><td>${micro(size)}</td>` +
    `<td>${outward(intervals["90"]).map(toUse).join(" to ")}</td><td data-confidence="95">${outward(intervals["95"]).join(" to ")}</td></tr>`;
  const caption = `<caption>${name === "length" ? "Length" : "Force"} at which a fraction sticks [${symbol}]</caption>`;
  byId("table").innerHTML = `${caption}<thead><tr><th scope="col">stuck</th><th scope="col">estimate</th><th scope="col">90 %</th>` +
    `<th scope="col" data-confidence="95">95 %</th></tr></thead><tbody>${found.rows.map(row).join("")}</tbody>`;
  byId("said").className = "said";
  const dried = found.life && found.life.dried, lowest = found.rows[2].intervals["90"][0], mustDry = dried && dried[0] < lowest;
  const [least, most] = outward(found.rows[2].intervals["90"]);
  const safe = isForce ? `at least ${most}` : mustDry ? `at most ${bound(dried[0] * 1e6)}, or it can collapse while ${LIQUID} dries` : `at most ${least}`;
  byId("said").textContent = `1 in 1000 sticks between ${least} and ${most} ${symbol} (90 %): use ${safe}.`;
  byId("promise").textContent = PROMISES[Number(isForce)];
  byId("before").textContent = leftOut(kind, value);
  const limit = isForce ? found.rows[2].intervals["90"][1] : mustDry ? dried[0] : lowest, size = value(key) * 1e-6;
  const isUnsafe = isForce ? size < limit : size > limit, stated = `${value(key)} ${symbol}`;
  byId("unsafe").textContent = isUnsafe ? `${stated} is ${isForce ? "less" : "longer"} than ${grouped(bound(limit * 1e6, isForce))}: not safe.` : "";
  const [middle, low, high] = found.stuck.map((part) => percent(part, value("touchdowns")));
  byId("stuck").textContent = isUnsafe ? `Best estimate: ${middle} stick${high === middle ? "" : `, but up to ${high} (95 %)`}.`
    : `At ${stated}, ${middle} stick (95 %: ${low} to ${high}).`;
  byId("flat").textContent = flatOf(found.flat, symbol, kind, value);
  byId("life").textContent = found.life ? livesOf(found.life, value(key), kind).join("\n") : "";
}
function leftOut(kind, value) {
  const parts = [[kind !== STOPPER && !value("tension_mN_per_m"), "drying"], [airOf(value) !== DRY, "fast separation"]];
  const words = parts.filter(([isLeftOut]) => isLeftOut).map(([, word]) => word).join(" and ");
  return `For exact inputs${words && `, before ${words}`}.`;
}
function flatOf({size, tip, isHumid}, symbol, kind, value) {
  const start = `${value("voltage_V") ? "Without its voltage, flat" : "Flat"}${isHumid ? ", flooded" : ""} surfaces`;
  const most = `${grouped(bound(size * 1e6, kind === STOPPER))} ${symbol}`;
  if (kind === STOPPER) return `${start} hold ${most}. No surface of this area holds more.`;
  if (kind === BRIDGE) return `${start} stick from ${most} on. No surface sticks at a shorter length.`;
  return `${start} stick from ${bound(tip * 1e6)} ${symbol} on at the tip and from ${most} on along the underside. Rough ones can stick harder, but at the tip alone.`;
}
const LIQUID = "liquid", GRAVITY = 9.80665, FATES = ["stands", "may collapse", "collapses"];
function bound(number, up = false) { // to three digits, not beyond it, of nine that do not show how it was computed
  if (!Number.isFinite(number)) return number;
  const [digits, power] = number.toExponential(8).split("e");
  return Number(`${Math[up ? "ceil" : "floor"](Number(digits.replace(".", "")) / 1e6)}e${power - 2}`);
}
function livesOf({dried, shock}, length, kind) {
  const touches = `At ${length} µm it does not touch below a half-sine shock of ${grouped(bound(shock / GRAVITY))} g.`;
  if (!dried) return [touches];
  const [stands, collapses, free] = dried.map((size) => bound(size * 1e6)), fate = dried.slice(0, 2).filter((size) => length * 1e-6 > size).length;
  return [`While ${LIQUID} dries, beams stand up to ${stands} µm and collapse beyond ${collapses} µm; ` +
    `after a collapse they stay down if they are longer than ${free} µm${kind === BRIDGE ? "; shorter ones may, too" : ""}.`, `At ${length} µm it ${FATES[fate]} while ${LIQUID} dries.`, touches];
}
function refuse(reason) {
  byId("said").className = "said refused";
  byId("said").textContent = `Not known at once: ${reason.message}. A run computes it.`;
  byId("table").innerHTML = "<caption>No number</caption>";
  for (const id of ["unsafe", "before", "promise", "stuck", "flat", "life"]) byId(id).textContent = "";
}
function liquidsOf(kind, value) {
  const tension = value("tension_mN_per_m");
  return kind !== STOPPER && tension ? `liquids: {${LIQUID}: {surface_tension_mN_per_m: ${tension}}}\n` : "";
}
function yamlOf({own, kind, like, substrate, value, open}) {
  const others = materialOf(value), named = others ? ", material: Upper" : "";
  const surface = Object.entries({...own, ...(open ? {like} : {})}).map(([key, of]) => `${key}: ${of}`).join(", ") + named;
  const air = `humidities: [${airOf(value)}], touchdowns: ${value("touchdowns")}`;
  const opposite = others ? `  ${substrate}: {material: Lower}\n` : "";
  return `run: {pairs: [mine], studies: []}\n${waterOf(value)}${others}surfaces:\n  Mine: {${surface}}\n${opposite}pairs:\n` +
    `  mine: {beam: Mine, substrate: ${substrate}, gap_um: ${value(kind === BRIDGE ? "below_um" : "gap_um")}, humidities: [${airOf(value)}]}\n` +
    `${liquidsOf(kind, value)}devices:\n  ${NAMES[kind]}: {kind: ${kind}, pair: mine, ${SIZES[kind](value)}, ${air}}\n`;
}
function materialOf(value) {
  if (OF_MATERIAL.every(([key, , , , , start]) => key === "temperature_K" || value(key) === start)) return "";
  const of = (angle) => `{young_modulus_GPa: ${value("modulus_GPa")}, contact_angle_deg: ${value(angle)}, ` +
    `hamaker_constant_zJ: {water: ${value("water_zJ")}, dry: ${value("dry_zJ")}}}`;
  return `materials:\n  Upper: ${of("angle_deg")}\n  Lower: ${of("opposite_deg")}\n`;
}
const waterOf = (value) => value("temperature_K") === REFERENCE ? "" : `water: {temperature_K: ${value("temperature_K")}}\n`;
const NAMES = {[CANTILEVER]: "Lever", [BRIDGE]: "Bridge", [STOPPER]: "Bump"};
const SIZES = {
  [CANTILEVER]: (value) => atVoltageOf(ofBeam(value, "gap_um"), value),
  [BRIDGE]: (value) => atVoltageOf(`${ofBeam(value, "below_um")}, residual_stress_MPa: ${value("stress_MPa")}`, value),
  [STOPPER]: (value) => atVoltageOf(`contact_um: [${value("side_um")}, ${value("other_um")}], restoring_force_uN: ${value("force_uN")}`, value),
};
function ofBeam(value, gap) {
  return ["length_um", "thickness_um", "width_um"].map((key) => `${key}: ${value(key)}`).join(", ") + `, gap_um: ${value(gap)}`;
}
function atVoltageOf(sizes, value) {
  const dielectric = `dielectric: {thickness_nm: ${value("dielectric_nm")}, permittivity: 1}`;
  return value("voltage_V") ? `${sizes}, voltage_V: ${value("voltage_V")}, ${dielectric}` : sizes;
}
const DRAWN = {[CANTILEVER]: [beam, " at its tip"], [BRIDGE]: [bridge, " at its middle"], [STOPPER]: [bump, ""]};
function draw({kind, value}) {
  const substrate = '<rect x="0" y="75" width="300" height="12" fill="#8c959f"/>';
  byId("drawing").innerHTML = substrate + DRAWN[kind][0](value);
  byId("drawing").setAttribute("aria-label", `Cross-section of the ${kind} that sticks${DRAWN[kind][1]}`);
}
function bump(value) {
  const width = 20 * value("side_um");
  return `<rect x="40" y="35" width="220" height="20" fill="#57606a"/><rect x="${150 - width / 2}" y="55" width="${width}" height="20" fill="#0969da"/>`;
}
function beam(value) {
  const gap = 10 + 1.3 * value("gap_um"), thickness = 2 + 2 * value("thickness_um"), top = 75 - gap - thickness;
  const tip = 75 - thickness, middle = top + 0.35 * gap; // the lower side is the upper one, lower by the thickness
  const outline = `M30 ${top} C 120 ${top} 200 ${middle} 285 ${tip} V 75 C 200 ${middle + thickness} 120 ${top + thickness} 30 ${top + thickness} Z`;
  return `<rect x="0" y="${top}" width="30" height="${75 - top}" fill="#57606a"/><path d="${outline}" fill="#0969da"/>`;
}
function bridge(value) {
  const gap = 10 + 6 * value("below_um"), thickness = 2 + 2 * value("thickness_um"), top = 75 - gap - thickness, low = 75 - thickness;
  const side = (y, end) => `C 90 ${y} 110 ${end} 150 ${end} C 190 ${end} 210 ${y} 270 ${y}`;
  const back = (y, end) => `C 210 ${y} 190 ${end} 150 ${end} C 110 ${end} 90 ${y} 30 ${y}`;
  const clamps = [0, 270].map((x) => `<rect x="${x}" y="${top}" width="30" height="${75 - top}" fill="#57606a"/>`).join("");
  return `${clamps}<path d="M30 ${top} ${side(top, low)} V ${top + thickness} ${back(top + thickness, 75)} Z" fill="#0969da"/>`;
}
const folded = (id, words, inputs) => `<details id="${id}"><summary>${words}</summary>${inputs.map(slider).join("")}</details>`;
byId("form").innerHTML = INPUTS.map(slider).join("") + folded("surface", "What I know of the surface", OF_SURFACE) +
  folded("material", "Material and temperature", OF_MATERIAL);
byId("form").addEventListener("input", ({target}) => {
  if (PAIR.includes(target.id)) for (const id of PAIR) byId(id).checked = target.checked;
  show();
});
byId("copy").addEventListener("click", () => navigator.clipboard.writeText(byId("yaml").textContent));
show();
