// The report's numbers: reads what encode.py packed, and describes selections of runs.

let report; // the decoded report
const OK = 0;
const ABSENT = 65535;
const WITHOUT_VALUE = [
  ["censored", "censored"], ["undefined", "undefined"], ["failed", "failed"], ["absent", "not scored"],
];

async function inflate(name) {
  const text = byId(`blob-${name}`).textContent;
  const bytes = Uint8Array.from(atob(text), (c) => c.charCodeAt(0));
  const plain = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("deflate"));
  return new Response(plain).arrayBuffer();
}

/** Doubles from their highest bytes: all first bytes, then all second bytes, and so on. */
function numbersOf(bytes, kept) {
  const count = bytes.length / kept;
  const doubles = new DataView(new ArrayBuffer(8 * count));
  for (let i = 0; i < count; i++) {
    for (let k = 0; k < kept; k++) doubles.setUint8(8 * i + k, bytes[k * count + i]);
  }
  return Float64Array.from({ length: count }, (_, i) => doubles.getFloat64(8 * i));
}

async function decode() {
  report = JSON.parse(new TextDecoder().decode(await inflate("meta")));
  const names = ["values", "lower", "upper", "intervals", "pairs", "effects"];
  const blobs = await Promise.all(names.map(inflate));
  names.forEach((name, i) => { report[name] = numbersOf(new Uint8Array(blobs[i]), name === "intervals" ? 8 : 4); });
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

/** Mean of a series over some runs, or for a rate, the rate of all together; as in `centre.py`. */
function centreOf(series, runs) {
  const { metric, over } = report.series[series];
  const whole = over ? report.series.findIndex((s) => s.metric === metric && s.variant === over) : -1;
  let [above, below] = [0, 0];
  for (const run of runs) {
    const weight = whole < 0 ? 1 : report.values[at(whole, run)];
    if (report.codes[at(series, run)] !== OK || (whole >= 0 && report.codes[at(whole, run)] !== OK) || !(weight > 0)) continue;
    above += weight * report.values[at(series, run)];
    below += weight;
  }
  return below ? above / below : NaN;
}

/**
 * What a series is like in some runs; nothing is dropped: what has no value is counted.
 * `known` is the estimate with its interval, where Python has worked it out for these runs.
 */
function describe(series, runs, known = null) {
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
    centre: known ? known.estimate : centreOf(series, runs),
    low: known?.low ?? NaN,
    high: known?.high ?? NaN,
    known: known !== null,
    q1: quantile(sorted, 0.25),
    median: quantile(sorted, 0.5),
    q3: quantile(sorted, 0.75),
  };
}

/** Statistics of a series of a planner in the selected runs. */
function describeSelected(series, planner) {
  return describe(series, selectedRuns(planner), intervalOf(selectionName(), series, planner));
}

/** Summary of a series with its interval, if Python has computed it for this selection. */
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

/** Share of a score's variance that an axis explains, for one planner, over all runs. */
function effectOf(axis, series, planner) {
  return report.effects[(axis * report.series.length + series) * report.planners.length + planner];
}
