// The report's numbers: reads what encode.py packed, and describes selections of runs.

let report; // the document
const OK = 0;
const ABSENT = 65535;
const FAILED = ["planner_failed", "failed"];
const WITHOUT_VALUE = [
  ["censored", "censored"], ["undefined", "undefined"], ["failed", "failed"], ["absent", "not scored"],
];

async function inflate(name) {
  const text = byId(`blob-${name}`).textContent;
  const bytes = Uint8Array.from(atob(text), (c) => c.charCodeAt(0));
  const plain = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("deflate"));
  return new Response(plain).arrayBuffer();
}

/** Doubles whose four highest bytes are given: all first bytes, then all second ones, and so on. */
function numbersOf(bytes) {
  const count = bytes.length / 4;
  const doubles = new DataView(new ArrayBuffer(8 * count));
  for (let i = 0; i < count; i++) {
    for (let k = 0; k < 4; k++) doubles.setUint8(8 * i + k, bytes[k * count + i]);
  }
  return Float64Array.from({ length: count }, (_, i) => doubles.getFloat64(8 * i));
}

async function decode() {
  report = JSON.parse(new TextDecoder().decode(await inflate("meta")));
  const names = ["values", "lower", "upper", "intervals", "pairs", "effects"];
  const blobs = await Promise.all(names.map(inflate));
  names.forEach((name, i) => { report[name] = numbersOf(new Uint8Array(blobs[i])); });
  report.codes = new Uint16Array(await inflate("codes"));
  const count = report.runs.count;
  report.byPlanner = report.planners.map((_, p) =>
    Array.from({ length: count }, (__, r) => r).filter((r) => report.runs.planner[r] === p));
}

const at = (series, run) => series * report.runs.count + run;

/** One score: status, reason, and value or bounds. */
function scoreOf(series, run) {
  const i = at(series, run);
  const code = report.codes[i];
  const [status, reason] = code === ABSENT ? ["absent", ""] : report.states[code];
  return { status, reason, value: report.values[i], lower: report.lower[i], upper: report.upper[i] };
}

/** Linear interpolation between the closest ranks of sorted numbers. */
function quantile(sorted, q) {
  if (!sorted.length) return NaN;
  const place = q * (sorted.length - 1);
  const k = Math.floor(place);
  return sorted[k] + (place - k) * ((sorted[k + 1] ?? sorted[k]) - sorted[k]);
}

const mean = (sorted) => sorted.reduce((sum, x) => sum + x, 0) / sorted.length;

/** Mean of the middle half of sorted numbers; those at its ends count in part. */
function interquartileMean(sorted) {
  const [from, to] = [sorted.length / 4, (3 * sorted.length) / 4];
  let sum = 0;
  sorted.forEach((x, k) => { sum += x * Math.max(0, Math.min(k + 1, to) - Math.max(k, from)); });
  return sorted.length ? sum / (to - from) : NaN;
}

/** What a series is like in some runs; nothing is dropped: what has no value is counted. */
function describe(series, runs) {
  const values = [];
  const others = { undefined: 0, censored: 0, failed: 0, absent: 0 };
  for (const run of runs) {
    const code = report.codes[at(series, run)];
    if (code === OK) values.push(report.values[at(series, run)]);
    else others[code === ABSENT ? "absent" : report.states[code][0]]++;
  }
  const sorted = Float64Array.from(values).sort();
  return {
    ...others,
    runs: runs.length,
    ok: sorted.length,
    sorted,
    centre: report.series[series].centre === "interquartile mean" ? interquartileMean(sorted) : mean(sorted),
    q1: quantile(sorted, 0.25),
    median: quantile(sorted, 0.5),
    q3: quantile(sorted, 0.75),
  };
}

/** What sums up a series, with its interval, where Python has worked it out for this selection. */
function intervalOf(selection, series, planner) {
  const place = selection === null ? -1 : report.stats.selections.indexOf(selection);
  if (place < 0) return null;
  const row = (place * report.series.length + series) * report.planners.length + planner;
  const [estimate, low, high] = report.intervals.subarray(3 * row, 3 * row + 3);
  return { estimate, low, high };
}

/** The comparison of a pair of planners over all runs; null for any other selection. */
function comparisonOf(series, pair) {
  if (selectionName() !== "") return null;
  const { fields, verdicts, whys } = report.stats;
  const row = series * report.stats.pairs.length + pair;
  const numbers = report.pairs.subarray(fields.length * row, fields.length * (row + 1));
  const found = Object.fromEntries(fields.map((name, i) => [name, numbers[i]]));
  return { ...found, verdict: verdicts[found.verdict], why: whys[found.why] };
}

/** Share of a score's spread that goes with an axis, for one planner, over all runs. */
function effectOf(axis, series, planner) {
  return report.effects[(axis * report.series.length + series) * report.planners.length + planner];
}
